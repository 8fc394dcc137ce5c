# SPDX-License-Identifier: Apache-2.0
"""Which C++ sources can be one compilation: headers take most of its time."""
import re

LOCAL_NAME = re.compile(
    r"^(?:template <[^\n]*>\n)?(?:\[\[\w+\]\] )?(?:class|struct|enum class|using|(?:inline |constexpr |const |static )*"
    r"[A-Za-z_][\w:<>,*& ]*?[ *&])\(?([A-Za-z_]\w*)\)?(?= ?[({;=:]|\n| final)", re.M)
TEST = re.compile(r"^(?:TYPED_)?TEST(?:_[FP])?\(\s*(\w+),\s*(\w+)\)", re.M)


def local_names(text):
    """About the names that a source has for itself: what begins at the margin in unnamed namespaces, usings, tests, main()."""
    names = set(re.findall(r"^using [\w:]*?(\w+);", text, re.M))
    names.update(f"{suite}.{name}" for suite, name in TEST.findall(text))
    names.update(re.findall(r"^int (main)\(", text, re.M))
    for part in re.findall(r"^namespace \{$(.*?)^\}  // namespace", text, re.M | re.S):
        names.update(LOCAL_NAME.findall(part))
    return names


def grouped(items, names_of, most, size_of=lambda item: 1):
    """Puts items together whose local names differ, while their sizes are at most `most`."""
    groups = []  # with their names, and their size
    for item in items:
        names = names_of(item)
        for group in groups:
            if group[2] + size_of(item) <= most and not names & group[1]:
                group[0].append(item)
                group[1] |= names
                group[2] += size_of(item)
                break
        else:
            groups.append([[item], set(names), size_of(item)])
    return [group for group, _, _ in groups]
