# SPDX-License-Identifier: Apache-2.0
"""What a shared library exports and needs: of Linux (ELF) or of Windows (PE)."""
import re
import struct
import subprocess


def is_dll(path):
    with open(path, "rb") as file:
        return file.read(2) == b"MZ"


def exported(path):
    """The names, without versions."""
    if is_dll(path):
        return Pe(path).exported()
    lines = subprocess.run(["nm", "-D", "--defined-only", "--format=posix", path], check=True, text=True,
                           capture_output=True).stdout.splitlines()
    # A version is a symbol of its own, of the kind A.
    return {line.split("@")[0].split()[0] for line in lines if line.split()[1] != "A"}


def needed(path):
    """The libraries that have to be there."""
    if is_dll(path):
        return Pe(path).needed()
    listing = subprocess.run(["readelf", "-d", path], check=True, text=True, capture_output=True).stdout
    return set(re.findall(r"\(NEEDED\).*\[(.*)\]", listing))


class Pe:
    """The tables of a DLL or program for 64-bit Windows."""

    def __init__(self, path):
        with open(path, "rb") as file:
            self.data = file.read()
        header = self.number("<I", 0x3C)
        if self.data[header:header + 4] != b"PE\0\0":
            raise ValueError(f"{path} is no program for Windows")
        sections, optional_size = self.number("<H", header + 6), self.number("<H", header + 20)
        optional = header + 24
        if self.number("<H", optional) != 0x20B:
            raise ValueError(f"{path} is not for 64 bits")
        # Pairs of address and size: the first are exports, the second imports.
        self.directories = [struct.unpack_from("<II", self.data, optional + 112 + 8 * i) for i in range(2)]
        self.sections = [struct.unpack_from("<IIII", self.data, optional + optional_size + 40 * i + 8)
                         for i in range(sections)]

    def number(self, form, at):
        return struct.unpack_from(form, self.data, at)[0]

    def place(self, address):
        for virtual_size, start, size, place in self.sections:
            if start <= address < start + max(virtual_size, size):
                return address - start + place
        raise ValueError(f"no section has the address {address:#x}")

    def text(self, address):
        begin = self.place(address)
        return self.data[begin:self.data.index(b"\0", begin)].decode("ascii")

    def exported(self):
        address, size = self.directories[0]
        if size == 0:
            return set()
        table = self.place(address)
        count, names = self.number("<I", table + 24), self.place(self.number("<I", table + 32))
        return {self.text(self.number("<I", names + 4 * i)) for i in range(count)}

    def needed(self):
        address, size = self.directories[1]
        found = set()
        entry = self.place(address) if size else None
        while entry is not None and (name := self.number("<I", entry + 12)) != 0:
            found.add(self.text(name))
            entry += 20
        return found
