# SPDX-License-Identifier: Apache-2.0
"""A service of an example, and the command line as its client."""
import json
import re
import subprocess


class Service:
    """A program that prints `ready: URL` and serves until it is ended. Use it in a `with` statement.

    `bin_folder` is the folder of the programs, `words` are the program and its arguments.
    """

    def __init__(self, bin_folder, *words):
        self._bin = bin_folder
        self._words = words

    def __enter__(self):
        self._program = subprocess.Popen([self._bin / self._words[0], *self._words[1:]], text=True,
                                         stdout=subprocess.PIPE)
        for line in self._program.stdout:
            if match := re.match(r"ready: (\S+)", line):
                self.url = match[1]
                return self
        self._program.wait()
        raise RuntimeError(f"{self._words[0]} ended before it was ready")

    def __exit__(self, *_):
        self._program.terminate()
        self._program.wait(timeout=10)
        self._program.stdout.close()

    def _robdef(self, command, *words):
        run = subprocess.run([self._bin / "robdef", command, *words], text=True, check=False, capture_output=True)
        if run.returncode != 0:
            raise RuntimeError(f"robdef {command} {' '.join(words)[:200]}: {run.stderr}")
        return [json.loads(line) for line in run.stdout.splitlines()]

    def call(self, member, *arguments):
        """The result of a function."""
        lines = self._robdef("call", self.url, member, *map(json.dumps, arguments))
        return lines[0] if lines else None

    def get(self, member):
        """The value of a property, or what a wire has now."""
        return self._robdef("get", self.url, member)[0]

    def set(self, member, value):
        """Sets a property, pokes a value into a wire, or writes into a memory."""
        self._robdef("set", self.url, member, json.dumps(value, separators=(",", ":")))

    def watch(self, member, seconds):
        """All values that a member sends in so many seconds."""
        return [line["value"] for line in self._robdef("watch", self.url, member, "--for", str(seconds))]
