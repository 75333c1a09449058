# SPDX-License-Identifier: BSD-3-Clause
"""Takes the steps of docs/guides/campaigns.md with its study, two seeds and two seconds of each run.

    python3 campaigns_page_test.py SOURCE BINARY_DIRECTORY
"""
import os
import re
import shlex
import sqlite3
import subprocess
import sys
import tempfile
import unittest

from page_steps import Commands, File, blocks_of, add_step, last_paragraph

SOURCE, BINARY_DIR = os.path.abspath(sys.argv[1]), os.path.abspath(sys.argv[2])
with open(os.path.join(SOURCE, "docs", "guides", "campaigns.md"), encoding="utf-8") as page:
    TEXT = page.read()


def first_steps():
    """The study and the commands that execute it: the first two blocks."""
    steps = []
    for line, before, language, block in list(blocks_of(TEXT))[:2]:
        add_step(steps, line, last_paragraph(before), language, block)
    return steps


class CampaignsPage(unittest.TestCase):
    def test_its_study_runs_and_its_query_answers(self):
        file, commands = first_steps()
        self.assertIsInstance(file, File)
        self.assertIsInstance(commands, Commands)
        with tempfile.TemporaryDirectory(prefix="campaigns-page-") as folder:
            with open(os.path.join(folder, file.name), "w", encoding="utf-8") as study:
                study.write(file.text)
            environment = dict(os.environ, PATH=os.pathsep.join([os.path.join(BINARY_DIR, "bin"), os.environ["PATH"]]))
            for command in commands.commands:
                words = shlex.split(command, comments=True)
                shorter = ["--seeds", "1-2", "--duration", "2"] if "plan" in words else []
                done = subprocess.run([*words, *shorter], cwd=folder, env=environment, capture_output=True, text=True,
                                      timeout=580, check=False)
                self.assertEqual(done.returncode, 0, f"{command}:\n{done.stdout}{done.stderr}")
            query = re.search(r'sqlite3 (\S+) "(SELECT [^"]*)"', TEXT)
            with sqlite3.connect(os.path.join(folder, query[1])) as database:
                rows = database.execute(query[2]).fetchall()
                cases = database.execute("SELECT DISTINCT case_name FROM runs").fetchall()
        # Five levels of the loss, as numbers.
        self.assertEqual([value for value, _ in rows], [0, 0.25, 0.5, 0.75, 1])
        self.assertTrue(all(isinstance(mean, float) for _, mean in rows), rows)
        self.assertEqual(cases, [("world",)])


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1])
