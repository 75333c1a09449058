#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""A file has a subject, not a function: files of at most 30 lines are few (CONTRIBUTING.md).

The share of sources that are so small may fall, and must not rise.

    tests/tools/small_files_test.py          fails above the share that is recorded here
    tests/tools/small_files_test.py --list   prints the small sources
"""
import pathlib
import sys
import tempfile
import unittest

ROOT = pathlib.Path(__file__).resolve().parent.parent.parent
FOLDERS = ("sim", "devices", "messages", "bridges", "experiment", "autonomy", "viewer", "motion", "verification",
           "python", "tools", "examples")
SUFFIXES = {".cpp", ".hpp", ".h", ".inc", ".py", ".js", ".mjs", ".css", ".html"}
FOREIGN = {"vendor", "generated", "node_modules", "__pycache__"}
MAX_LINES = 30
RECORDED_PERCENT = 8  # of the sources; to be lowered with their share


def sources_in(root):
    """The sources of the product below a folder, as paths relative to it."""
    return sorted(path.relative_to(root) for folder in FOLDERS for path in (root / folder).rglob("*")
                  if path.suffix in SUFFIXES and not FOREIGN.intersection(path.parts) and path.is_file())


def small_in(root):
    return [source for source in sources_in(root) if (root / source).read_bytes().count(b"\n") <= MAX_LINES]


def percent_of(root):
    return 100 * len(small_in(root)) / len(sources_in(root))


def verdict(root, recorded_percent):
    """What is wrong; empty: nothing."""
    percent = percent_of(root)
    if percent <= recorded_percent:
        return ""
    return (f"files of at most {MAX_LINES} lines rose from {recorded_percent} % to {percent:.1f} %: merge one into the "
            "file of its subject or of its only user\n(all: tests/tools/small_files_test.py --list)")


class SmallFiles(unittest.TestCase):
    def test_their_share_does_not_rise(self):
        self.assertEqual(verdict(ROOT, RECORDED_PERCENT), "")

    def test_the_record_is_that_of_the_tree(self):
        self.assertGreater(percent_of(ROOT), RECORDED_PERCENT - 2,
                           "lower RECORDED_PERCENT, so that it cannot rise again")

    def test_lines_are_counted_and_what_is_made_by_others_is_not(self):
        with tempfile.TemporaryDirectory() as folder:
            root = pathlib.Path(folder)
            for name, lines in (("sim/base/a.hpp", 30), ("sim/base/b.hpp", 31), ("viewer/page/vendor/c.js", 1)):
                (root / name).parent.mkdir(parents=True, exist_ok=True)
                (root / name).write_text("\n" * lines)
            self.assertEqual(small_in(root), [pathlib.Path("sim/base/a.hpp")])
            self.assertEqual(verdict(root, 50), "")
            self.assertIn("files of at most 30 lines rose from 49 % to 50.0 %", verdict(root, 49))


if __name__ == "__main__":
    if sys.argv[1:] == ["--list"]:
        print("\n".join(str(source) for source in small_in(ROOT)))
    else:
        unittest.main()
