#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Tests of check_pages.py, run_blocks.py and documented_names.py: what is wrong is found, with its line."""
import os
import shutil
import subprocess
import sys
import tempfile
import unittest

HERE = os.path.dirname(os.path.abspath(__file__))


def run(script, *arguments):
    result = subprocess.run([sys.executable, os.path.join(HERE, script), *arguments], text=True,
                            stdout=subprocess.PIPE, stderr=subprocess.STDOUT, check=False)
    return result.returncode, result.stdout


class Blocks(unittest.TestCase):
    def run_page(self, text, *options):
        with tempfile.TemporaryDirectory() as folder:
            page = os.path.join(folder, "page.md")
            with open(page, "w", encoding="utf-8") as file:
                file.write(text)
            return run("run_blocks.py", "--seconds", "10", *options, page)

    def test_files_commands_and_variables_last(self):
        status, output = self.run_page("`a/b.txt`:\n\n```\none\n```\n\n```console\n$ cd a\n$ X=2\n```\n\n"
                                       "```console\n$ cat b.txt; echo $X\none\n2\n```\n")
        self.assertEqual(status, 0, output)
        self.assertIn("3 blocks hold", output)

    def test_another_output_is_found(self):
        status, output = self.run_page("```console\n$ echo one\ntwo\n```\n")
        self.assertEqual(status, 1)
        self.assertRegex(output, r"page.md:3: `echo one`\n  expected: two\n  there is: one")

    def test_more_output_is_found(self):
        self.assertEqual(self.run_page("```console\n$ echo one; echo two\none\n```\n")[0], 1)

    def test_dots_stand_for_anything(self):
        status, output = self.run_page("```console\n$ seq 9\n1\n...\n8\n9\n$ echo at 12 ms\nat ... ms\n```\n")
        self.assertEqual(status, 0, output)

    def test_a_command_that_fails_is_found(self):
        self.assertRegex(self.run_page("```console\n$ false\n```\n")[1], "page.md:2: `false` ended with status 1")

    def test_a_command_that_should_fail_and_does_not_is_found(self):
        self.assertEqual(self.run_page("<!-- fails -->\n\n```console\n$ true\n```\n")[0], 1)
        status, output = self.run_page("<!-- fails -->\n\n```console\n$ false\n```\n")
        self.assertEqual(status, 0, output)

    def test_no_block_goes_unseen(self):
        self.assertRegex(self.run_page("```cpp\nint x;\n```\n")[1], "page.md:1: the block is neither")
        self.assertIn("no block was run", self.run_page("<!-- not run: why -->\n\n```cpp\nint x;\n```\n")[1])

    def test_a_missing_program_leaves_out_the_section(self):
        status, output = self.run_page("# One\n\n```console\n$ true\n```\n\n# Two\n\n<!-- needs: no-such-program -->\n\n"
                                       "```console\n$ false\n```\n\n```console\n$ false\n```\n", "--set", "CI=false")
        self.assertEqual(status, 0, output)
        self.assertIn("left out: line 11: there is no no-such-program", output)

    def test_commands_of_root_have_their_own_prompt(self):
        status, output = self.run_page("```console\n# echo one\none\n# echo '$ x' \\\n    '# y'\n$ x # y\n```\n")
        self.assertEqual(status, 0, output)

    def test_sections_are_run_alone_or_left_out(self):
        text = "# One\n\n```console\n$ true\n```\n\n## Two\n\n```console\n$ false\n```\n"
        self.assertEqual(self.run_page(text, "--skip", "Two")[0], 0)
        self.assertEqual(self.run_page(text, "--only", "One")[0], 0)
        self.assertEqual(self.run_page(text, "--only", "Two")[0], 1)
        self.assertIn("no block was run", self.run_page(text, "--only", "Three")[1])

    def test_checks_that_readers_do_not_see_are_run(self):
        text = "```console\n$ x=1\n```\n\nIt is one.\n\n<!-- check: [ $x = 1 ] -->\n\n<!-- check: [ $x = 2 ] -->\n"
        status, output = self.run_page(text)
        self.assertEqual(status, 1)
        self.assertRegex(output, r"page.md:9: `\[ \$x = 2 \]` ended with status 1")
        self.assertEqual(self.run_page(text.replace("$x = 2", "$x -lt 2"))[0], 0)

    def test_another_system_has_its_own_shell_and_files(self):
        with tempfile.TemporaryDirectory() as root:
            text = "`/etc/one`:\n\n```\n1\n```\n\n```console\n# cat etc/one\n1\n```\n"
            status, output = self.run_page(text, "--keep", root, "--shell", f"bash -c 'cd {root} && exec bash'")
            self.assertEqual(status, 0, output)
            self.assertTrue(os.path.exists(root + "/etc/one"))

    def test_a_program_runs_on_and_is_ended(self):
        status, output = self.run_page("```console\n$ sh -c 'echo ready; exec sleep 60' &\nready\n$ kill %1\n```\n")
        self.assertEqual(status, 0, output)


class Pages(unittest.TestCase):
    def check(self, text, name="docs/howto/page.md"):
        with tempfile.TemporaryDirectory() as root:
            for page, content in ((name, text), ("docs/other.md", "# A heading\n")):
                os.makedirs(os.path.join(root, os.path.dirname(page)), exist_ok=True)
                with open(os.path.join(root, page), "w", encoding="utf-8") as file:
                    file.write(content)
            return [line for line in run("check_pages.py", root)[1].split("\n") if line.startswith(name)]

    def test_links_and_anchors(self):
        self.assertEqual(self.check("[a](../other.md#a-heading) `[no](link.md)`\n"), [])
        self.assertIn("page.md:3: there is no gone.md", self.check("# T\n\n[a](gone.md)\n")[0])
        self.assertIn("has no heading for #gone", self.check("[a](../other.md#gone)\n")[0])

    def test_words_and_names(self):
        self.assertIn("write fixed", self.check("The fault is mended.\n")[0])
        self.assertEqual(self.check("The fault is mended.\n", "docs/project/page.md"), [])
        self.assertIn("name of a test", self.check("See `Calls.RequestsAreHandledInOrder`.\n")[0])
        self.assertIn("not in the tree", self.check("As it says (07, section 3).\n")[0])

    def test_long_sentences(self):
        self.assertIn("19.0 words a sentence", self.check("Word " + "word " * 18 + "\n")[0])
        self.assertEqual(self.check("Word " + "word " * 17 + "\n"), [])


@unittest.skipUnless(shutil.which("doxygen"), "doxygen is not installed")
class Names(unittest.TestCase):
    def check(self, text, name="one.hpp"):
        with tempfile.TemporaryDirectory() as folder:
            with open(os.path.join(folder, name), "w", encoding="utf-8") as file:
                file.write(text)
            status, output = run("documented_names.py", "--input", folder)
        return status, output.replace(folder + "/", "")

    def test_documented_names_hold(self):
        status, output = self.check("""/// A.
namespace a {
/// Calls.
class Caller {
 public:
  ~Caller();
  Caller(const Caller&) = delete;
  /// Does it.
  virtual void call() = 0;
 private:
  void hidden();
};
/// One.
class One : public Caller {
 public:
  void call() override;
};
/// How: `fast` or `slow`.
enum class Way { fast, slow };
/// A place.
struct Place {
  int x;  ///< metres
};
}  // namespace a
""")
        self.assertEqual(status, 0, output)
        self.assertRegex(output, "^10 public names, 0 without documentation")

    def test_each_kind_of_name_is_found(self):
        for line, kind, name in (("void call();", "function", "a::call"),
                                 ("class Caller {};", "class", "a::Caller"),
                                 ("inline int count = 1;", "variable", "a::count"),
                                 ("using Text = const char*;", "typedef", "a::Text"),
                                 ("/// Says.\nstruct Said {\n  int word;\n};", "variable", "a::Said::word"),
                                 ("/// How: `fast`.\nenum class Way { fast, slow };", "enum value", "a::slow")):
            status, output = self.check(f"/// A.\nnamespace a {{\n{line}\n}}\n")
            self.assertEqual(status, 1, output)
            self.assertRegex(output, rf"one.hpp:[3-5]: {kind} {name} has no documentation comment")
            self.assertIn(", 1 without documentation", output)

    def test_c_headers_need_a_comment_of_their_own(self):
        declared = "/** Calls. */\nvoid call(void);\n"
        self.assertIn("one.h:1: file one.h has no", self.check(declared, "one.h")[1])
        status, output = self.check("/** @file\n * Calls. */\n" + declared, "one.h")
        self.assertEqual(status, 0, output)

    def test_a_comment_that_doxygen_does_not_understand_is_found(self):
        status, output = self.check("/// A.\nnamespace a {\n/// Calls @nobody there.\nvoid call();\n}\n")
        self.assertEqual(status, 1, output)
        self.assertIn("one.hpp:3: warning: Found unknown command", output)


if __name__ == "__main__":
    unittest.main()
