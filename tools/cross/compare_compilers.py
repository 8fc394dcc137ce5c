#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Holds a robdef that runs in an emulator to the one of this machine: files that they write, what they print, how they end.

Usage: compare_compilers.py TREE HERE OTHER FOLDER [PLUGIN_HERE PLUGIN_OTHER]
  HERE, OTHER  the two programs; a word with blanks is a command with arguments ("wine robdef.exe")
  FOLDER       is made anew for inputs and outputs
Paths on the command lines are relative and have slashes, so that both programs are given the same words.
"""
import concurrent.futures
import json
import os
import pathlib
import shutil
import subprocess
import sys
import urllib.parse

LANGUAGES = ["cpp", "csharp", "matlab", "typescript"]
ODD_NAME = "Gerät 100 % (neu) α 🤖"


class Case:
    def __init__(self, name, words, inputs=(), stdin=b"", environment=None, twice=False):
        self.name, self.words, self.inputs = name, words, inputs
        self.is_one_file = False
        self.stdin, self.environment, self.twice = stdin, environment or {}, twice


def copied(source, target, change=lambda text: text):
    """Input files of a case: (path within its folder, bytes)."""
    return [(f"{target}/{path.name}", change(path.read_bytes())) for path in sorted(source)]


def with_crlf(text):
    return text.replace(b"\r\n", b"\n").replace(b"\n", b"\r\n")


def names(inputs):
    return [path for path, _ in inputs if path.endswith(".robdef")]


def generate(name, inputs, languages, more=(), **others):
    for language in languages:
        words = ["generate", "--no-config", "--lang", language, "-o", "out", "--depfile", "out.d", *more]
        yield Case(f"{name}.{language}", [*words, *names(inputs)], inputs, **others)


def without_lengths(answers):
    """What a language server has sent, one message a line: it depends on the names of folders how long they are."""
    bodies = []
    while answers:
        head, _, rest = answers.partition(b"\r\n\r\n")
        size = int(head.split(b"Content-Length: ")[1].split(b"\r\n")[0])
        bodies.append(rest[:size])
        answers = rest[size:]
    return b"\n".join(bodies)


def message(**content):
    body = json.dumps({"jsonrpc": "2.0", **content}).encode()
    return b"Content-Length: %d\r\n\r\n" % len(body) + body


def editor_session(text, uri, root=None):
    place = {"uri": uri}
    return (message(id=1, method="initialize", params={"capabilities": {}, "rootUri": root}) + message(method="initialized", params={}) +
            message(method="textDocument/didOpen",
                    params={"textDocument": {**place, "languageId": "robdef", "version": 1, "text": text}}) +
            message(id=2, method="textDocument/documentSymbol", params={"textDocument": place}) +
            message(id=3, method="shutdown") + message(method="exit"))


def cases(tree, plugin):
    corpus = tree / "compiler/grammar/corpus"
    backends = tree / "compiler/backends"
    features = copied((tree / "conformance/definitions").glob("*.robdef"), "in")
    room = copied([tree / "examples/smart_room/RobotCameraHost_interface.robdef"], "in")
    light = copied([backends / "arduino/definitions/example.light.robdef"], "in")
    for path in sorted((corpus / "accept").glob("*.robdef")):
        for case in generate(f"accept.{path.stem}", copied([path], "in"), LANGUAGES):
            # Two classes whose names differ in case alone: not two files there.
            case.is_one_file = case.name == "accept.A_names_case_sensitive.matlab"
            yield case
    for path in sorted((corpus / "reject").glob("*.robdef")):
        yield Case(f"reject.{path.stem}", ["check", f"in/{path.name}"], copied([path], "in"))
    yield from generate("features", features, LANGUAGES, ["-I", "in"], twice=True)
    yield from generate("smart_room", room, LANGUAGES)
    yield from generate("buses", copied((backends / "cbus/definitions").glob("*.robdef"), "in"), ["cbus"], ["-I", "in"])
    for path in sorted((backends / "arduino/definitions").glob("*.robdef")):
        yield from generate(f"arduino.{path.stem}", copied([path], "in"), ["arduino"])

    crlf = [(path, with_crlf(text)) for path, text in features]
    yield from generate("crlf", crlf, LANGUAGES, ["-I", "in"])
    odd = [(path.replace("in/", ODD_NAME + "/"), text) for path, text in features]
    yield from generate("odd_folder", odd, LANGUAGES, ["-I", ODD_NAME])
    yield Case("odd_output", ["generate", "--no-config", "--lang", "cpp", "-o", ODD_NAME + "/ö", *names(room)], room)
    lists = {"ROBOTRACONTEUR_ROBDEF_PATH": f"nowhere;{ODD_NAME}"}
    importing = next(path for path, text in odd if b"\nimport " in text)
    yield Case("odd_import", ["generate", "--no-config", "--lang", "cpp", "-o", "out", importing], odd)
    moved = "in/" + importing.split("/")[1]
    apart = [(moved if path == importing else path, text) for path, text in odd]
    yield Case("list_of_folders", ["model", "--no-config", moved], apart, environment=lists)
    project = ('inputs = ["%s/**/*.robdef", "in/[!x]?*.robdef"]\nimport-path = ["%s"]\n[cpp]\noutput = "out/%s"\n' %
               (ODD_NAME, ODD_NAME, ODD_NAME)).encode()
    yield Case("project", ["generate"], [*odd, *light, ("robdef.toml", project)], twice=True)

    for command in (["model"], ["describe"], ["check", "--format=json"], ["format", "--check"], ["docs", "-o", "out"]):
        yield Case(f"features.{command[0]}", [*command, "--no-config", "-I", "in", *names(features)]
                   if command[0] != "format" else [*command, *names(features)], features)
    yield Case("view", ["view", "--no-config", "--lang", "cpp", *names(room)], room)
    yield Case("format", ["format", *names(crlf)], crlf)
    yield Case("stdin", ["check", "-"], stdin=with_crlf(room[0][1]))
    yield Case("stdin_model", ["model", "-"], stdin=room[0][1])
    older = [(path.replace("in/", "older/"), text) for path, text in room]
    newer = [(path.replace("in/", "newer/"), text.replace(b"double", b"single")) for path, text in room]
    yield Case("breaking", ["breaking", "older", "newer"], older + newer)
    yield Case("explain", ["explain", "R0203"])
    yield Case("help", ["generate", "--help"])
    yield Case("no_such_file", ["check", "in/missing.robdef"])
    yield Case("a_folder", ["check", "in"], room)
    # A folder where a file is to be written: nothing is.
    yield Case("in_the_way", ["generate", "--no-config", "--lang", "matlab", "-o", "out", *names(room)],
               room + [("out/build_RobotCameraHost_interface_client.m/x", b"")])
    yield Case("lsp", ["lsp"], stdin=editor_session(room[0][1].decode(), "untitled:a.robdef"))
    # Imports are files in the folder of the first, whose names are URIs.
    text = dict(odd)[importing].decode()
    session = editor_session(text, f"ROOT/{urllib.parse.quote(ODD_NAME)}/a.robdef", "ROOT")
    yield Case("lsp_folder", ["lsp"], odd, stdin=session)
    if plugin:
        yield Case("plugin", ["generate", "--no-config", "-o", "out", "--plugin", "PLUGIN", *names(room)], room)
    yield Case("no_plugin", ["generate", "--no-config", "-o", "out", "--plugin", "no_such_program", *names(room)], room)


def settled(messages):
    """Answers of the language server, and then its last diagnostics of each file: how many come before depends on the time."""
    answers, last = [], {}
    for line in messages.splitlines():
        message = json.loads(line)
        if message.get("method") == "textDocument/publishDiagnostics":
            last[message["params"]["uri"]] = line
        else:
            answers.append(line)
    return b"\n".join(answers + [last[uri] for uri in sorted(last)])


def tree_of(folder):
    return {str(path.relative_to(folder)): path.read_bytes() for path in sorted(folder.rglob("*")) if path.is_file()}


def ended_program(words, case, folder, root):
    given = case.stdin
    if b"ROOT" in given:
        given = b"".join(b"Content-Length: %d\r\n\r\n%s" % (len(body), body)
                         for body in without_lengths(given).replace(b"ROOT", root).split(b"\n"))
    for _ in range(3):
        ended = subprocess.run(words, cwd=folder, input=given, capture_output=True, timeout=300, check=False,
                               env={**os.environ, **case.environment})
        # robdef says why it fails; wine may fail to start a program, and says nothing, or that its server is gone.
        is_lost = ended.stderr.startswith(b"wine client error") or not (ended.stdout or ended.stderr)
        if ended.returncode == 0 or not is_lost:
            break
    return ended


def run(case, program, plugin, folder):
    """What the program printed, how it ended, and the files that are there afterwards."""
    folder.mkdir(parents=True)
    for path, content in case.inputs:
        (folder / path).parent.mkdir(parents=True, exist_ok=True)
        (folder / path).write_bytes(content)
    # Programs for Windows see the root of this machine as a drive of wine.
    root = f"file://{'/Z%3A' if program[0] == 'wine' else ''}{folder}".encode()
    words = [plugin if word == "PLUGIN" else word for word in case.words]
    results = []
    for _ in range(2 if case.twice else 1):
        ended = ended_program([*program, *words], case, folder, root)
        if case.words == ["lsp"]:
            ended.stdout = settled(without_lengths(ended.stdout).replace(root, b"ROOT"))
        results.append((ended.returncode, ended.stdout, ended.stderr.replace(plugin.encode(), b"PLUGIN") if plugin else
                        ended.stderr))
    return results, tree_of(folder)


def excerpt(value):
    return repr(value if len(value) < 600 else value[:600] + b"...")


def differences(case, here, other):
    if case.is_one_file:
        code, _, err = other[0][0]
        if code != 1 or b"is the same file as" not in err or other[1].keys() != {path for path, _ in case.inputs}:
            yield f"{case.name}: two files of one name were not refused: {excerpt(err)}"
        return
    for (code, out, err), (other_code, other_out, other_err) in zip(here[0], other[0]):
        if code != other_code:
            yield f"{case.name}: ends with {other_code} instead of {code}: {excerpt(other_err)}"
        elif out != other_out or err != other_err:
            what, first, second = ("prints", out, other_out) if out != other_out else ("says", err, other_err)
            yield f"{case.name}: {what} {excerpt(second)} instead of {excerpt(first)}"
    for path in sorted(here[1].keys() | other[1].keys()):
        first, second = here[1].get(path), other[1].get(path)
        if first != second:
            how = "is not written" if second is None else "should not be there" if first is None else "differs"
            yield f"{case.name}: {path} {how}"


def main(tree, here, other, work, plugin_here="", plugin_other=""):
    tree, work = pathlib.Path(tree), pathlib.Path(work).absolute()
    shutil.rmtree(work, ignore_errors=True)
    wanted = list(cases(tree, plugin_here))

    def both(case):
        return (run(case, here.split(), plugin_here, work / "here" / case.name),
                run(case, other.split(), plugin_other, work / "other" / case.name))

    found, files, generated = [], 0, 0
    with concurrent.futures.ThreadPoolExecutor(os.cpu_count()) as pool:
        for case, (first, second) in zip(wanted, pool.map(both, wanted)):
            found += differences(case, first, second)
            made = len(first[1]) - len({path for path, _ in case.inputs})
            files += made
            generated += made > 0
    for finding in found:
        print(finding)
    # Most of the accepted definitions can be had in most languages: else nothing was compared.
    if generated < 300:
        found.append("")
        print(f"only {generated} of {len(wanted)} runs have written files")
    print(f"{len(wanted)} runs, {files} files written by each: {'FAILED' if found else 'PASSED'}")
    return 1 if found else 0


if __name__ == "__main__":
    if len(sys.argv) not in (5, 7):
        sys.exit(__doc__)
    sys.exit(main(*sys.argv[1:]))
