#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Packs a NuGet package again so that the same contents give the same bytes.

repack_nuget.py FROM TO. NuGet stamps each file with the time, and some versions of the SDK name the
file of core properties at random.
SOURCE_DATE_EPOCH is the time of all files in the result; their order is that of their names, the relations first.
"""
import os
import re
import sys
import time
import zipfile


def main(source: str, target: str) -> None:
    when = time.gmtime(int(os.environ["SOURCE_DATE_EPOCH"]))[:6]
    with zipfile.ZipFile(source) as package:
        files = {name: package.read(name) for name in package.namelist()}
    given_name = [n for n in files if re.fullmatch(r"package/services/metadata/core-properties/\w+\.psmdcp", n)]
    if len(given_name) != 1:
        sys.exit(f"{source}: {len(given_name)} files of core properties instead of one")
    fixed_name = "package/services/metadata/core-properties/properties.psmdcp"
    files[fixed_name] = files.pop(given_name[0])
    relations = files["_rels/.rels"].decode()
    relations = relations.replace(given_name[0], fixed_name)
    # Their ids are random, too, and named by nobody.
    numbers = iter(range(1, 100))
    relations = re.sub(r' Id="[^"]*"', lambda _: f' Id="R{next(numbers)}"', relations)
    files["_rels/.rels"] = relations.encode()
    with zipfile.ZipFile(target, "w", zipfile.ZIP_DEFLATED) as package:
        for name in sorted(files, key=lambda n: (not n.startswith(("_rels/", "[Content")), n)):
            entry = zipfile.ZipInfo(name, when)
            entry.compress_type = zipfile.ZIP_DEFLATED
            entry.external_attr = 0o100644 << 16
            package.writestr(entry, files[name])


if __name__ == "__main__":
    main(sys.argv[1], sys.argv[2])
