# SPDX-License-Identifier: BSD-3-Clause
"""Takes the pages docs/develop/add_*.md as an author of extensions does: in an empty folder, with an installed shoal.

    python3 develop_pages_test.py SOURCE BINARY_DIRECTORY

All files of a page are written and all its commands run, and what it shows of their output is compared (page_steps.py),
except in sections about the source tree.  The seconds of each page are printed.
"""
import glob
import os
import re
import shutil
import subprocess
import sys
import tempfile
import unittest

from checkout_copy import in_own_network
from page_run import PageRun, installed_terminal

SOURCE, BINARY_DIR = os.path.abspath(sys.argv[1]), os.path.abspath(sys.argv[2])
PAGES = ["add_a_command", "add_a_device", "add_a_message_type", "add_a_metric", "add_an_action", "add_an_estimator"]
OF_THE_TREE = re.compile(r"^## [^\n]*(in the tree|an actuator)[^\n]*\n.*?(?=^## |\Z)", re.S | re.M | re.I)


class DevelopPages(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.home = tempfile.mkdtemp(prefix="develop-pages-test-", dir=BINARY_DIR)
        cls.addClassCleanup(shutil.rmtree, cls.home)
        subprocess.run(["cmake", "--install", BINARY_DIR, "--prefix", cls.home + "/shoal"], check=True,
                       capture_output=True)

    def test_every_project_builds_and_does_what_its_page_shows(self):
        for name in PAGES:
            with self.subTest(page=name):
                terminal = installed_terminal(self.home, name)
                self.addCleanup(terminal.close)
                with open(os.path.join(SOURCE, "docs", "develop", name + ".md"), encoding="utf-8") as file:
                    self.assertEqual(PageRun(terminal).run(OF_THE_TREE.sub("", file.read()), name), [])

    def test_every_page_is_taken(self):
        pages = glob.glob(os.path.join(SOURCE, "docs", "develop", "add_*.md"))
        self.assertEqual(sorted(os.path.basename(page)[:-3] for page in pages), PAGES)


if __name__ == "__main__":
    in_own_network()
    unittest.main(argv=sys.argv[:1])
