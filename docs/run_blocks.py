#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Runs the code blocks of a page, in order, in an empty folder, as a reader would. A file is written where the commands
before it have led.

A block is one of these:

  a file        the line before the block is its name and a colon: `main.cpp`:
  commands      the language of the block is `console`: lines `$ command`, each followed by its output. A line `...` of
                the output stands for any lines, `...` inside of a line for any text. A command without output may
                print anything. One that ends in ` &` runs on; its output is waited for. A block that begins with
                `# ` has commands for root: all its lines `# command`.
  not run       a comment before the block gives the reason: <!-- not run: needs a board -->

Other comments before a block:

  <!-- needs: dotnet -->      the block, and the rest of its section, is left out where a program is missing
  <!-- instead: COMMAND -->   runs COMMAND in place of the block
  <!-- built: COMMAND -->     the same with --build, where the work of the block is done
  <!-- fails -->              the last command of the block fails

A comment that stands for itself, and that readers do not see:

  <!-- check: COMMAND -->     runs COMMAND there, which must succeed: what the text around it promises

A block that is none of these is an error: no block of a page goes unseen.
"""
import argparse
import os
import re
import shlex
import shutil
import signal
import socket
import subprocess
import sys
import tempfile
import threading
import time

CAPTION = re.compile(r"^`([^`]+)`:$")
COMMENT = re.compile(r"^<!-- *(not run|needs|instead|built|fails|check)(?:: *(.*?))? *-->$")


class Failure(Exception):
    """What differs, with the line of the page."""

    def __init__(self, line, text):
        super().__init__(text)
        self.line = line


class Block:
    """One fenced block: its language, its lines, and what stands before it."""

    def __init__(self, line, language, heading):
        self.line = line
        self.language = language
        self.heading = heading  # its number, and its words
        self.section = ""
        self.lines = []
        self.file = None
        self.notes = {}


def read_blocks(text):
    """The fenced blocks of a page, with their captions and comments."""
    blocks, block, before, notes, heading, section = [], None, "", {}, 0, ""
    for number, line in enumerate(text.split("\n"), 1):
        if block is not None:
            if line.strip() == "```":
                blocks.append(block)
                block, before, notes = None, "", {}
            else:
                block.lines.append(line)
        elif line.startswith("```"):
            block = Block(number, line[3:].strip(), heading)
            caption = CAPTION.match(before)
            block.file = caption and caption.group(1)
            block.notes = notes
            block.section = section
        else:
            comment = COMMENT.match(line.strip())
            if comment and comment.group(1) == "check":
                check = Block(number - 1, "console", heading)
                check.section = section
                check.lines = ["$ " + (comment.group(2) or "false")]
                blocks.append(check)
            elif comment:
                notes[comment.group(1)] = comment.group(2) or ""
            elif line.strip():
                before, notes = line.strip(), notes if CAPTION.match(line.strip()) else {}
            if line.startswith("#"):
                heading += 1
                section = line.lstrip("#").strip()
    if block is not None:
        raise Failure(block.line, "the block has no end")
    return blocks


def read_commands(block):
    """The commands of a block: line, command, lines of expected output."""
    commands = []
    prompt = "# " if block.lines and block.lines[0].startswith("# ") else "$ "
    for number, line in enumerate(block.lines, block.line + 1):
        if commands and commands[-1][1].endswith("\\"):
            commands[-1][1] += "\n" + line
        elif line.startswith(prompt):
            commands.append([number, line[2:], []])
        elif commands:
            commands[-1][2].append((number, line.rstrip()))
        else:
            raise Failure(number, "a block of commands begins with `$ ` or `# `")
    return commands


def line_matches(expected, line):
    """`...` stands for any text."""
    return re.fullmatch(".*".join(re.escape(part) for part in expected.split("...")), line) is not None


def first_difference(expected, lines):
    """None where the output is as expected, else the line of the page and what was there."""
    position = 0
    anything = False
    for number, text in expected:
        if text == "...":
            anything = True
            continue
        found = position
        while anything and found < len(lines) and not line_matches(text, lines[found]):
            found += 1
        if found >= len(lines) or not line_matches(text, lines[found]):
            there = lines[position] if position < len(lines) else "nothing"
            return number, f"expected: {text}\n  there is: {there}"
        position, anything = found + 1, False
    if not anything and position < len(lines):
        return expected[-1][0], f"more output than expected: {lines[position]}"
    return None


class Shell:
    """One bash for all commands of a page, so that `cd` and variables last."""

    def __init__(self, folder, environment, program, is_system):
        self.folder = folder
        self.is_system = is_system  # the folder is the root of another system, in which the shell runs
        self.count = 0
        self.process = subprocess.Popen(
            program, cwd=folder, env=environment, stdin=subprocess.PIPE,
            stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True, start_new_session=True, errors="replace")
        self.lines = []
        self.news = threading.Condition()
        threading.Thread(target=self._read, daemon=True).start()

    def _read(self):
        for line in self.process.stdout:
            with self.news:
                self.lines.append(line.rstrip("\r\n"))
                self.news.notify()
        with self.news:
            self.lines.append(None)
            self.news.notify()

    def run(self, command, seconds):
        """Status and lines of output; None as the status when it takes too long."""
        self.count += 1
        mark = f"@@{os.getpid()}.{self.count}@@"
        self.process.stdin.write(f"{{ {command}\n}} </dev/null\nprintf '\\n%s %s\\n' '{mark}' $?\n")
        self.process.stdin.flush()
        output, end = [], time.monotonic() + seconds
        with self.news:
            while True:
                while self.lines:
                    line = self.lines.pop(0)
                    if line is None:
                        return 255, output
                    if line.startswith(mark):
                        if output and not output[-1]:
                            output.pop()  # the line end before the mark
                        return int(line.split()[1]), output
                    output.append(line)
                if not self.news.wait(max(0.0, end - time.monotonic())) and time.monotonic() >= end:
                    return None, output

    def start(self, command, expected, seconds):
        """Runs a command on; returns what its output lacks, or None."""
        self.count += 1
        name = f".output{self.count}"
        log = os.path.join(self.folder, name)
        with open(log, "w", encoding="utf-8"):
            pass  # before the command makes it
        # `exec`, so that `kill %1` reaches the program itself.
        self.run(f"exec {command[:-1].rstrip()} >{'/' + name if self.is_system else log} 2>&1 &", 10)
        end = time.monotonic() + seconds
        while True:
            with open(log, encoding="utf-8", errors="replace") as file:
                lines = [line.rstrip() for line in file]
            difference = first_difference(expected, lines) if expected else None
            if difference is None or time.monotonic() > end:
                return difference
            time.sleep(0.05)

    def path(self, name):
        """Where a file is that the page names: beside what its commands see."""
        _, output = self.run("pwd", 10)
        path = os.path.join(output[-1], name)
        return os.path.join(self.folder, path.lstrip("/")) if self.is_system else path

    def close(self):
        for what in (signal.SIGTERM, signal.SIGKILL):
            try:
                os.killpg(self.process.pid, what)
            except ProcessLookupError:
                break
            time.sleep(0.3)
        self.process.wait()


def run_block(block, shell, arguments):
    if block.file:
        path = shell.path(block.file)
        os.makedirs(os.path.dirname(path), exist_ok=True)
        with open(path, "w", encoding="utf-8") as file:
            file.write("\n".join(block.lines) + "\n")
        return
    instead = block.notes.get("instead") or (block.notes.get("built") if arguments.build else None)
    if instead:
        commands = [[block.line, instead, []]]
    elif block.language == "console":
        commands = read_commands(block)
    else:
        raise Failure(block.line, "the block is neither a file nor commands, and no comment says why it is not run")
    for number, command, expected in commands:
        if arguments.verbose:
            print(f"  {number}: {command}", flush=True)
        if command.endswith(" &"):
            difference = shell.start(command, expected, arguments.seconds)
            if difference:
                raise Failure(*difference)
            continue
        status, output = shell.run(command, arguments.seconds)
        if re.fullmatch(r"kill %\d+", command):
            shell.run("wait " + command.split()[1], arguments.seconds)  # its port is free then
        shown = "\n".join(f"  {line}" for line in output[-40:])
        if status is None:
            raise Failure(number, f"`{command}` did not end\n{shown}")
        fails = "fails" in block.notes and number == commands[-1][0]
        if (status != 0) != fails:
            raise Failure(number, f"`{command}` ended with status {status}\n{shown}")
        difference = first_difference(expected, [line.rstrip() for line in output]) if expected else None
        if difference:
            raise Failure(difference[0], f"`{command}`\n  {difference[1]}\nIts output:\n{shown}")


def is_wanted(section, arguments):
    """Whether a section is one of those that were asked for."""
    if arguments.only:
        return section in arguments.only
    return section not in arguments.skip


def run_page(text, folder, environment, arguments):
    """Runs all blocks; returns how many, and what was left out."""
    shell = Shell(folder, environment, shlex.split(arguments.shell or "bash --noprofile --norc"),
                  bool(arguments.shell))
    count, left_out, closed = 0, [], None
    try:
        for block in read_blocks(text):
            if block.heading == closed or not is_wanted(block.section, arguments):
                continue
            missing = [name for name in block.notes.get("needs", "").split()
                       if shell.run(f"command -v {name}", 10)[0] != 0]
            if missing:
                closed = block.heading
                left_out.append(f"line {block.line}: there is no {', '.join(missing)}")
            elif "not run" not in block.notes:
                run_block(block, shell, arguments)
                count += 1
    finally:
        shell.close()
    return count, left_out


def free_port():
    with socket.socket() as probe:
        probe.bind(("127.0.0.1", 0))
        return str(probe.getsockname()[1])


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("pages", nargs="+", metavar="PAGE")
    parser.add_argument("--build", help="the build folder, in place of what a page builds or installs")
    parser.add_argument("--set", action="append", default=[], metavar="NAME=VALUE", help="a variable of the environment")
    parser.add_argument("--port", action="append", default=[], help="a port of the page, replaced by a free one")
    parser.add_argument("--seconds", type=float, default=300, help="how long one command may take")
    parser.add_argument("--keep", help="the folder to run in, which stays")
    parser.add_argument("--shell", help="the command that starts the shell, of another system whose files are in the folder of --keep")
    parser.add_argument("--only", action="append", default=[], metavar="HEADING", help="run the blocks below this heading alone")
    parser.add_argument("--skip", action="append", default=[], metavar="HEADING", help="leave out the blocks below this heading")
    parser.add_argument("--verbose", action="store_true")
    arguments = parser.parse_args()

    status = 0
    for page in arguments.pages:
        with open(page, encoding="utf-8") as file:
            text = file.read()
        for port in arguments.port:
            text = text.replace(port, free_port())
        folder = os.path.abspath(arguments.keep) if arguments.keep else tempfile.mkdtemp(prefix="robdef-page-")
        home = folder + ".home"
        # Octave complains at its end where its folder is missing.
        # With a system of its own, the folder is that one's.
        for path in ([] if arguments.shell else [folder]) + [home, home + "/.local/share/octave"]:
            shutil.rmtree(path, ignore_errors=True)
            os.makedirs(path)
        # Build servers of .NET would outlive the page.
        environment = dict(os.environ, HOME=home, LC_ALL="C.UTF-8", ROBOTRACONTEUR_USER_RUN_DIR=home + "/run",
                           ROBOTRACONTEUR_USER_CONFIG_DIR=home + "/config", MSBUILDDISABLENODEREUSE="1",
                           UseSharedCompilation="false", DOTNET_CLI_USE_MSBUILD_SERVER="0",
                           DOTNET_CLI_TELEMETRY_OPTOUT="1", DOTNET_NOLOGO="1")
        if arguments.build:
            build = os.path.abspath(arguments.build)
            environment["ROBDEF_BUILD"] = build
        environment.update(entry.split("=", 1) for entry in arguments.set)
        try:
            count, left_out = run_page(text, folder, environment, arguments)
            for what in left_out:
                print(f"{page}: left out: {what}")
            if left_out and environment.get("CI") == "true":
                raise Failure(0, "CI=true leaves nothing out")
            if count == 0:
                raise Failure(1, "no block was run")
            print(f"{page}: {count} blocks hold")
        except Failure as failure:
            print(f"{page}:{failure.line}: {failure}", file=sys.stderr)
            status = 1
        finally:
            if not arguments.keep:
                shutil.rmtree(folder, ignore_errors=True)
            shutil.rmtree(home, ignore_errors=True)
    return status


if __name__ == "__main__":
    sys.exit(main())
