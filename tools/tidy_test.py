#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Tests of tools/tidy, in a tree of its own: what it finds in sources and headers, what it leaves out, what it looks at again."""
import json
import os
import pathlib
import shutil
import subprocess
import tempfile
import unittest

TOOLS = pathlib.Path(__file__).resolve().parent
# With a finding in a header, one of the syntax tree, one of the paths through a function, and none of the system's header.
HEADER = "#pragma once\nstruct badly_named {\n  int value = 0;\n};\n"
SYSTEM = "#pragma once\nstruct badly_named_elsewhere {\n  int value = 0;\n};\n"
BESIDE = "#pragma once\ninline constexpr int beside = 1;\n"
SOURCE = """#include "runtime/planted.hpp"
#include <outside.hpp>
#include <string>
#include <utility>

int length_after_move(std::string text) {
  const std::string taken = std::move(text);
  return static_cast<int>(taken.size() + text.size());
}
int read_null(bool is_null) {
  int value = 1;
  const int* place = is_null ? nullptr : &value;
  return *place;
}
"""
CLEAN = """#include "beside.hpp"
#include <outside.hpp>
#include <string>
int length(const std::string& text) { return beside + static_cast<int>(text.size()); }
"""


class Tidy(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        # Of its own, with the plug-in in it from the first test on: marks of other trees are not looked at.
        cls.cache = tempfile.TemporaryDirectory()

    @classmethod
    def tearDownClass(cls):
        cls.cache.cleanup()

    def setUp(self):
        self.folder = tempfile.TemporaryDirectory()
        self.root = pathlib.Path(self.folder.name).resolve() / "tree"
        (self.root / "tools").mkdir(parents=True)
        for name in ("tidy", "tidy_scope.cpp", "together.py"):
            shutil.copy(TOOLS / name, self.root / "tools")
        shutil.copy(TOOLS.parent / ".clang-tidy", self.root)
        for place, text in (("runtime/planted.hpp", HEADER), ("runtime/beside.hpp", BESIDE), ("system/outside.hpp", SYSTEM)):
            (self.root / place).parent.mkdir(parents=True, exist_ok=True)
            (self.root / place).write_text(text, encoding="utf-8")

    def tearDown(self):
        self.folder.cleanup()
        for mark in self.marks():
            mark.unlink()

    def run_tidy(self, *texts):
        build = self.root.parent / "build"
        build.mkdir(exist_ok=True)
        entries = []
        for text, name in zip(texts, ("planted", "second")):
            source = self.root / f"runtime/{name}.cpp"
            source.write_text(text, encoding="utf-8")
            entries.append({
                "directory": str(build), "file": str(source),
                "command": f"/usr/bin/c++ -I{self.root} -isystem {self.root}/system -std=c++20 -o {name}.o -c {source}"})
        (build / "compile_commands.json").write_text(json.dumps(entries), encoding="utf-8")
        return subprocess.run([self.root / "tools/tidy", build], check=False, capture_output=True, text=True,
                              env={**os.environ, "XDG_CACHE_HOME": self.cache.name})

    def marks(self):
        return [file for file in (pathlib.Path(self.cache.name) / "robdef/tidy").iterdir() if not file.suffix]

    def test_findings_in_a_source_and_its_header_are_shown(self):
        run = self.run_tidy(SOURCE)
        self.assertEqual(run.returncode, 1, run.stdout + run.stderr)
        self.assertIn("planted.hpp:2:8: error: invalid case style for struct 'badly_named'", run.stdout)
        self.assertRegex(run.stdout, r"planted\.cpp:8:\d+: error: 'text' used after it was moved \[bugprone-use-after-move")
        self.assertRegex(run.stdout, r"planted\.cpp:13:\d+: error: Dereference of null pointer .*\[clang-analyzer-core\.Null")
        self.assertNotIn("badly_named_elsewhere", run.stdout)
        self.assertEqual(self.marks(), [])

    def test_what_is_clean_leaves_a_mark(self):
        run = self.run_tidy(CLEAN)
        self.assertEqual(run.returncode, 0, run.stdout + run.stderr)
        self.assertEqual(len(self.marks()), 1)

    def test_sources_that_do_not_fit_together_leave_a_mark_for_each_and_for_both(self):
        run = self.run_tidy(CLEAN, CLEAN + "int second() { return 2; }\n")
        self.assertEqual(run.returncode, 0, run.stdout + run.stderr)
        self.assertIn("[1/1]", run.stderr)
        self.assertEqual(len(self.marks()), 3)

    def test_what_clang_cannot_read_is_an_error(self):
        run = self.run_tidy("int length() { return missing; }\n")
        self.assertEqual(run.returncode, 2, run.stdout + run.stderr)
        self.assertIn("use of undeclared identifier 'missing'", run.stdout)


if __name__ == "__main__":
    unittest.main()
