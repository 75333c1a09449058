#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Tests are where one looks for them: `X.cpp` is tested in `tests/X_test.cpp` (CONTRIBUTING.md).

The share of sources with such a test may rise, and must not fall.

    tests/tools/mirrored_tests_test.py          fails below the share that is recorded here
    tests/tools/mirrored_tests_test.py --list   prints the sources without such a test
"""
import collections
import pathlib
import sys
import unittest

ROOT = pathlib.Path(__file__).resolve().parent.parent.parent
FOLDERS = ("sim", "devices", "messages", "bridges", "experiment", "autonomy", "viewer", "motion", "verification",
           "python", "tools")
RECORDED_PERCENT = 79  # of the sources; to be raised with their share


def sources_in(root):
    """The sources of the product below a folder, as paths relative to it."""
    return sorted(path.relative_to(root) for folder in FOLDERS for path in (root / folder).rglob("*.cpp"))


def test_of(source):
    return pathlib.Path("tests") / source.with_name(source.stem + "_test.cpp")


def without_test(root):
    return [source for source in sources_in(root) if not (root / test_of(source)).is_file()]


def verdict(root, recorded_percent):
    """What is wrong; empty: nothing."""
    sources, missing = sources_in(root), without_test(root)
    percent = 100 * (len(sources) - len(missing)) / len(sources)
    if percent >= recorded_percent:
        return ""
    by_folder = collections.Counter(str(source.parent) for source in missing)
    rows = "".join(f"\n  {count:3} of {folder}" for folder, count in by_folder.most_common(10))
    return (f"mirrored tests fell from {recorded_percent} % to {percent:.1f} %: add {test_of(missing[-1])} or that of "
            f"another source; without a test are{rows}\n(all: tests/tools/mirrored_tests_test.py --list)")


class MirroredTests(unittest.TestCase):
    def test_their_share_does_not_fall(self):
        self.assertEqual(verdict(ROOT, RECORDED_PERCENT), "")

    def test_the_record_is_that_of_the_tree(self):
        sources, missing = sources_in(ROOT), without_test(ROOT)
        percent = 100 * (len(sources) - len(missing)) / len(sources)
        self.assertLess(percent, RECORDED_PERCENT + 5, "raise RECORDED_PERCENT, so that it cannot fall again")

    def test_a_source_without_a_test_is_named_with_its_folder(self):
        import tempfile
        with tempfile.TemporaryDirectory() as folder:
            root = pathlib.Path(folder)
            for name in ("sim/base/a.cpp", "sim/base/b.cpp", "tests/sim/base/a_test.cpp"):
                (root / name).parent.mkdir(parents=True, exist_ok=True)
                (root / name).touch()
            self.assertEqual(verdict(root, 50), "")
            self.assertIn("mirrored tests fell from 51 % to 50.0 %: add tests/sim/base/b_test.cpp", verdict(root, 51))
            self.assertIn("1 of sim/base", verdict(root, 51))


if __name__ == "__main__":
    if sys.argv[1:] == ["--list"]:
        print("\n".join(str(source) for source in without_test(ROOT)))
    else:
        unittest.main()
