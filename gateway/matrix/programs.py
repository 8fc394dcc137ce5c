# SPDX-License-Identifier: Apache-2.0
"""Programs that the fleet matrix starts, and how it talks to them."""
import os
import select
import subprocess
import time


class Failure(Exception):
    """Why the run has failed."""


def run(*words, **options):
    """Runs a command to its end; its output is an error's text."""
    done = subprocess.run(words, stdin=subprocess.DEVNULL, capture_output=True, text=True, **options)
    if done.returncode != 0:
        raise Failure(f"{' '.join(words)}: {done.stdout}{done.stderr}")
    return done.stdout


def wait_until(condition, seconds, what):
    """Asks ten times a second; what came of it."""
    end = time.monotonic() + seconds
    while True:
        result = condition()
        if result:
            return result
        if time.monotonic() > end:
            raise Failure(f"not within {seconds:.0f} s: {what}")
        time.sleep(0.1)


class Program:
    """One that runs in a folder until the matrix ends, with its messages in a file there."""

    def __init__(self, folder, name, words, place=None):
        self.name = name
        self.words = words
        self.folder = folder
        self.log = os.path.join(folder, name + ".log")
        self.place = place
        self.process = None
        self.start()

    def start(self):
        words = (["ip", "netns", "exec", self.place] if self.place else []) + self.words
        with open(self.log, "ab") as log:
            # A pipe that stays open: some end with their standard input.
            self.process = subprocess.Popen(words, cwd=self.folder, stdin=subprocess.PIPE,
                                            stdout=subprocess.PIPE if self.talks() else log, stderr=log)

    def talks(self):
        return False

    def kill(self):
        self.process.kill()
        self.process.wait()

    def text(self):
        with open(self.log, encoding="utf-8", errors="replace") as file:
            return file.read()

    def check(self):
        if self.process.poll() is not None:
            raise Failure(f"{self.name} has ended with {self.process.returncode}: {self.text()[-2000:]}")

    def await_text(self, text, seconds, count=1):
        def is_there():
            self.check()
            return self.text().count(text) >= count
        wait_until(is_there, seconds, f"`{text}` {count} times in the log of {self.name}")

    def cpu(self):
        """Seconds of CPU that it has used."""
        with open(f"/proc/{self.process.pid}/stat", encoding="ascii") as file:
            fields = file.read().rsplit(")", 1)[1].split()
        return (int(fields[11]) + int(fields[12])) / os.sysconf("SC_CLK_TCK")


class Talker(Program):
    """One that answers each line with a line (gateway/matrix/commands.hpp)."""

    rest = b""

    def talks(self):
        return True

    def read(self, seconds):
        end = time.monotonic() + seconds
        while b"\n" not in self.rest:
            ready, _, _ = select.select([self.process.stdout], [], [], max(0, end - time.monotonic()))
            part = os.read(self.process.stdout.fileno(), 65536) if ready else b""
            if not part:
                raise Failure(f"{self.name} does not answer: {self.text()[-2000:]}")
            self.rest += part
        line, self.rest = self.rest.split(b"\n", 1)
        return line.decode().strip()

    def await_ready(self, seconds):
        words = self.read(seconds).split()
        if words[:1] != ["ready"]:
            raise Failure(f"{self.name} says: {' '.join(words)}")
        return words[1:]

    def ask(self, command):
        self.process.stdin.write((command + "\n").encode())
        self.process.stdin.flush()
        return self.read(60)

    def numbers(self, command):
        return [int(word) for word in self.ask(command).split()]
