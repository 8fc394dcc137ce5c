# SPDX-License-Identifier: Apache-2.0
"""Breaks long lines of C++ as `{{#@c++}}` of templates does (docs/howto/plugins.md, "Long lines of C++"). Written from the
page, not from the compiler."""

WIDTH = 100
DEEPER = 4
OPEN, CLOSE = "(<{[", ")>}]"


def outside(text):
    """Places of a text that are in no brackets and no string; brackets count when they open or close the outermost."""
    depth, in_string, at = 0, False, 0
    while at < len(text):
        c = text[at]
        if in_string:
            if c == "\\":
                at += 1
            elif c == '"':
                in_string = False
        elif c == '"':
            in_string = True
        elif c in OPEN:
            if depth == 0:
                yield at
            depth += 1
        elif c in CLOSE and depth > 0 and not (c == ">" and text[at - 1] == "-"):
            depth -= 1
            if depth == 0:
                yield at
        elif depth == 0:
            yield at
        at += 1


def places(text, wanted):
    return [at for at in outside(text) if text[at] == wanted]


def split_items(text):
    items, begin = [], 0
    for comma in places(text, ","):
        items.append(text[begin:comma])
        begin = comma + 2
    return items + [text[begin:]] if text else []


def split_list(text, brackets="()"):
    """(before, items, after), with the first brackets of a kind that are in no others."""
    found = places(text, brackets[0])
    if not found:
        return None
    first = found[0]
    closing = places(text[first:], brackets[1])
    if not closing:
        return None
    last = first + closing[0]
    return text[:first + 1], split_items(text[first + 1:last]), text[last:]


def fill(items, after, column):
    lines, line = [], ""
    for number, item in enumerate(items):
        item += after if number + 1 == len(items) else ","
        if column + len(item) > WIDTH:
            return None
        if not line:
            line = item
        elif column + len(line) + 1 + len(item) <= WIDTH:
            line += " " + item
        else:
            lines.append(line)
            line = item
    return lines + [line]


def joined(lines, column):
    return ("\n" + " " * column).join(lines)


def break_list(parts, indent, is_declaration):
    before, items, after = parts
    flat = before + ", ".join(items) + after
    if not items or indent + len(flat) <= WIDTH:
        return flat
    deeper = indent + DEEPER
    aligned = fill(items, after, indent + len(before))
    below = fill(items, after, deeper)
    if aligned and (is_declaration or not below or len(aligned) <= len(below) + 1):
        return before + joined(aligned, indent + len(before))
    if is_declaration and not below:
        if len(items) == 1:
            kind, _, name = items[0].rpartition(" ")
            return before + kind + "\n" + " " * (indent + len(before) + DEEPER) + name + after
        filled = fill(items, ")", deeper) if after.startswith(") ") else None
        if filled:
            return before + "\n" + " " * deeper + joined(filled, deeper) + "\n" + " " * deeper + after[2:]
    inside = joined(below if below else [item + "," for item in items[:-1]] + [items[-1] + after], deeper)
    here = "\n" + " " * deeper
    angle = before.find("<")
    if indent + len(before) <= WIDTH or angle < 0:
        return before + here + inside
    return before[:angle + 1] + here + before[angle + 1:] + here + inside


def break_values(parts, indent):
    before, items, after = parts
    blanks = places(before[:-1], " ")
    if indent + len(before) > WIDTH and blanks:
        deeper = indent + DEEPER
        rest = break_values((before[blanks[-1] + 1:], items, after), deeper)
        return before[:blanks[-1]] + "\n" + " " * deeper + rest
    deeper = indent + DEEPER
    flat = ", ".join(items) + after
    if "{}" not in items or indent + len(before + flat) <= WIDTH:
        return break_list(parts, indent, False)
    if deeper + len(flat) <= WIDTH:
        return before + "\n" + " " * deeper + flat
    column = indent + len(before)
    lines = [item + "," for item in items[:-1]] + [items[-1] + after]
    if column + max(map(len, lines)) <= WIDTH:
        return before + joined(lines, column)
    return before + "\n" + " " * deeper + joined(lines, deeper)


def braces(text, indent):
    if not text.startswith("return {"):
        values = split_list(text, "{}")
        return break_values(values, indent) if values else text
    if not text.endswith("};") or indent + len(text) <= WIDTH:
        return text
    column = indent + len("return {")
    lines = []
    items = split_items(text[len("return {"):-2])
    for number, item in enumerate(items):
        item += "};" if number + 1 == len(items) else ","
        if column + len(item) > WIDTH and "[" in item:
            item = item.replace("[", "\n" + " " * (column + DEEPER) + "[", 1)
        lines.append(item)
    return "return {" + joined(lines, column)


def call(text, indent):
    outer = split_list(text)
    if not outer:
        return braces(text, indent)
    before, items, after = outer
    inner = split_list(items[0]) if len(items) == 1 else None
    if not inner or inner[2] != ")" or not inner[1]:
        return break_list(outer, indent, False)
    result = break_list((before + inner[0], inner[1], ")" + after), indent, False)
    first, line_end, _ = result.partition("\n")
    if not line_end or not first.endswith("("):
        return result
    deeper = indent + DEEPER
    return before + "\n" + " " * deeper + break_list((inner[0], inner[1], ")" + after), deeper, False)


def break_type(text, indent):
    if indent + len(text) <= WIDTH or not text.endswith(">"):
        return text
    before, _, inside = text[:-1].partition("<")
    before, after = before + "<", ">"
    parameters = places(inside, "(")
    if parameters and inside.endswith(")"):
        before, after = before + inside[:parameters[0] + 1], ")>"
        inside = inside[parameters[0] + 1:-1]
    items = split_items(inside)
    if len(items) < 2 and not parameters and "Event<" not in before:
        return text
    return break_list((before, items, after), indent, False)


def signature(text, end, indent):
    """`virtual double get(int a) const` with what follows, broken; None where it is no such thing."""
    parts = split_list(text)
    if not parts:
        return None
    blanks = places(parts[0][:-1], " ")
    if not blanks:
        return None
    result, name = parts[0][:blanks[-1]], parts[0][blanks[-1] + 1:-1]
    if result == "return":
        return None
    virtual = "virtual " if result.startswith("virtual ") else ""
    result = virtual + break_type(result[len(virtual):], indent)
    items, behind = parts[1], parts[2][1:]
    before, after = result + " " + name + "(", ")" + behind + end
    if indent + len(before) + (0 if items else len(after)) <= WIDTH:
        return break_list((before, items, after), indent, True)
    if not items and behind == " override" and indent + len(before) + 1 <= WIDTH:
        return before + ")\n" + " " * (indent + DEEPER) + "override" + end
    return result + "\n" + " " * indent + break_list((name + "(", items, after), indent, True)


def function(text, indent):
    if not text.endswith(" }"):
        return None
    bodies = places(text, "{")
    if not bodies or bodies[-1] + 2 > len(text) - 2:
        return None
    head = signature(text[:bodies[-1] - 1], " {", indent)
    if head is None:
        return None
    body = call(text[bodies[-1] + 2:-2], indent + 2)
    return head + "\n" + " " * (indent + 2) + body + "\n" + " " * indent + "}"


def signs(text, sign):
    """Places of a sign with blanks around it that is in no brackets."""
    return [at for at in outside(text) if text.startswith(sign, at)]


def class_head(text, indent):
    colons = signs(text, " : ")
    if not text.startswith("class ") or not text.endswith(" {") or not colons:
        return None
    head, bases = text[:colons[0]], split_items(text[colons[0] + 3:-2])
    column = indent + len(head) + 3
    if max(column + len(base) + 2 for base in bases) <= WIDTH:
        return head + " : " + (",\n" + " " * column).join(bases) + " {"
    deeper = "\n" + " " * (indent + DEEPER)
    return head + deeper + ": " + ("," + deeper + "  ").join(bases) + " {"


def constructor(text, indent):
    colons = signs(text, " : ")
    if not colons or not text.endswith(" {}"):
        return None
    head, base = signature(text[:colons[0]], "", indent), split_list(text[colons[0] + 3:])
    if not head or not base:
        return None
    deeper = indent + DEEPER
    return head + "\n" + " " * deeper + ": " + break_list(base, deeper + 2, False)


def variable(text, indent):
    equals = signs(text, " = ")
    if equals and text.endswith(";"):
        left, value = text[:equals[0]], text[equals[0] + 3:]
    elif text.endswith(";"):
        left, value = text[:-1], None
        if left.endswith("{}"):
            left = left[:-2]
    else:
        return None
    if places(left, "(") or places(left, "{") or left.startswith("return "):
        return None
    deeper = indent + DEEPER
    if value is not None and indent + len(left) + 2 <= WIDTH:
        return left + " =\n" + " " * deeper + value
    blanks = places(left, " ")
    if not blanks:
        return None
    kind, name, rest = text[:blanks[-1]], left[blanks[-1] + 1:], text[blanks[-1] + 1:]
    if value is None or deeper + len(rest.encode()) <= WIDTH:
        return kind + "\n" + " " * deeper + rest
    if deeper + len(name) + 2 > WIDTH and "<" in name:
        outer, _, inner = name.partition("<")
        return kind + " " + outer + "<" + "".join("\n" + " " * deeper + line for line in (inner + " =", value))
    return kind + "\n" + " " * deeper + name + " =\n" + " " * (deeper + DEEPER) + value


def table_rows(items, width):
    """Items in as many columns as are worth it."""
    best, rows = [0], len(items)
    if rows >= 5:
        for count in range(2, min(rows, WIDTH // 3) + 1):
            widths = widths_for(items, count, width)
            if widths and -(-len(items) // count) < rows:
                best, rows = widths, -(-len(items) // count)
    for begin in range(0, len(items), len(best)):
        row = items[begin:begin + len(best)]
        yield "".join(item.ljust(size + 1) for item, size in zip(row[:-1], best)) + row[-1]


def array(text, indent):
    before, begin, inside = text.partition(" = {")
    if not begin or not inside.endswith("};"):
        return None
    deeper = indent + DEEPER
    items = [item if deeper + len(item) <= WIDTH else call(item, deeper) for item in split_items(inside[:-2])]
    if len(items) <= 5:
        return break_list((before + begin, items, "};"), indent, False)
    rows = table_rows([item + "," for item in items], WIDTH - deeper)
    return before + begin + "".join("\n" + " " * deeper + row for row in rows) + "\n" + " " * indent + "};"


def broken(line):
    text = line.lstrip(" ")
    indent = len(line) - len(text)
    if len(line.encode()) <= WIDTH or text.startswith(("//", "#")):
        return line
    result = class_head(text, indent)
    if result is None:
        result = constructor(text, indent)
    if result is None and text.endswith(" {}"):
        head = signature(text[:-3], " {", indent)
        result = None if head is None else head + "}"
    if result is None:
        result = function(text, indent)
    if result is None:
        result = array(text, indent)
    if result is None:
        result = variable(text, indent)
    for end in (" {", ";"):
        if result is None and text.endswith(end):
            result = signature(text[:-len(end)], end, indent)
    return " " * indent + (call(text, indent) if result is None else result)


def broken_lines(text):
    return "\n".join(broken(line) for line in text.split("\n"))


def widths_for(items, count, width):
    """Of the columns when items are put into so many; None when that does not fit or is mostly blanks."""
    sizes = [[len(item.encode()) for item in items[column::count]] for column in range(count)]
    if any(max(column) - min(column) > 10 for column in sizes[:-1]):
        return None
    longest = [max(column) for column in sizes]
    return longest if sum(longest) + count - 1 <= width else None


def columns(text):
    lines = text.split("\n")[:-1]
    indent = len(lines[0]) - len(lines[0].lstrip(" "))
    items = [broken(line)[indent:] for line in lines]
    return "".join(" " * indent + row + "\n" for row in table_rows(items, WIDTH - indent))
