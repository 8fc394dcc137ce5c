#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""native_names_test.py LIBRARY...: each library, of Linux or of Windows, exports all functions that the C# runtime
imports (Native/Functions.cs), and every handle that it releases has a class that does so."""
import pathlib
import re
import sys

HERE = pathlib.Path(__file__).resolve().parent
sys.path.insert(0, str(HERE.parent / "c" / "test"))
from library_symbols import exported  # noqa: E402


def imported(native):
    """Names by the library that they are imported from."""
    names = {}
    for file in sorted(native.glob("*.cs")):
        text = file.read_text(encoding="utf-8")
        # The declaration that follows an attribute. Another name than the function's would be an EntryPoint.
        for attribute, name in re.findall(r"\[(?:LibraryImport|DllImport)\(([^\]]*)\)\]\s*(?:\[[^\]]*\]\s*)*[^(;]*?(\w+)\(", text):
            library = attribute.split(",")[0].strip()
            entry = re.search(r'EntryPoint\s*=\s*"(\w+)"', attribute)
            names.setdefault(library, set()).add(entry.group(1) if entry else name)
    return names


def main(libraries):
    native = HERE / "Robdef.Runtime" / "Native"
    names = imported(native)
    text = "".join(file.read_text(encoding="utf-8") for file in sorted(native.glob("*.cs")))
    wrong = []
    if set(names) != {"Library"}:
        wrong.append(f"functions are imported from {sorted(names)}, and should be from the constant Library alone")
    if 'Library = "robdef_c"' not in text:
        wrong.append("the library is not robdef_c, which is librobdef_c.so on Linux and robdef_c.dll on Windows")
    wanted = names.get("Library", set())
    if len(wanted) != text.count("[LibraryImport("):
        wrong.append(f"{text.count('[LibraryImport(')} attributes, and {len(wanted)} names of functions")
    # Callbacks: one convention, which the C compilers of both systems use.
    for file in sorted((HERE / "Robdef.Runtime").rglob("*.cs")):
        for line in file.read_text(encoding="utf-8").splitlines():
            if re.search(r"\[UnmanagedCallersOnly(?!\(CallConvs = \[typeof\((\w+\.)*CallConvCdecl\)\]\)\])", line) or \
                    re.search(r"delegate\* unmanaged(?!\[Cdecl\])", line):
                wrong.append(f"{file.name}: no convention for calls: {line.strip()}")
    released = set(re.findall(r"\b(rr_\w+_release)\b", text))
    for name in sorted(released - wanted):
        wrong.append(f"{name} is called, and not imported")
    for library in libraries:
        found = exported(library)
        wrong += [f"{library} does not export {name}" for name in sorted(wanted - found)]
    if wrong or not libraries:
        sys.exit("\n".join(wrong) or __doc__)
    print(f"{len(wanted)} functions in {len(libraries)} libraries: PASSED")


if __name__ == "__main__":
    main(sys.argv[1:])
