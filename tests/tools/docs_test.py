# SPDX-License-Identifier: BSD-3-Clause
"""The site of the documentation has no faults, and tools/docs finds those that it should find."""
import importlib.machinery
import importlib.util
import os
import pathlib
import shutil
import subprocess
import sys
import tempfile
import unittest

ROOT = pathlib.Path(__file__).resolve().parents[2]
sys.dont_write_bytecode = True


def load_docs():
    loader = importlib.machinery.SourceFileLoader("docs", str(ROOT / "tools/docs"))
    module = importlib.util.module_from_spec(importlib.util.spec_from_loader("docs", loader))
    loader.exec_module(module)
    return module


DOCS = load_docs()


class Docs(unittest.TestCase):
    def setUp(self):
        self.folder = pathlib.Path(tempfile.mkdtemp(prefix="shoal_docs_test_"))
        self.addCleanup(shutil.rmtree, self.folder)

    def write(self, name, text):
        (self.folder / name).parent.mkdir(parents=True, exist_ok=True)
        (self.folder / name).write_text(text)

    def test_headings_are_named_as_on_github(self):
        counts = {}
        self.assertEqual(DOCS.slug_of("Speed of sound, `m/s` - [here](x.md)", counts), "speed-of-sound-ms---here")
        self.assertEqual(DOCS.slug_of("Speed of sound, m/s - here", counts), "speed-of-sound-ms---here-1")

    def test_a_source_file_that_a_page_links_to_is_in_the_site_as_text(self):
        stage = DOCS.Stage(self.folder)
        page = stage.add(ROOT / "docs/develop/architecture.md").read_text()
        self.assertIn("](../checkout/sim/director/script.cpp.txt)", page)
        self.assertEqual((self.folder / "checkout/sim/director/script.cpp.txt").read_text(),
                         (ROOT / "sim/director/script.cpp").read_text())

    def test_links_that_lead_nowhere_are_named(self):
        self.write("a/index.html", '<a href="../b/#gone">x</a> <a href="../c/">x</a> <a href="../b/#here">x</a>')
        self.write("b/index.html", '<h2 id="here">x</h2> <script src="https://x.org/y.js"></script>')
        self.assertEqual(DOCS.broken_links(self.folder),
                         ["a/index.html: ../b/#gone: no heading '#gone'",
                          "a/index.html: ../c/: no such file in the site",
                          "b/index.html: loads https://x.org/y.js from the network"])

    def test_every_page_is_in_an_index(self):
        self.assertEqual(DOCS.navigation()[1], [])

    def test_the_glossary_is_in_alphabetical_order(self):
        rows = (ROOT / "docs/reference/glossary.md").read_text().splitlines()[6:]
        terms = [row.split("|")[1].strip(" `").lower() for row in rows]
        self.assertEqual(terms, sorted(terms))
        self.assertGreater(len(terms), 80)

    @unittest.skipUnless(shutil.which("mkdocs") and shutil.which("doxygen"), "mkdocs and doxygen are not installed")
    def test_the_site_has_no_faults(self):
        done = subprocess.run([str(ROOT / "tools/docs"), "--check"], capture_output=True, text=True,
                              env={**os.environ, "TMPDIR": str(self.folder)})
        self.assertEqual((done.stdout, done.stderr, done.returncode), ("the site has no faults\n", "", 0))


if __name__ == "__main__":
    unittest.main()
