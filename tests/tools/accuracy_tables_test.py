# SPDX-License-Identifier: BSD-3-Clause
"""The tables of docs/guides/cooperative_accuracy can be read as docs/guides/cooperative_accuracy.md says, which has the
same figures."""
import re
import unittest

from page_tables import PageTables

TABLES = PageTables("guides/cooperative_accuracy",
                    "world case seeds quantity unit statistic value low high std min max remark")


class AccuracyTables(unittest.TestCase):

    def test_the_page_links_every_table_and_describes_every_column(self):
        TABLES.check_page(self)

    def test_a_row_has_a_world_a_quantity_and_a_number_or_a_range(self):
        for where, row in TABLES.rows():
            with self.subTest(where):
                self.assertEqual(list(row), TABLES.columns)
                self.assertTrue(row["world"] and row["quantity"])
                names = "value", "low", "high", "std", "min", "max"
                numbers = {name: float(row[name]) for name in names if row[name]}
                self.assertTrue("value" in numbers or {"min", "max"} <= numbers.keys())
                value = numbers.get("value", numbers.get("min"))
                for low, high in (("low", "high"), ("min", "max")):
                    self.assertEqual(low in numbers, high in numbers)
                    self.assertTrue(numbers.get(low, value) <= value <= numbers.get(high, value))

    def test_the_page_has_the_figures_of_the_unseen_seeds(self):
        of_page = {cells[0]: cells[1:] for cells in
                   (line.strip("| \n").split(" | ") for line in TABLES.page.splitlines() if line.startswith("| "))}
        for where, row in TABLES.rows("unseen_seeds.csv"):
            name = re.sub(" rms$", ", rms", row["quantity"])
            if row["statistic"] == "mean" and name in of_page:
                self.assertEqual(of_page.pop(name), [row["value"], f"{row['low']} to {row['high']}", row["min"],
                                                     row["max"]], where)
        self.assertFalse({"with ranges, rms", "dead reckoning, rms"} & of_page.keys())


if __name__ == "__main__":
    unittest.main()
