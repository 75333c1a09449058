# SPDX-License-Identifier: BSD-3-Clause
"""Checks that the tests which docs/develop/view_features.md names exist."""
import glob
import os
import re
import unittest

ROOT = os.path.dirname(os.path.dirname(os.path.dirname(os.path.abspath(__file__))))
PAGE = os.path.join(ROOT, "docs", "develop", "view_features.md")


def read(*paths):
    text = ""
    for path in paths:
        with open(path, encoding="utf-8") as file:
            text += file.read()
    return text


class ViewFeatures(unittest.TestCase):
    def setUp(self):
        self.rows = [line.split(" | ") for line in read(PAGE).splitlines() if re.match(r"\| \d+ \|", line)]

    def test_rows_are_numbered(self):
        self.assertEqual([int(row[0].strip("| ")) for row in self.rows], list(range(1, 47)))

    def test_each_gtest_exists(self):
        sources = read(*glob.glob(os.path.join(ROOT, "tests", "**", "*.cpp"), recursive=True))
        there = {f"{suite}.{name}" for suite, name in re.findall(r"^TEST(?:_F|_P)?\((\w+), (\w+)\)", sources, re.M)}
        for row in self.rows:
            suite = None
            for named in re.findall(r"`((?:[A-Z]\w*)?\.[A-Z]\w+)`", row[-1]):
                suite = named.split(".")[0] or suite
                self.assertIn(f"{suite}.{named.split('.')[1]}", there, row[0])

    def test_each_test_of_the_page_exists(self):
        checked = 0
        for row in self.rows:
            name = None
            for phrase in row[-1].strip(" |").split("; "):
                found = re.fullmatch(r"(?:(\w+): )?([^`].*?)(?: \(.*|: .*|\. .*)?", phrase)
                name = found and (found[1] or name)
                if name is None or found[2].startswith("the "):
                    continue
                path = os.path.join(ROOT, "tests", "viewer", name + "_test.js")
                sentence = found[2].split(" against ")[0]
                there = "describe('silhouettes'" if name == "silhouette" else f"it('{sentence}"
                self.assertTrue(there in read(path), f"{row[0]}: {path} has no {there}")
                checked += 1
        self.assertGreater(checked, 50)


if __name__ == "__main__":
    unittest.main()
