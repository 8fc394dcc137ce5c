#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""A second renderer of the templates of `robdef generate`, which shares no code with the compiler.

    render.py ROBDEF TREE compare LANG FILE...   renders `robdef view --lang LANG` with the templates of
                                                 the tree and compares the files with those of
                                                 `robdef generate --lang LANG`, byte for byte
    render.py ROBDEF TREE share FILE...          prints for each language how much of its output stands
                                                 in templates, and which fields of views the most of the rest

What differs is printed; exit status 1.
"""
import collections
import json
import pathlib
import re
import subprocess
import sys
import tempfile

import cpp_lines

TAG = re.compile(r"\{\{(?!\{)([#^/>!]?)(.*?)\}\}", re.DOTALL)


def tokens(source):
    """(sign, name or text, blanks before a tag that is alone on its line or None)."""
    at = 0
    for tag in TAG.finditer(source):
        begin, end = tag.span()
        sign, name = tag.group(1), tag.group(2).strip(" \t")
        line = source.rfind("\n", 0, begin) + 1
        stop = source.find("\n", end)
        stop = len(source) if stop < 0 else stop
        alone = sign != "" and line >= at and not source[line:begin].strip(" \t") and not source[end:stop].strip(" \t")
        text = source[at:line if alone else begin]
        if text:
            yield "text", text, None
        if sign != "!":
            yield sign or "value", name, source[line:begin] if alone else None
        at = min(stop + 1, len(source)) if alone else end
    if at < len(source):
        yield "text", source[at:], None


def parse(stream, closing=None):
    """Tokens -> tree: sections hold what is inside them."""
    nodes = []
    for sign, name, blanks in stream:
        if sign == "/":
            assert name == closing, f"{{{{/{name}}}}} closes {closing}"
            return nodes
        inside = parse(stream, name) if sign in "#^" else None
        nodes.append((sign, name, blanks, inside))
    assert closing is None, f"{closing} is not closed"
    return nodes


class Renderer:
    """Prints templates; counts the bytes that come from templates and those that come from views."""

    def __init__(self, sources):
        self.trees = {name: parse(tokens(text)) for name, text in sources.items()}
        self.of_templates = 0
        self.of_views = 0
        self.by_field = collections.Counter()
        self.lists = []

    def render(self, name, views):
        return self.run(self.trees[name], views)

    def run(self, tree, views):
        self.out, self.line_begins = [], True
        self.frames = [(view, True, True) for view in views]
        self.print(tree, "")
        return "".join(self.out)

    def write(self, text, is_template):
        self.out.append(text)
        size = len(text.encode())
        if is_template:
            self.of_templates += size
        else:
            self.of_views += size

    def begin(self, indent):
        if self.line_begins:
            self.write(indent, True)
        self.line_begins = False

    def print(self, tree, indent):
        """Where a line begins is a matter of the template's text, whatever is printed: each part of a
        section, printed or not, moves it on as if it were printed once."""
        for sign, name, blanks, inside in tree:
            if sign == "text":
                for line in name.splitlines(keepends=True) if name else []:
                    if line != "\n":
                        self.begin(indent)
                    self.write(line, True)
                    self.line_begins = line.endswith("\n")
            elif sign == "value":
                self.begin(indent)
                value = self.find(name)
                self.write(value, False)
                self.by_field[self.lists[-1] if name == "." else name] += len(value.encode())
            elif sign == ">":
                before, self.line_begins = self.line_begins, True
                self.print(self.trees[name + ".mustache"], indent + (blanks or ""))
                self.line_begins = True
            else:
                if blanks is None:
                    self.begin(indent)
                first = len(self.out)
                self.section(sign, name, inside, indent)
                if name in ("@c++", "@columns"):
                    change = cpp_lines.broken_lines if name == "@c++" else cpp_lines.columns
                    self.out[first:] = [change("".join(self.out[first:]))]

    def section(self, sign, name, inside, indent):
        begins = self.line_begins
        for frame in self.repeats(sign, name):
            self.line_begins = begins
            if frame:
                self.frames.append(frame)
                self.lists.append(name)
            self.print(inside, indent)
            if frame:
                self.frames.pop()
                self.lists.pop()
        self.line_begins = self.after(inside, begins)

    def after(self, tree, begins):
        """Whether a line begins behind a tree."""
        for sign, name, blanks, inside in tree:
            if sign == "text":
                begins = name.endswith("\n")
            elif sign == "value":
                begins = False
            elif sign == ">":
                begins = True
            else:
                begins = self.after(inside, begins and blanks is not None)
        return begins

    def repeats(self, sign, name):
        """For each time that a section is printed: a new frame, or None where names stay."""
        if name in ("@c++", "@columns"):
            return [None]
        if name in ("@first", "@last"):
            is_there = self.frames[-1][1 if name == "@first" else 2]
            return [None] if is_there == (sign == "#") else []
        value = self.find(name)
        if sign == "^":
            return [] if value else [None]
        if isinstance(value, list):
            last = len(value) - 1
            return [(item, i == 0, i == last) for i, item in enumerate(value)]
        if isinstance(value, dict):
            return [(value, True, True)]
        return [None] if value else []

    def find(self, name):
        if name == ".":
            return self.frames[-1][0]
        first, *rest = name.split(".")
        for view, _, _ in reversed(self.frames):
            if isinstance(view, dict) and first in view:
                value = view[first]
                for part in rest:
                    value = value[part]
                return value
        raise KeyError(name)


def subjects(view, subject):
    """The views that a rule of outputs.txt is for, each with those around it."""
    if subject == "all":
        yield [view]
    elif subject in ("service", "draft"):
        yield from ([view, one] for one in view["services"])
    elif subject == "bus":
        for definition in view["definitions"]:
            yield from ([view, definition, one] for one in definition["records"] if one["is_bus"])
    else:
        part = {"enum": "enumeration"}.get(subject, subject)
        for definition in view["definitions"]:
            if subject == "definition":
                yield [view, definition]
            else:
                yield from ([view, definition, one[part]] for one in definition["declarations"] if one[part])


def run(command):
    result = subprocess.run(command, stdout=subprocess.PIPE, stderr=subprocess.PIPE, check=False)
    if result.returncode != 0:
        raise RuntimeError(f"{' '.join(map(str, command))}: status {result.returncode}\n{result.stderr.decode()}")
    return result.stdout


def rendered(robdef, tree, language, files):
    """All files of a language by name, and the renderers that made them."""
    folder = pathlib.Path(tree) / "compiler/backends" / language / "templates"
    renderer = Renderer({path.name: path.read_text("utf-8") for path in folder.glob("*.mustache")})
    view = json.loads(run([robdef, "view", "--no-config", "--lang", language, *files]))
    made = {}
    for line in (folder / "outputs.txt").read_text().splitlines():
        if line.startswith("#"):
            continue
        subject, template, path = line.split()
        for views in subjects(view, subject):
            name = Renderer({"path": path}).render("path", views)
            if name:
                made[name] = renderer.render(template, views).encode()
    renderers = [renderer]
    if language == "matlab":  # the client under the classes is that of C++
        client, more = rendered(robdef, tree, "cpp", files)
        made.update({"client/cpp/" + name: content for name, content in client.items()})
        renderers += more
    return made, renderers


def compare(robdef, tree, language, files):
    made, _ = rendered(robdef, tree, language, files)
    with tempfile.TemporaryDirectory() as folder:
        run([robdef, "generate", "--no-config", "--lang", language, "-o", folder, *files])
        root = pathlib.Path(folder)
        expected = {str(path.relative_to(root)): path.read_bytes() for path in root.rglob("*") if path.is_file()}
    assert expected, "nothing was generated"
    wrong = sorted(name for name in made.keys() | expected.keys() if made.get(name) != expected.get(name))
    for name in wrong:
        ours, theirs = made.get(name, b"").splitlines(), expected.get(name, b"").splitlines()
        line = next((i for i, pair in enumerate(zip(ours, theirs)) if pair[0] != pair[1]), min(len(ours), len(theirs)))
        print(f"{name}:{line + 1}: rendered {ours[line:line + 1]}, generated {theirs[line:line + 1]}")
    print(f"{language}: {len(expected)} files, {sum(map(len, expected.values()))} bytes, {len(wrong)} differ")
    return not wrong


def share(robdef, tree, files):
    print("| language | bytes | from templates | from views | most of that |\n|---|---|---|---|---|")
    for outputs in sorted(pathlib.Path(tree).glob("compiler/backends/*/templates/outputs.txt")):
        language = outputs.parent.parent.name
        text = values = 0
        fields = collections.Counter()
        for file in files:
            try:
                renderer = rendered(robdef, tree, language, [file])[1][0]
            except RuntimeError:  # a language that cannot have this definition
                continue
            text += renderer.of_templates
            values += renderer.of_views
            fields += renderer.by_field
        total = text + values
        if total:
            most = ", ".join(f"`{name}` {100 * size / total:.0f} %" for name, size in fields.most_common(5))
            print(f"| {language} | {total:,} | {100 * text / total:.0f} % | {100 * values / total:.0f} % | {most} |")
    return True


def main():
    robdef, tree, verb, *rest = sys.argv[1:]
    is_right = compare(robdef, tree, rest[0], rest[1:]) if verb == "compare" else share(robdef, tree, rest)
    sys.exit(0 if is_right else 1)


main()
