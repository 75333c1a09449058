# SPDX-License-Identifier: BSD-3-Clause
"""The tables of docs/develop/performance can be read as docs/develop/performance.md says."""
import csv
import datetime
import pathlib
import re
import unittest

FOLDER = pathlib.Path(__file__).resolve().parent.parent.parent / "docs/develop/performance"
PAGE = FOLDER.with_suffix(".md").read_text()
COLUMNS = "date machine load version scene size threads quantity unit value low high aim remark".split()


def rows():
    for path in sorted(FOLDER.glob("*.csv")):
        with open(path, newline="", encoding="utf-8") as file:
            reader = csv.DictReader(file, strict=True)
            for row in reader:
                yield f"{path.name}:{reader.line_num}", row


class PerformanceTables(unittest.TestCase):

    def test_the_page_links_every_table_and_describes_every_column(self):
        self.assertEqual(sorted(re.findall(r"\(performance/(\w+\.csv)\)", PAGE)),
                         sorted(path.name for path in FOLDER.iterdir()))
        described = PAGE[PAGE.index("| column | meaning |"):]
        self.assertEqual(re.findall(r"`(\w+)`", " ".join(re.findall(r"^\| (`.+?`) \|", described, re.M))), COLUMNS)

    def test_a_row_has_a_date_a_machine_of_the_page_and_a_number_or_a_range(self):
        machines = set(re.findall(r"^\| ([A-Z]) \| ", PAGE, re.M)) | {"any", ""}
        for where, row in rows():
            with self.subTest(where):
                self.assertEqual(list(row), COLUMNS)
                datetime.date.fromisoformat(row["date"])
                self.assertIn(row["machine"], machines)
                self.assertTrue(row["scene"] and row["quantity"])
                names = "value", "low", "high", "size", "threads", "aim"
                numbers = {name: float(row[name]) for name in names if row[name]}
                self.assertTrue("value" in numbers or {"low", "high"} <= numbers.keys())
                self.assertLessEqual(numbers.get("low", 0), numbers.get("high", 0))


if __name__ == "__main__":
    unittest.main()
