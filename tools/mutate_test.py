#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Tests of tools/mutate: which places of a source are changed, and how a test that finds a fault is named."""
import importlib.machinery
import importlib.util
import os
import pathlib
import shutil
import subprocess
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

    def test_statements_with_nothing_but_a_function_in_common_are_not_swapped(self):
        self.assertTrue(mutate.may_depend("list_.clear();", "list_.push_back(7);"))
        self.assertTrue(mutate.may_depend("a = b;", "f(a);"))
        self.assertFalse(mutate.may_depend("names_.clear();", "values_.clear();"))
        self.assertFalse(mutate.may_depend("std::memcpy(&last, end, 8);", "std::memcpy(to, &first, 8);"))

    def test_a_mutant_has_one_change(self):
        for mutant in mutate.mutants_of("f.cpp", SOURCE):
            at = SOURCE.find(mutant.before)
            while SOURCE[:at] + mutant.after + SOURCE[at + len(mutant.before):] != mutant.text:
                at = SOURCE.index(mutant.before, at + 1)
            self.assertEqual(mutant.line, SOURCE.count("\n", 0, at) + 1)


def switch(source, kind, place=None):
    """The line of a source in which a mutant of a kind, the one at a text if that is named, is behind a switch."""
    for mutant in mutate.mutants_of("f.cpp", source):
        if mutant.kind == kind and (place is None or mutant.begin == source.index(place)):
            text, lines = mutate.switched(source, {7: mutant})
            return "\n".join(line.strip() for line in text.split("\n")[2:-2]) if lines else None
    return "there is no such mutant"


def in_function(line):
    return mutate.FIRST_LINE + f"void f() {{\n  {line}\n}}\n"


class Switches(unittest.TestCase):
    def test_are_of_one_condition_statement_or_lock(self):
        self.assertEqual(switch(in_function("if (is_open_) close();"), "condition"),
                         "if (static_cast<bool>(is_open_) != rr_mutant(7)) close();")
        self.assertEqual(switch(in_function("list_.clear();"), "statement"), "{ if (!rr_mutant(7)) list_.clear(); }")
        self.assertEqual(switch(in_function("const MutexLock lock(a.mutex_);"), "lock"),
                         "const std::unique_ptr<const MutexLock> lock(rr_mutant(7) ? nullptr : new const MutexLock(a.mutex_));")
        self.assertIsNone(switch(in_function("const std::lock_guard lock(mutex_);"), "lock"))

    def test_choose_between_two_values(self):
        self.assertEqual(switch(in_function("if (a < b) c();"), "comparison"), "if ( (rr_mutant(7) ? (a <= b) : (a < b))) c();")
        self.assertEqual(switch(in_function("const int n = size() + 4;"), "constant"),
                         "const int n = (rr_mutant(7) ? ( size() + 5) : ( size() + 4));")
        self.assertEqual(switch(in_function("return a && b;"), "operator"), "return (rr_mutant(7) ? ( a || b) : ( a && b));")
        self.assertEqual(switch(in_function("for (int i = 0; i < n; i += 2) {}"), "comparison"),
                         "for (int i = 0; (rr_mutant(7) ? ( i <= n) : ( i < n)); i += 2) {}")
        self.assertEqual(switch(in_function("for (int i = 0; i < n; i += 2) {}"), "operator"),
                         "for (int i = 0; i < n; (rr_mutant(7) ? static_cast<void>( i -= 2) : static_cast<void>( i += 2))) {}")

    def test_choose_between_two_statements(self):
        self.assertEqual(switch(in_function("total_ += n;"), "operator"), "{ if (rr_mutant(7)) { total_ -= n; } else { total_ += n; } }")
        self.assertEqual(switch(in_function("else f(1);"), "constant"), None)
        self.assertEqual(switch(in_function("if (a) b(1);"), "constant"), "if (a) { if (rr_mutant(7)) { b(2); } else { b(1); } }")

    def test_are_of_the_innermost_statement(self):
        source = in_function("post([this] { count_ = 1; });")
        self.assertEqual(switch(source, "constant"),
                         "post([this] { { if (rr_mutant(7)) { count_ = 2; } else { count_ = 1; } } });")

    def test_are_not_of_what_the_compiler_needs(self):
        for line in ["constexpr int n = 4;", "static_assert(n == 4);", "case 4: break;", "std::array<int, 4> a;",
                     "throw Error(code, 4);", "int list[] = {4};"]:
            self.assertIsNone(switch(in_function(line), "constant"), line)

    def test_leave_lines_where_they_are(self):
        source = in_function("return a ==  // of b: \"==\"\n      b;")
        mutant = next(m for m in mutate.mutants_of("f.cpp", source) if m.kind == "comparison")
        text, lines = mutate.switched(source, {7: mutant})
        self.assertEqual(text.count("\n"), source.count("\n"))
        self.assertEqual(lines, {7: (3, 4)})
        self.assertTrue(text.startswith("#include"))
        self.assertIn("( a !=          b)", text)

    def test_of_two_at_one_place_one_is_left(self):
        mutants = [m for m in mutate.mutants_of("f.cpp", in_function("return a == b;")) if m.kind == "comparison"]
        _, lines = mutate.switched(in_function("return a == b;"), {1: mutants[0], 2: mutants[0]})
        self.assertEqual(list(lines), [1])

    def test_compile_and_choose_when_the_program_runs(self):
        source = (mutate.FIRST_LINE + "#include <cstdio>\n"
                  "struct MutexLock { explicit MutexLock(int) { std::puts(\"locked\"); } };\n"
                  "int sum(int n) {\n  int total = 0;\n  for (int i = 0; i < n; ++i) {\n    total += i;\n  }\n  return total;\n}\n"
                  "int main() {\n  const MutexLock lock(1);\n  const bool is_six = sum(4) == 6;\n  std::puts(is_six ? \"six\" : \"other\");\n"
                  "  return 0;\n}\n")
        wanted = {"lock": "six\n", "comparison": "locked\nother\n", "operator": "locked\nother\n"}
        chosen = {}
        for mutant in mutate.mutants_of("f.cpp", source):
            if mutant.kind in wanted and mutant.kind not in chosen.values():
                chosen[len(chosen) + 1] = mutant.kind
        by_kind = {m.kind: m for m in reversed(list(mutate.mutants_of("f.cpp", source)))}
        mutants = {number: by_kind[kind] for number, kind in chosen.items()}
        with tempfile.TemporaryDirectory() as name:
            mutate.WORK = pathlib.Path(name)
            (mutate.WORK / "mutants.hpp").write_text(mutate.SWITCHES)
            text, lines = mutate.switched(source, mutants)
            self.assertEqual(sorted(lines), sorted(mutants))
            (mutate.WORK / "f.cpp").write_text(text)
            subprocess.run(["c++", "-std=c++20", "-w", "-o", f"{name}/f", f"{name}/f.cpp"], check=True)
            for number in [0, *mutants]:
                environment = {**os.environ, "RR_MUTANT": str(number), "RR_MUTANT_REACHED": f"{name}/{number}"}
                said = subprocess.run([f"{name}/f"], env=environment, capture_output=True, text=True, check=True).stdout
                self.assertEqual(said, wanted[chosen[number]] if number else "locked\nsix\n")
                self.assertEqual((mutate.WORK / str(number)).exists(), number != 0)

    def test_errors_blame_the_mutants_of_their_lines(self):
        lines = {1: (3, 4), 2: (9, 9)}
        said = ("../../runtime/cpp/src/codec/a.cpp:4:7: error: no match\n../src/codec/b.cpp:9:7: error: no match\n"
                "a.cpp:9:1: warning: unused\n")
        self.assertEqual(mutate.blamed(said, "runtime/cpp/src/codec/a.cpp", lines), {1})
        said = "/x/runtime/cpp/src/codec/a.cpp:9:1:   required from here\n"
        self.assertEqual(mutate.blamed(said, "runtime/cpp/src/codec/a.cpp", lines), {2})


@unittest.skipIf(shutil.which("clang++-19") is None, "clang 19 is not installed")
class LockRules(unittest.TestCase):
    def test_find_a_lock_that_is_left_out(self):
        source = ('#include "rr/mutex.hpp"\nusing rr::MutexLock;\n'
                  "class Counter {\n public:\n  void add() {\n    const MutexLock lock(mutex_);\n    STATEMENT\n  }\n\n"
                  " private:\n  rr::Mutex mutex_;\n  int count_ RR_GUARDED_BY(mutex_) = 0;\n  int other_ = 0;\n};\n")
        for statement, is_found in [("++count_;", True), ("++other_;", False)]:
            mutants = mutate.mutants_of("f.cpp", source.replace("STATEMENT", statement))
            [mutant] = [m for m in mutants if m.kind == "lock"]
            self.assertEqual(mutate.breaks_lock_rules(mutant), is_found, statement)


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


class Again(unittest.TestCase):
    def test_a_survivor_is_found_where_it_is_now(self):
        with tempfile.TemporaryDirectory() as name:
            tree = pathlib.Path(name)
            one, _, two = [m for m in mutate.mutants_of("f.cpp", SOURCE) if m.kind == "constant"][2:5]
            before = mutate.result_of(two, "", True)
            self.assertIsNone(mutate.mutant_again(tree, before))
            (tree / "f.cpp").write_text("\n\n\n" + SOURCE)
            self.assertEqual(mutate.mutant_again(tree, before).line, two.line + 3)
            (tree / "f.cpp").write_text(SOURCE.replace("  b = 2;\n", ""))
            self.assertIsNone(mutate.mutant_again(tree, before))
            self.assertEqual(mutate.mutant_again(tree, mutate.result_of(one, "", True)).line, one.line)


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

    def test_tells_for_each_mutant_what_finds_it(self):
        self.program('[ "$RR_MUTANT" = 2 ] || exit 0\necho "[  FAILED  ] Reader.EndsEarly"; exit 1\n')
        mutant = next(mutate.mutants_of("runtime/cpp/src/codec/f.cpp", SOURCE))
        mutate.PROGRAMS["a_test"] = ["codec"]
        self.addCleanup(mutate.PROGRAMS.pop, "a_test")
        found = mutate.find_all({1: mutant, 2: mutant, 3: mutant}, {"a_test": 1.0}, 2)
        self.assertEqual(dict(found), {1: "", 2: "a_test: Reader.EndsEarly", 3: ""})

    def test_is_over_a_channel(self):
        self.program('[ "$ROBDEF_TEST_CHANNEL" = ws ] && exit 1 || exit 0\n')
        self.assertEqual([mutate.run(name, 20) for name in ["a_test", "a_test over ws"]], ["", "a_test over ws: ended with 1"])

    def test_is_silent_when_all_pass(self):
        self.program("exit 0\n")
        self.assertEqual(mutate.run("a_test", 20), "")


if __name__ == "__main__":
    unittest.main()
