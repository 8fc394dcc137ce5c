#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""A plug-in of `robdef generate`: writes a Markdown page for each definition.

    robdef generate --plugin examples/plugin/reference.py -o pages example.arm.robdef

Options: `title=TEXT` makes an index page, `require_docs=yes` warns of members without documentation.
"""
import json
import sys


def cell(text):
    """Text in one cell of a table."""
    return " ".join(str(text).split()).replace("|", "\\|")


def table(head, rows):
    if not rows:
        return []
    lines = [f"| {' | '.join(head)} |", "|" + "---|" * len(head)]
    lines += [f"| {' | '.join(cell(item) for item in row)} |" for row in rows]
    return lines + [""]


def section(title, item, kind=""):
    lines = [f"## {title}", ""]
    if kind:
        lines += [kind, ""]
    if item["documentation"]:
        lines += [item["documentation"], ""]
    return lines


def type_of(type):
    """A type, with a link if it is declared somewhere."""
    if type["definition"] is None:
        return f"`{type['text']}`"
    anchor = type["name"].rsplit(".", 1)[1].lower()
    return f"[`{type['text']}`]({type['definition']}.md#{anchor})"


def value_of(constant, all_constants):
    """The value of a constant; for a struct those of its fields."""
    if constant["type"] != "struct":
        return f"`{json.dumps(constant['value'])}`"
    values = {one["name"]: one for one in all_constants}
    fields = [f"{one['field']} = {value_of(values[one['constant']], all_constants)}" for one in constant["value"]]
    return ", ".join(fields)


def constants(items):
    rows = [(f"`{one['name']}`", f"`{one['type']}`", value_of(one, items), one["documentation"]) for one in items]
    return table(["constant", "type", "value", ""], rows)


def record(item, kind):
    size = {"pod": f", at most {item.get('packed_size')} bytes",
            "namedarray": f" of {item.get('number_count')} numbers ({item.get('number')})"}
    lines = section(item["name"], item, f"A {kind}{size.get(kind, '')}.")
    rows = [(f"`{one['name']}`", type_of(one["type"]), one["documentation"]) for one in item["fields"]]
    return lines + table(["field", "type", ""], rows) + constants(item["constants"])


def parameters(member):
    shown = [f"{one['name']}: {type_of(one['type'])}" for one in member["parameters"]]
    stream = member["generator_parameter"]
    if stream:
        shown.append(f"{stream['name']}: a value for each step, {type_of(stream['type'])}")
    return ", ".join(shown)


def meaning(member):
    """What a member is of, in words."""
    facts = member["facts"]
    if facts["is_objref"]:
        index = {"none": "", "int32": ", by number", "string": ", by name"}
        return type_of(member["type"]) + index[member["index"]]
    if not (facts["is_function"] or facts["is_callback"] or facts["is_event"]):
        return type_of(member["type"])
    steps = {"none": "", "returns": " for each step", "takes": "", "both": " for each step"}[member["generator"]]
    result = f" → {type_of(member['type'])}{steps}" if facts["has_result"] else ""
    return f"({parameters(member)}){result}"


def object_page(item):
    implemented = ", ".join(f"`{name}`" for name in item["implements"])
    lines = section(item["name"], item, f"An object that implements {implemented}." if implemented else "An object.")
    rows = []
    for member in item["members"]:
        words = list(member["access"]) + ([f"from `{member['origin']}`"] if member["origin"] else [])
        rows.append((member["kind"], f"`{member['name']}`", meaning(member), ", ".join(words),
                     member["documentation"]))
    return lines + table(["kind", "member", "", "modifiers", ""], rows) + constants(item["constants"])


def page(definition):
    lines = [f"# {definition['name']}", ""]
    if definition["version"]:
        lines += [f"Written for version {definition['version']} of the language.", ""]
    if definition["documentation"]:
        lines += [definition["documentation"], ""]
    lines += constants(definition["constants"])
    for item in definition["enums"]:
        rows = [(f"`{one['name']}`", one["value"], one["documentation"]) for one in item["values"]]
        lines += section(item["name"], item, "An enum.") + table(["name", "value", ""], rows)
    for kind in ("struct", "pod", "namedarray"):
        for item in definition[kind + "s"]:
            lines += record(item, kind)
    for item in definition["exceptions"]:
        lines += section(item["name"], item, "An exception.")
    for item in definition["objects"]:
        lines += object_page(item)
    return "\n".join(lines).rstrip() + "\n"


def undocumented(definition):
    for item in definition["objects"]:
        for member in item["members"]:
            if not member["documentation"] and not member["origin"]:
                yield {"level": "warning", "at": member["at"],
                       "message": f"`{item['name']}.{member['name']}` has no documentation"}


def main():
    request = json.load(sys.stdin)
    if request["robdef_plugin"] != 1:
        sys.exit("reference.py: made for robdef_plugin 1")
    wanted = [one for one in request["definitions"] if not one["is_import"]]
    files = [{"path": one["name"] + ".md", "content": page(one)} for one in wanted]
    options = request["options"]
    if "title" in options:
        links = "".join(f"- [{one['name']}]({one['name']}.md)\n" for one in wanted)
        files.append({"path": "index.md", "content": f"# {options['title']}\n\n{links}"})
    findings = []
    if options.get("require_docs") == "yes":
        findings = [finding for one in wanted for finding in undocumented(one)]
    json.dump({"files": files, "findings": findings}, sys.stdout)


main()
