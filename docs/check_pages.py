#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Holds the pages of the tree to what they promise.

  all pages         relative links and anchors lead somewhere, both on a forge and on the site
  pages for users   no outworn words, no names of tests, no specification that is not in the tree, and sentences of
                    18 words on average
  --names PAGE      tests, programs and files that the page names exist

Usage: check_pages.py ROOT [--names PAGE]... [--sentences]
"""
import argparse
import glob
import os
import re
import sys
import unicodedata

USER_FOLDERS = ("docs/tutorial/", "docs/howto/", "docs/reference/", "docs/explanation/")
USER_PAGES = ("README.md", "docs/index.md")
LEFT_OUT = {"build", "node_modules", "golden", ".git", "corpus", "captures", "obj", "bin"}
WORDS_A_SENTENCE = 18

# Words of the left side, with what to write. Only those that mean nothing else.
WORDS = [
    (r"\bfindings\b|\b[Aa] finding\b|\b[Oo]ne finding\b", "diagnostic, or issue"),
    (r"\b(lets?|letting) go of\b|\blet go\b", "release, is released, is destroyed"),
    (r"\b(is|are|was|were|be|been) told of\b|\bhears? of\b", "is notified of"),
    (r"\b(be|is|are|was|were) let in\b|\b(be|is|are|was|were) sent away\b", "is authenticated, is rejected"),
    (r"\b[Mm]end(ed|ing)\b", "fixed"),
    (r"\bset-up of a node\b", "node configuration"),
    (r"\bof one's own\b", "custom"),
    (r"\b(holds?|holding|held) up\b|\bheld up\b", "blocks"),
    (r"\bin vain\b", "blocks forever, times out"),
    (r"\bby chance\b", "random"),
    (r"\btakes no more\b", "is full"),
    (r"\bwho is thought of\b", "threat model"),
    (r"\bruns against the reference\b", "interoperability test"),
    (r"\bdispatch turns?\b|\bread turns?\b", "strand, read lease"),
    (r"\b(until|till) now\b|\bof today\b|\bhours later\b", "no history"),
]
# `Calls.AHandlerMayCall...`, `board_test --gtest_filter=...`: of no use to a reader.
TEST_NAME = re.compile(r"`(?!RobotRaconteur)(?:[A-Za-z]+/)?[A-Z][A-Za-z]+\.[A-Z][A-Za-z]{15,}[^`]*`|`[^`]*--gtest_filter[^`]*`|`\w+_test(?: [^`]*)?`")
SPECIFICATION = re.compile(r"\(0\d,? (?:§|section)|\b0[1-8] §|\b0[1-8], section")

LINK = re.compile(r"(?<!!)\[(?:[^\[\]]|\[[^\]]*\])*\]\(([^)\s]+)\)|!\[[^\]]*\]\(([^)\s]+)\)")


def pages(root):
    for folder, folders, files in os.walk(root):
        folders[:] = sorted(f for f in folders if f not in LEFT_OUT and not f.startswith("."))
        for name in sorted(files):
            if name.endswith(".md"):
                yield os.path.relpath(os.path.join(folder, name), root)


def is_for_users(page):
    return page in USER_PAGES or page.startswith(USER_FOLDERS)


def without_code(text):
    """The lines of a page, those of code blocks empty, so that numbers stay."""
    lines, fence = [], None
    for line in text.split("\n"):
        mark = re.match(r"\s*(```+|~~~+)", line)
        if fence:
            if mark and mark.group(1).startswith(fence):
                fence = None
            lines.append("")
        elif mark:
            fence = mark.group(1)
            lines.append("")
        elif re.match(r" {4}", line) and (not lines or not lines[-1].strip() or lines[-1] == "\x00"):
            lines.append("\x00")  # an indented block, which ends at the next line that is not indented
        else:
            lines.append(line)
    return [line if line != "\x00" else "" for line in lines]


def plain(heading):
    """A heading as it is read: without code marks, links and escapes."""
    heading = re.sub(r"\[([^\]]*)\]\([^)]*\)", r"\1", heading.strip())
    return re.sub(r"\\(.)", r"\1", heading).replace("`", "").replace("*", "")


def forge_anchor(heading):
    return re.sub(r"[^\w\- ]", "", heading.lower()).replace(" ", "-")


def site_anchor(heading):
    value = unicodedata.normalize("NFKD", heading).encode("ascii", "ignore").decode()
    return re.sub(r"[-\s]+", "-", re.sub(r"[^\w\s-]", "", value).strip().lower())


def anchors(text):
    """Anchors of the page: of a forge, and of the site."""
    found = ({}, {})
    for line in without_code(text):
        heading = re.match(r"#{1,6} +(.*?)\s*#*$", line)
        for names, make, mark in ((found[0], forge_anchor, "-"), (found[1], site_anchor, "_")):
            if heading:
                name = make(plain(heading.group(1)))
                names[name] = names.get(name, -1) + 1
                if names[name]:
                    names[f"{name}{mark}{names[name]}"] = 0
    for name in re.findall(r'<a (?:id|name)="([^"]+)"', text):
        found[0][name] = found[1][name] = 0
    return found


def check_links(root, page, text, read, complain):
    for number, line in enumerate(without_code(text), 1):
        line = re.sub(r"`[^`]*`", lambda match: "`" * len(match.group(0)), line)
        for link in LINK.finditer(line):
            target = link.group(1) or link.group(2)
            if re.match(r"[a-z][a-z0-9+.-]*:", target):
                continue
            path, _, anchor = target.partition("#")
            file = os.path.normpath(os.path.join(os.path.dirname(page), path)) if path else page
            if not os.path.exists(os.path.join(root, file)):
                complain(page, number, f"there is no {target}")
            elif anchor and file.endswith(".md"):
                on_forge, on_site = anchors(read(file))
                if anchor not in on_forge:
                    complain(page, number, f"{file} has no heading for #{anchor}")
                elif is_for_users(page) and is_for_users(file) and anchor not in on_site:
                    complain(page, number, f"#{anchor} of {file} has another name on the site: change the heading")


def check_words(page, text, complain):
    for number, line in enumerate(without_code(text), 1):
        for pattern, instead in WORDS:
            for found in re.finditer(pattern, re.sub(r"`[^`]*`", "", line)):
                complain(page, number, f"`{found.group(0)}`: write {instead}")
        for found in TEST_NAME.finditer(line):
            complain(page, number, f"{found.group(0)} is the name of a test")
        for found in SPECIFICATION.finditer(line):
            complain(page, number, f"`{found.group(0)}` is not in the tree")


def sentences(text):
    """Line and sentence of all prose: paragraphs and items of lists; no headings, tables, code."""
    paragraph, start, result = [], 0, []

    def close():
        if not paragraph:
            return
        joined = " ".join(paragraph)
        joined = re.sub(r"<!--.*?-->", "", joined)
        joined = re.sub(r"!?\[((?:[^\[\]]|\[[^\]]*\])*)\]\([^)]*\)", r"\1", joined)
        joined = re.sub(r"`[^`]*`", "code", joined)
        for part in re.split(r"(?<=[.!?:;])\)?\*{0,2}\s+(?=[A-Z`\"(*\d]|code)|:$", joined):
            words = [word for word in part.split() if re.search(r"\w", word)]
            if words:
                result.append((start, len(words), " ".join(part.split())))
        paragraph.clear()

    for number, line in enumerate(without_code(text), 1):
        item = re.match(r"\s*(?:[-*]|\d+\.) +", line)
        if not line.strip() or line.lstrip().startswith(("#", "|", "<", "```")) or item:
            close()
        if item or (line.strip() and not line.lstrip().startswith(("#", "|", "<"))):
            if not paragraph:
                start = number
            paragraph.append(line[item.end():] if item else line.strip())
    close()
    return result


def check_sentences(page, text, complain, list_long):
    found = sentences(text)
    if not found:
        return
    average = sum(count for _, count, _ in found) / len(found)
    if list_long:
        print(f"{page}: {average:.1f} words a sentence, {sum(c > 30 for _, c, _ in found)} of {len(found)} over 30")
        for line, count, sentence in found:
            if count > 30 and is_for_users(page):
                print(f"  {page}:{line}: {count}: {sentence[:150]}")
    if average > WORDS_A_SENTENCE and is_for_users(page):
        complain(page, 1, f"{average:.1f} words a sentence; {WORDS_A_SENTENCE} at most")


def tests_of(root):
    names = set()
    for folder in ("cli", "compiler", "runtime", "conformance", "examples"):
        for file in glob.glob(os.path.join(root, folder, "**", "*_test.cpp"), recursive=True):
            with open(file, encoding="utf-8") as source:
                names.update(f"{a}.{b}" for a, b in re.findall(r"TEST(?:_F|_P)?\(\s*(\w+),\s*(\w+)\)", source.read()))
    return names


def programs_of(root):
    text = ""
    for folder in ("cli", "compiler", "runtime", "conformance", "examples"):
        for file in glob.glob(os.path.join(root, folder, "**", "CMakeLists.txt"), recursive=True):
            with open(file, encoding="utf-8") as source:
                text += source.read()
    return text


def check_names(root, page, text, complain):
    tests, programs = tests_of(root), programs_of(root)
    for number, line in enumerate(text.split("\n"), 1):
        for name in re.findall(r"`([^`]+)`", line):
            word = name.split(" ")[0]
            if word.startswith("build/release/"):
                program = os.path.basename(word)
                # By its name, or as one of several: `smart_room_${program}`.
                known = rf"((add_executable|robdef_test)\(|OUTPUT_NAME )({re.escape(program)}[ )\n]|{re.escape(program.rpartition('_')[0])}_[$])"
                if not re.search(known, programs):
                    complain(page, number, f"there is no program {program}")
            elif re.match(r"(docs|runtime|examples|compiler|benchmarks|conformance|rr)/", word):
                if not glob.glob(os.path.join(root, word)) and not glob.glob(os.path.join(root, "runtime/cpp/include", word)):
                    complain(page, number, f"there is no file {word}")
            else:
                test = re.fullmatch(r"(?:[A-Za-z]+/)?([A-Z][A-Za-z]+\.(?:[A-Z][A-Za-z]+|\*))", name)
                if test and not any(known.startswith(test.group(1).rstrip("*")) for known in tests):
                    complain(page, number, f"there is no test {name}")


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("root")
    parser.add_argument("--names", action="append", default=[], metavar="PAGE")
    parser.add_argument("--sentences", action="store_true", help="print averages, and sentences of more than 30 words")
    arguments = parser.parse_args()
    status, texts = 0, {}

    def read(page):
        if page not in texts:
            with open(os.path.join(arguments.root, page), encoding="utf-8") as file:
                texts[page] = file.read()
        return texts[page]

    def complain(page, line, what):
        nonlocal status
        status = 1
        print(f"{page}:{line}: {what}", file=sys.stderr)

    count = 0
    for page in pages(arguments.root):
        count += 1
        check_links(arguments.root, page, read(page), read, complain)
        check_sentences(page, read(page), complain, arguments.sentences)
        if is_for_users(page):
            check_words(page, read(page), complain)
    for page in arguments.names:
        check_names(arguments.root, page, read(page), complain)
    if count < 40:
        complain(arguments.root, 0, f"only {count} pages were found")
    print(f"{count} pages")
    return status


if __name__ == "__main__":
    sys.exit(main())
