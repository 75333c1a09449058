# SPDX-License-Identifier: BSD-3-Clause
"""docs/develop/flows.md shows rooms and functions as they are.

    flows_test.py ROOMS_FILE
"""
import os
import re
import subprocess
import sys
import unittest

ROOT = os.path.dirname(os.path.dirname(os.path.dirname(os.path.abspath(__file__))))
ROOMS = sys.argv.pop(1)


class Flows(unittest.TestCase):

    def test_the_page_on_flows_names_functions_that_are_in_their_files(self):
        with open(os.path.join(ROOT, "docs", "develop", "flows.md"), encoding="utf-8") as file:
            steps = re.findall(r"^\| `([\w:]+)` \| `([\w/.]+)` \|", file.read(), re.MULTILINE)
        self.assertGreater(len(steps), 40)
        for function, path in steps:
            with open(os.path.join(ROOT, path), encoding="utf-8") as file:
                text = file.read()
            # A header has the class and the function apart.
            names = function.split("::") if path.endswith(".hpp") else [function]
            for name in names:
                self.assertRegex(text, rf"\b{name}\b", f"{function} is not in {path}")

    def test_the_drawing_of_the_rooms_is_that_of_the_build(self):
        done = subprocess.run([os.path.join(ROOT, "tools", "draw_rooms"), ROOMS, "--check"], capture_output=True, text=True)
        self.assertEqual(done.returncode, 0, done.stdout + done.stderr)


if __name__ == "__main__":
    unittest.main()
