#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Finds public names of the C++ and C headers that have no documentation comment.

Usage: documented_names.py [--input FOLDER]...

Runs doxygen with docs/Doxyfile (FOLDER in place of its INPUT) and reads the XML that it makes. Prints each name that has no
comment of its own, and each comment that doxygen does not understand. Exit status: 0 none, 1 some, 2 doxygen failed.

A name needs a comment if programs can use it: classes, functions, variables, types, enums and macros, public or protected.
These need none: destructors, what is deleted, friend classes, an override of a function that has one, and a value of an enum
whose comment names it.
"""
import argparse
import collections
import pathlib
import re
import subprocess
import sys
import tempfile
import xml.etree.ElementTree

ROOT = pathlib.Path(__file__).resolve().parent.parent
Name = collections.namedtuple("Name", "file line kind name")


def doxygen(folder, inputs):
    """Makes XML of the headers in a folder; returns what doxygen complains about."""
    settings = (ROOT / "docs" / "Doxyfile").read_text(encoding="utf-8")
    # What has no comment must be in the XML, too; then doxygen itself does not warn of it.
    settings += "\n".join(["EXTRACT_ALL = YES", "GENERATE_HTML = NO", "GENERATE_XML = YES",
                           "XML_PROGRAMLISTING = NO", f'OUTPUT_DIRECTORY = "{folder}"'])
    if inputs:
        quoted = " ".join(f'"{pathlib.Path(one).resolve()}"' for one in inputs)
        settings += f"\nINPUT = {quoted}\nSTRIP_FROM_INC_PATH = {quoted}"
    run = subprocess.run(["doxygen", "-"], input=settings, text=True, cwd=ROOT, check=False,
                         stdout=subprocess.DEVNULL, stderr=subprocess.PIPE)
    if run.returncode != 0:
        sys.exit(f"documented_names.py: doxygen failed\n{run.stderr}")
    return [line.replace(f"{ROOT}/", "") for line in run.stderr.splitlines() if line.strip()]


def text_of(node):
    """The documentation of an XML node."""
    parts = (node.find(part) for part in ("briefdescription", "detaileddescription"))
    return " ".join("".join(part.itertext()) for part in parts if part is not None).strip()


def place_of(node, kind, name):
    location = node.find("location")
    file = location.get("file").replace(f"{ROOT}/", "")
    return Name(file, int(location.get("line") or 1), kind, name)


def members_of(compound):
    for section in compound.findall("sectiondef"):
        for member in section.findall("memberdef"):
            if member.get("prot") != "private":
                yield member


class Headers:
    """What programs can use, as doxygen has read it."""

    def __init__(self, folder):
        self.compounds = []
        for file in sorted(folder.glob("*.xml")):
            for compound in xml.etree.ElementTree.parse(file).getroot().findall("compounddef"):
                kinds = ("class", "struct", "union", "namespace", "file")
                if compound.get("kind") in kinds and compound.get("prot") != "private":
                    self.compounds.append(compound)
        self.members = {member.get("id"): member
                        for compound in self.compounds for member in members_of(compound)}
        # A macro may be defined in two branches of an #if.
        self.macros = {member.findtext("name") for member in self.members.values()
                       if member.get("kind") == "define" and text_of(member)}

    def is_documented(self, member):
        if text_of(member) or member.findtext("name") in self.macros:
            return True
        bases = (self.members.get(base.get("refid")) for base in member.findall("reimplements"))
        return any(base is not None and self.is_documented(base) for base in bases)

    def names(self):
        """Each name that needs documentation, and whether it has it."""
        for compound in self.compounds:
            kind, name = compound.get("kind"), compound.findtext("compoundname")
            # Doxygen leaves out what a C header declares unless the file itself has a comment.
            if kind != "file" or name.endswith(".h"):
                yield place_of(compound, kind, name), bool(text_of(compound))
            scope = "" if kind == "file" else f"{name}::"
            for member in members_of(compound):
                if not needs_none(member):
                    own = scope + member.findtext("name")
                    yield place_of(member, member.get("kind"), own), self.is_documented(member)
                    yield from values_of(member, scope)


def needs_none(member):
    arguments = (member.findtext("argsstring") or "").replace(" ", "")
    return (member.findtext("name").startswith("~") or arguments.endswith("=delete")
            or (member.get("kind") == "friend" and "(" not in arguments))


def values_of(member, scope):
    said = text_of(member)
    for value in member.findall("enumvalue"):
        name = value.findtext("name")
        named = re.search(rf"\b{re.escape(name)}\b", said) is not None
        yield place_of(member, "enum value", scope + name), named or bool(text_of(value))


def main():
    parser = argparse.ArgumentParser(description="finds public names without documentation")
    parser.add_argument("--input", action="append", metavar="FOLDER")
    inputs = parser.parse_args().input
    with tempfile.TemporaryDirectory() as folder:
        complaints = doxygen(folder, inputs)
        names = dict(Headers(pathlib.Path(folder) / "xml").names())
    missing = sorted(name for name, has_comment in names.items() if not has_comment)
    for name in missing:
        print(f"{name.file}:{name.line}: {name.kind} {name.name} has no documentation comment")
    for complaint in complaints:
        print(complaint)
    print(f"{len(names)} public names, {len(missing)} without documentation")
    if not names:
        sys.exit("documented_names.py: doxygen has found no names")
    return 1 if missing or complaints else 0


if __name__ == "__main__":
    sys.exit(main())
