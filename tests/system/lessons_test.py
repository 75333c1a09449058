# SPDX-License-Identifier: BSD-3-Clause
"""Takes a lesson of docs/start as a newcomer does: in an empty folder, with an installed shoal in PATH.

    python3 lessons_test.py SOURCE BINARY_DIRECTORY LESSON

LESSON is the name of the page without .md.  All its files are written and all its commands run, and what it shows of
their output is compared (page_steps.py); the seconds are printed.  A lesson that "continues with the files of" another
one, by a link, starts with the files that the other page shows.  LCM is in its own network namespace, where there
can be one, else on its own port.
"""
import os
import re
import shutil
import subprocess
import sys
import tempfile
import unittest

from checkout_copy import in_own_network
from page_run import PageRun, installed_terminal
from page_steps import Change, File, commands_outside_blocks, steps_of

SOURCE, BINARY_DIR, LESSON = os.path.abspath(sys.argv[1]), os.path.abspath(sys.argv[2]), sys.argv[3]
START = os.path.join(SOURCE, "docs", "start")


def text_of(page):
    with open(os.path.join(START, page), encoding="utf-8") as file:
        return file.read()


def files_before(text):
    """File and Change steps of the lesson whose files this one continues with."""
    earlier = re.search(r"continues\s+with\s+the\s+files\s+of\s+\[[^\]]*\]\(([\w.]+)\)", text)
    return [step for step in steps_of(text_of(earlier[1])) if isinstance(step, (File, Change))] if earlier else []


class Lesson(unittest.TestCase):
    def setUp(self):
        home = tempfile.mkdtemp(prefix="lesson-test-", dir=BINARY_DIR)
        self.addCleanup(shutil.rmtree, home)
        subprocess.run(["cmake", "--install", BINARY_DIR, "--prefix", home + "/shoal"], check=True, capture_output=True)
        self.terminal = installed_terminal(home, "work")
        self.addCleanup(self.terminal.close)

    def test_every_command_does_what_the_page_shows(self):
        page = PageRun(self.terminal)
        text = text_of(LESSON + ".md")
        for step in files_before(text):
            page.take(step, goes_on=False)
        for failure in page.run(text, LESSON):
            self.fail(failure)

    def test_commands_stand_in_blocks_where_they_are_run(self):
        self.assertEqual(commands_outside_blocks(text_of(LESSON + ".md"), ("shoal ", "tools/", "cmake ")), [])


if __name__ == "__main__":
    in_own_network()
    unittest.main(argv=sys.argv[:1], failfast=True)
