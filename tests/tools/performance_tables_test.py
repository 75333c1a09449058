# SPDX-License-Identifier: BSD-3-Clause
"""The tables of docs/develop/performance can be read as docs/develop/performance.md says."""
import datetime
import re
import unittest

from page_tables import PageTables

TABLES = PageTables("develop/performance",
                    "date machine load version scene size threads quantity unit value low high aim remark")


class PerformanceTables(unittest.TestCase):

    def test_the_page_links_every_table_and_describes_every_column(self):
        TABLES.check_page(self)

    def test_a_row_has_a_date_a_machine_of_the_page_and_a_number_or_a_range(self):
        machines = set(re.findall(r"^\| ([A-Z]) \| ", TABLES.page, re.M)) | {"any", ""}
        for where, row in TABLES.rows():
            with self.subTest(where):
                self.assertEqual(list(row), TABLES.columns)
                datetime.date.fromisoformat(row["date"])
                self.assertIn(row["machine"], machines)
                self.assertTrue(row["scene"] and row["quantity"])
                names = "value", "low", "high", "size", "threads", "aim"
                numbers = {name: float(row[name]) for name in names if row[name]}
                self.assertTrue("value" in numbers or {"low", "high"} <= numbers.keys())
                self.assertLessEqual(numbers.get("low", 0), numbers.get("high", 0))


if __name__ == "__main__":
    unittest.main()
