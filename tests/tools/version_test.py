# SPDX-License-Identifier: BSD-3-Clause
"""The version stands in CMakeLists.txt alone; the files that must repeat it say the same."""
import os
import re
import unittest

ROOT = os.path.dirname(os.path.dirname(os.path.dirname(os.path.abspath(__file__))))


def text_of(name):
    with open(os.path.join(ROOT, name), encoding="utf-8") as file:
        return file.read()


class Version(unittest.TestCase):
    def setUp(self):
        self.version = re.search(r"project\(shoal VERSION ([0-9.]+)", text_of("CMakeLists.txt"))[1]

    def test_the_citation_names_the_version_of_the_build(self):
        self.assertEqual(re.search(r"(?m)^version: (.+)$", text_of("CITATION.cff"))[1], self.version)

    def test_the_newest_released_section_of_the_changelog_is_that_version(self):
        released = re.findall(r"(?m)^## (\d[0-9.]*)", text_of("CHANGELOG.md"))
        self.assertEqual(released[0], self.version)


if __name__ == "__main__":
    unittest.main()
