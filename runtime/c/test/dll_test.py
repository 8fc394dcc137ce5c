#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""dll_test.py DLL SYMBOLS.txt | NAME [OTHER.dll...]: the DLL exports the names of the list (symbols of Linux, with
versions) or the one name, and no others, and needs no DLL but those of Windows and those that are given."""
import sys

from library_symbols import exported, needed

OF_WINDOWS = {"advapi32.dll", "bcrypt.dll", "crypt32.dll", "iphlpapi.dll", "kernel32.dll", "msvcrt.dll", "ntdll.dll",
              "user32.dll", "ws2_32.dll", "api-ms-win-core-synch-l1-2-0.dll"}


def names_of(listed):
    if not listed.endswith(".txt"):
        return {listed}
    with open(listed, encoding="ascii") as file:
        return {line.split("@@")[0] for line in file if "@@" in line}


def main(library, listed, *others):
    wanted, found = names_of(listed), exported(library)
    wrong = [f"not exported: {name}" for name in sorted(wanted - found)]
    wrong += [f"exported, and not in the list: {name}" for name in sorted(found - wanted)]
    wrong += [f"needs {name}" for name in sorted(needed(library)) if name.lower() not in OF_WINDOWS | set(others)]
    if wrong or not wanted:
        sys.exit("\n".join(wrong) or f"{listed} has no names")
    print(f"{library}: {len(found)} names: PASSED")


if __name__ == "__main__":
    main(*sys.argv[1:])
