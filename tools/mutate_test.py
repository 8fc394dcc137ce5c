#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Tests of tools/mutate: which places of a source are changed, and how a test that finds a fault is named."""
import importlib.machinery
import importlib.util
import pathlib
import sys
import tempfile
import unittest

sys.dont_write_bytecode = True
PATH = pathlib.Path(__file__).resolve().parent / "mutate"
LOADER = importlib.machinery.SourceFileLoader("mutate", str(PATH))
mutate = importlib.util.module_from_spec(importlib.util.spec_from_loader("mutate", LOADER))
LOADER.exec_module(mutate)

SOURCE = """
// if (a < b) return 1;
void f(const std::vector<int>& list) {
  const MutexLock lock(mutex_);
  if (list.size() >= 3 && is_open_) say("a == b", 'x');
  if (const auto found = find(list); found != 0) return;
  list_.clear();
  list_.push_back(7);
  a = 1;
  b = 2;
}
"""


def changes(kind):
    return [(m.line, m.before, m.after) for m in mutate.mutants_of("f.cpp", SOURCE) if m.kind == kind]


class Places(unittest.TestCase):
    def test_conditions_are_negated_as_a_whole(self):
        condition = "(list.size() >= 3 && is_open_)"
        self.assertEqual(changes("condition"), [(5, condition, f"(!{condition})")])

    def test_comparisons_are_none_in_comments_texts_and_templates(self):
        self.assertEqual(changes("comparison"), [(5, ">=", ">"), (6, "!=", "==")])

    def test_operators(self):
        self.assertEqual(changes("operator"), [(5, "&&", "||")])

    def test_constants(self):
        self.assertEqual([after for _, _, after in changes("constant")], ["4", "1", "8", "2", "3"])

    def test_locks_and_statements_are_left_out(self):
        self.assertEqual(changes("lock"), [(4, "const MutexLock lock(mutex_);", ";")])
        self.assertEqual([before for _, before, _ in changes("statement")], ["list_.clear();", "list_.push_back(7);"])

    def test_statements_that_may_depend_are_swapped(self):
        self.assertEqual(changes("order"),
                         [(7, "list_.clear();\n  list_.push_back(7);", "list_.push_back(7);\n  list_.clear();")])

    def test_a_mutant_has_one_change(self):
        for mutant in mutate.mutants_of("f.cpp", SOURCE):
            at = SOURCE.find(mutant.before)
            while SOURCE[:at] + mutant.after + SOURCE[at + len(mutant.before):] != mutant.text:
                at = SOURCE.index(mutant.before, at + 1)
            self.assertEqual(mutant.line, SOURCE.count("\n", 0, at) + 1)


class Draw(unittest.TestCase):
    def test_is_the_same_for_a_seed_and_leaves_tests_out(self):
        with tempfile.TemporaryDirectory() as name:
            folder = pathlib.Path(name) / "runtime/cpp/src/codec"
            folder.mkdir(parents=True)
            for file in ["a.cpp", "a_test.cpp", "b.hpp"]:
                (folder / file).write_text(SOURCE)
            first = list(mutate.draw(pathlib.Path(name), ["codec"], 3))
            self.assertEqual(first, list(mutate.draw(pathlib.Path(name), ["codec"], 3)))
            self.assertNotEqual(first, list(mutate.draw(pathlib.Path(name), ["codec"], 4)))
            self.assertEqual({m.file for m in first}, {"runtime/cpp/src/codec/a.cpp", "runtime/cpp/src/codec/b.hpp"})
            # The kinds take turns, whichever there is most of.
            self.assertEqual(len({m.kind for m in first[:7]}), 7)


class Run(unittest.TestCase):
    def program(self, script):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        mutate.WORK = pathlib.Path(folder.name)
        tests = mutate.WORK / "build/tests"
        tests.mkdir(parents=True)
        (tests / "a_test").write_text("#!/bin/sh\n" + script)
        (tests / "a_test").chmod(0o755)

    def test_names_the_test_that_has_failed(self):
        self.program("echo '[  FAILED  ] Reader.EndsEarly (3 ms)'; exit 1\n")
        self.assertEqual(mutate.run("a_test", 20), "a_test: Reader.EndsEarly")

    def test_names_a_crash_and_what_does_not_end(self):
        self.program("kill -SEGV $$\n")
        self.assertEqual(mutate.run("a_test", 20), "a_test: ended with -11")
        self.program("sleep 60 & wait\n")
        self.assertEqual(mutate.run("a_test", 0.3), "a_test: does not end")

    def test_is_silent_when_all_pass(self):
        self.program("exit 0\n")
        self.assertEqual(mutate.run("a_test", 20), "")


if __name__ == "__main__":
    unittest.main()
