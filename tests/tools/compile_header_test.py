# SPDX-License-Identifier: BSD-3-Clause
"""cmake/compile_header: a precompiled header out of the compiler cache fits the files that it was asked for."""
import os
import pathlib
import shutil
import subprocess
import tempfile
import unittest

ROOT = pathlib.Path(__file__).resolve().parents[2]


@unittest.skipUnless(shutil.which("ccache") and shutil.which("g++"), "needs ccache and g++")
class CompileHeader(unittest.TestCase):

    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)
        self.variables = {
            **os.environ, "CCACHE_DIR": str(self.folder / "cache"), "CCACHE_SLOPPINESS": "pch_defines,time_macros",
            "CCACHE_NOHASHDIR": "1"
        }
        self.variables.pop("CCACHE_DISABLE", None)

    def build(self, checkout, comment):
        """Builds in a folder what needs a header with a comment; returns the compiler's errors."""
        folder = self.folder / checkout
        folder.mkdir(exist_ok=True)
        (folder / "part.hpp").write_text(f"#pragma once\n// {comment}\nstruct Part {{}};\n")
        (folder / "all.hpp").write_text("#include <part.hpp>\n")
        (folder / "all.hpp.cxx").write_text("")
        (folder / "main.cpp").write_text(f"#include <part.hpp>\nint main() {{ Part {checkout}; (void){checkout}; }}\n")
        variables = {**self.variables, "CCACHE_BASEDIR": str(folder)}
        flags = ["-I", str(folder), "-include", str(folder / "all.hpp")]
        subprocess.run([
            ROOT / "cmake/compile_header", "ccache", "g++", *flags, "-x", "c++-header", "-MD", "-MT", "all.hpp.gch",
            "-MF", "all.hpp.gch.d", "-o", "all.hpp.gch", "-c", "all.hpp.cxx"
        ], cwd=folder, env=variables, check=True)
        return subprocess.run(["ccache", "g++", *flags, "-o", "main.o", "-c", "main.cpp"], cwd=folder, env=variables,
                              capture_output=True, text=True).stderr

    def hits(self):
        printed = subprocess.run(["ccache", "--print-stats"], env=self.variables, capture_output=True, text=True,
                                 check=True).stdout
        figures = dict(line.split("\t") for line in printed.splitlines())
        return int(figures["direct_cache_hit"]) + int(figures["preprocessed_cache_hit"])

    def test_serves_another_checkout_of_the_same_files(self):
        self.assertEqual(self.build("first", "a comment"), "")
        self.assertEqual(self.hits(), 0)
        self.assertEqual(self.build("second", "a comment"), "")
        self.assertEqual(self.hits(), 1)  # the header; main.cpp is another

    def test_is_made_anew_after_a_change_of_a_comment(self):
        self.assertEqual(self.build("first", "a comment"), "")
        self.assertEqual(self.build("second", "another comment"), "")
        self.assertEqual(self.hits(), 0)


if __name__ == "__main__":
    unittest.main()
