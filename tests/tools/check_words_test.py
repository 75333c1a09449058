# SPDX-License-Identifier: BSD-3-Clause
"""tools/check_words finds and replaces words of the table, in a project of its own."""
import os
import re
import shutil
import subprocess
import sys
import tempfile
import time
import unittest

ROOT = os.path.dirname(os.path.dirname(os.path.dirname(os.path.abspath(__file__))))
HEAD = "kind\thouse word\tfield word\tscope\tnote\n"


class CheckWords(unittest.TestCase):
    def setUp(self):
        self.folder = tempfile.mkdtemp()
        self.addCleanup(shutil.rmtree, self.folder)
        os.makedirs(os.path.join(self.folder, "tools"))
        self.tool = shutil.copy(os.path.join(ROOT, "tools", "check_words"), os.path.join(self.folder, "tools"))
        subprocess.run(["git", "init", "-q", self.folder], check=True)

    def write(self, name, text):
        path = os.path.join(self.folder, name)
        os.makedirs(os.path.dirname(path), exist_ok=True)
        with open(path, "w", encoding="utf-8") as file:
            file.write(text)

    def read(self, name):
        with open(os.path.join(self.folder, name), encoding="utf-8") as file:
            return file.read()

    def table(self, *rows):
        self.write("docs/develop/words.tsv", HEAD + "".join("\t".join(row) + "\n" for row in rows))

    def run_check(self, *words):
        return subprocess.run([sys.executable, self.tool, *words], cwd=self.folder, capture_output=True, text=True)

    def test_a_finding_has_its_place_and_the_word_to_write(self):
        self.table(("phrase", r"\bfor ever\b", "forever", "docs", ""), ("identifier", "most_bits", "max_bits", "all", ""))
        self.write("a.cpp", "int most_bits;\n// It waits for ever.\n")
        done = self.run_check()
        self.assertEqual(done.returncode, 1, done.stderr)
        self.assertEqual(done.stdout.splitlines(),
                         ["a.cpp:1:5: 'most_bits': write 'max_bits'", "a.cpp:2:13: 'for ever': write 'forever'",
                          "checked 2 files, 2 to replace"])

    def test_fix_leaves_nothing_to_find(self):
        self.table(("phrase", r"\bfor ever\b", "forever", "docs", ""), ("identifier", "most_bits", "max_bits", "all", ""))
        self.write("a.cpp", "int most_bits;\n// For ever, and for every one: almost_bits.\n")
        self.assertEqual(self.run_check("--fix").returncode, 0)
        self.assertEqual(self.read("a.cpp"), "int max_bits;\n// Forever, and for every one: almost_bits.\n")
        self.assertEqual(self.run_check().returncode, 0)

    def test_a_name_of_scope_code_stays_in_comments_and_strings(self):
        self.table(("identifier", "told", "reported", "code", ""))
        self.write("a.cpp", 'bool told = is("told");  // told once\n')
        self.run_check("--fix")
        self.assertEqual(self.read("a.cpp"), 'bool reported = is("told");  // told once\n')

    def test_a_row_with_a_glob_holds_in_its_files_only_and_the_first_row_wins(self):
        self.table(("identifier", "told", "warned", "code@sim/*", ""), ("identifier", "told", "reported", "code", ""))
        self.write("sim/a.cpp", "told();\n")
        self.write("tools/a.cpp", "told();\n")
        self.run_check("--fix")
        self.assertEqual((self.read("sim/a.cpp"), self.read("tools/a.cpp")), ("warned();\n", "reported();\n"))

    def test_a_channel_is_found_with_escaped_points_too(self):
        self.table(("channel", "sim.mail", "sim.inputs", "all", ""))
        self.write("a.md", "`sim.mail`, `sim\\.mail`, `sim.mailbox`\n")
        self.run_check("--fix")
        self.assertEqual(self.read("a.md"), "`sim.inputs`, `sim\\.inputs`, `sim.mailbox`\n")

    def test_a_file_is_renamed_with_its_test_and_what_includes_it(self):
        self.table(("file", "mail_gate", "message_gate", "all", ""))
        self.write("sim/mail_gate.hpp", "\n")
        self.write("tests/sim/mail_gate_test.cpp", '#include "sim/mail_gate.hpp"\n')
        self.assertEqual(self.run_check("--fix").returncode, 0)
        self.assertEqual(self.read("tests/sim/message_gate_test.cpp"), '#include "sim/message_gate.hpp"\n')
        self.assertFalse(os.path.exists(os.path.join(self.folder, "sim/mail_gate.hpp")))

    def test_a_phrase_is_found_across_the_lines_of_a_comment(self):
        self.table(("phrase", r"\bthe begin\b", "the start", "docs", ""))
        self.write("a.hpp", "/// Called at the\n/// begin of a step.\nint the(int begin);\n")
        self.assertIn("a.hpp:1:15: 'the /// begin'", self.run_check().stdout)

    def test_a_phrase_without_replacement_is_left_and_counted(self):
        self.table(("phrase", r"\bnobody\b", "", "docs", "name what is absent"))
        self.write("a.md", "It waits for nobody.\n")
        done = self.run_check("--fix")
        self.assertEqual(done.returncode, 1)
        self.assertIn("a.md:1:14: 'nobody': name what is absent\n", done.stdout)
        self.assertEqual(self.read("a.md"), "It waits for nobody.\n")

    def test_a_line_of_a_page_that_becomes_too_long_flows_into_the_next(self):
        self.table(("phrase", r"\bway\b", "distance", "docs", ""))
        self.write("a.md", "way " * 30 + "\nand more.\n")
        self.run_check("--fix")
        lines = self.read("a.md").splitlines()
        self.assertTrue(all(len(line) <= 120 for line in lines))
        self.assertEqual(len(lines), 3)
        self.assertTrue(lines[2].endswith("and more."))

    def test_a_name_within_a_replaced_phrase_is_replaced_too(self):
        self.table(("phrase", r"\bwanted (lean|speed)\b", r"desired \1", "docs", ""), ("metric", "lean", "tilt", "all", ""))
        self.write("a.md", "The wanted lean.\n")
        self.run_check("--fix")
        self.assertEqual(self.read("a.md"), "The desired tilt.\n")

    def test_a_bad_row_is_named(self):
        self.table(("identifier", "a", "b", "everywhere", ""))
        done = self.run_check()
        self.assertEqual(done.returncode, 1)
        self.assertIn("words.tsv:2: unknown scope 'everywhere'", done.stderr)

    @unittest.skipUnless(shutil.which("hunspell"), "needs hunspell")
    def test_spelling_knows_english_and_the_words_of_the_project(self):
        self.table()
        self.write("docs/develop/dictionary.txt", "multibeam\n")
        self.write("a.hpp", "/// A multibeam sonar whose `sehll` is in mm_per_s, and a speling mistake.\nint sehll;\n")
        done = self.run_check("--spelling")
        self.assertEqual(done.returncode, 1)
        self.assertEqual([line.split(":")[0:3] for line in done.stdout.splitlines()[:-1]], [["a.hpp", "1", "59"]])


class ProjectTable(unittest.TestCase):
    def rows(self):
        with open(os.path.join(ROOT, "docs/develop/words.tsv"), encoding="utf-8") as file:
            return [line.rstrip("\n").split("\t") for line in file][1:]

    def test_every_row_has_five_columns_and_an_own_meaning(self):
        seen = set()
        for row in self.rows():
            self.assertEqual(len(row), 5, row)
            if row[1] == row[2]:  # allowed in some files
                self.assertIn("@", row[3], row)
            self.assertNotIn((row[0], row[1], row[3]), seen)
            seen.add((row[0], row[1], row[3]))

    def test_the_whole_tree_is_read_in_seconds(self):
        begin = time.process_time() + sum(os.times()[2:4])
        subprocess.run([os.path.join(ROOT, "tools", "check_words")], capture_output=True)
        self.assertLess(time.process_time() + sum(os.times()[2:4]) - begin, 20)  # CPU time: the machine may be busy


if __name__ == "__main__":
    unittest.main()
