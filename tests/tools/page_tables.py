# SPDX-License-Identifier: BSD-3-Clause
"""Tables of a page of docs/: the files of the folder of the same name hold its figures."""
import csv
import pathlib
import re

DOCS = pathlib.Path(__file__).resolve().parent.parent.parent / "docs"


class PageTables:
    """The page, its tables, and the checks that hold for all of them."""

    def __init__(self, name, columns):
        self.folder = DOCS / name
        self.page = self.folder.with_suffix(".md").read_text(encoding="utf-8")
        self.columns = columns.split()

    def rows(self, name="*.csv"):
        """Yields the place and the cells of each row."""
        for path in sorted(self.folder.glob(name)):
            with open(path, newline="", encoding="utf-8") as file:
                reader = csv.DictReader(file, strict=True)
                for row in reader:
                    yield f"{path.name}:{reader.line_num}", row

    def check_page(self, test):
        """Fails `test` unless the page links every table and describes every column."""
        links = re.findall(rf"\({self.folder.name}/(\w+\.csv)\)", self.page)
        test.assertEqual(sorted(links), sorted(path.name for path in self.folder.iterdir()))
        described = self.page[self.page.index("| column | meaning |"):]
        test.assertEqual(re.findall(r"`(\w+)`", " ".join(re.findall(r"^\| (`.+?`) \|", described, re.M))), self.columns)
