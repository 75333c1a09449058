# SPDX-License-Identifier: BSD-3-Clause
"""Checks the links of the project's pages, and that tools/check_links finds what is broken."""
import os
import shutil
import subprocess
import sys
import tempfile
import unittest

ROOT = os.path.dirname(os.path.dirname(os.path.dirname(os.path.abspath(__file__))))
TOOL = os.path.join(ROOT, "tools", "check_links")


def check(*files):
    return subprocess.run([sys.executable, TOOL, *files], capture_output=True, text=True)


class CheckLinks(unittest.TestCase):
    def faults_of(self, text):
        with tempfile.TemporaryDirectory() as folder:
            with open(os.path.join(folder, "other.md"), "w", encoding="utf-8") as file:
                file.write("# Speed of `sound` (m/s)\n\n## Twice\n\n## Twice\n")
            page = os.path.join(folder, "page.md")
            with open(page, "w", encoding="utf-8") as file:
                file.write(text)
            done = check(page)
            return done.returncode, [line.split(": ", 1)[1] for line in done.stdout.splitlines()[:-1]]

    def test_the_pages_of_the_project_have_no_broken_link(self):
        done = check()
        self.assertEqual(done.returncode, 0, done.stdout)

    def test_mentions_of_pages_that_are_not_there_are_found(self):
        with tempfile.TemporaryDirectory() as folder:
            os.makedirs(os.path.join(folder, "tools"))
            shutil.copy(TOOL, os.path.join(folder, "tools"))
            with open(os.path.join(folder, "water.cpp"), "w", encoding="utf-8") as file:
                file.write("// see docs/gone.md and https://x.org/docs/other.md\n")
            subprocess.run(["git", "init", "-q"], cwd=folder, check=True)
            subprocess.run(["git", "add", "-A"], cwd=folder, check=True)
            done = subprocess.run([sys.executable, os.path.join(folder, "tools/check_links")], capture_output=True,
                                  text=True)
            self.assertIn("water.cpp:1:docs/gone.md: no such file", done.stdout.splitlines())
            self.assertEqual(done.stdout.count("other.md"), 0)

    def test_links_to_files_and_headings_are_found(self):
        text = "# Here\n[a](other.md) [b](other.md#speed-of-sound-ms) [c](other.md#twice-1) [d](#here) [e](https://x.org)\n"
        self.assertEqual(self.faults_of(text), (0, []))

    def test_a_missing_file_and_a_missing_heading_are_named(self):
        code, faults = self.faults_of("[a](gone.md)\n[b](other.md#twice-2)\n![c](no.png)\n")
        self.assertEqual(code, 1)
        self.assertEqual([fault.split(": ")[0] for fault in faults], ["gone.md", "other.md#twice-2", "no.png"])
        self.assertIn("no heading '#twice-2'", faults[1])

    def test_code_is_not_searched_for_links(self):
        self.assertEqual(self.faults_of("```\n[a](gone.md)\n```\n`[b](gone.md)`\n"), (0, []))

    def test_paths_in_code_exist(self):
        code, faults = self.faults_of("`sim/world/world.hpp` `tools/docs` `sim/gone.hpp`, and `docs/gone/x.md`.\n")
        self.assertEqual((code, faults), (1, ["sim/gone.hpp: no such file", "docs/gone/x.md: no such file"]))

    def test_of_a_file_that_the_reader_writes_the_folder_exists(self):
        code, faults = self.faults_of("`sim/world/mine.hpp`:\n\n`sim/gone/mine.hpp`:\n")
        self.assertEqual((code, faults), (1, ["sim/gone/mine.hpp: no such folder"]))

    def test_names_to_be_filled_in_and_paths_of_others_are_no_paths_of_the_project(self):
        text = "`tests/fuzz/NAME_fuzz.cpp` `vehicles/joint_names/VEHICLE.yaml` `results/gone.csv` `moos/ivp/x.cpp`\n"
        self.assertEqual(self.faults_of(text), (0, []))


if __name__ == "__main__":
    unittest.main()
