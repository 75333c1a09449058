# SPDX-License-Identifier: BSD-3-Clause
"""tools/launcher.in, which becomes bin/shoal of the tarball, says in one sentence what the system lacks."""
import os
import shutil
import subprocess
import tempfile
import unittest

ROOT = os.path.dirname(os.path.dirname(os.path.dirname(os.path.abspath(__file__))))
LOADER = """#!/bin/sh
cat "${0%/*}/libraries"
"""
PROGRAM = """#!/bin/sh
for word in "$@"; do echo "[$word]"; done
exit 7
"""
FOUND = "\tlibstdc++.so.6 => /lib/libstdc++.so.6 (0x00007f)\n\tlibc.so.6 => /lib/libc.so.6 (0x00007f)\n"


class Launcher(unittest.TestCase):
    def setUp(self):
        self.folder = tempfile.mkdtemp()
        self.addCleanup(shutil.rmtree, self.folder)
        self.launch_with(loader=os.path.join(self.folder, "loader"))
        self.write("loader", LOADER)
        self.write("shoal.bin", PROGRAM)
        self.write("libraries", FOUND)

    def write(self, name, text):
        path = os.path.join(self.folder, name)
        with open(path, "w", encoding="utf-8") as file:
            file.write(text)
        os.chmod(path, 0o755)

    def launch_with(self, loader):
        with open(os.path.join(ROOT, "tools/launcher.in"), encoding="utf-8") as file:
            text = file.read()
        for key, value in {"LOADER": loader, "MACHINE": "z80", "NEEDS": "glibc 2.36, GLIBCXX 3.4.30 or newer"}.items():
            text = text.replace(f"@{key}@", value)
        self.write("shoal", text)

    def run_shoal(self, *words, program="./shoal", code=126):
        done = subprocess.run([program, *words], cwd=self.folder, text=True, capture_output=True, timeout=60)
        self.assertEqual(done.returncode, code, done.stdout + done.stderr)
        return done.stdout + done.stderr

    def test_it_passes_words_and_exit_code(self):
        self.assertEqual(self.run_shoal("a b", "*", code=7), "[a b]\n[*]\n")

    def test_it_works_by_a_link_in_another_folder(self):
        os.mkdir(os.path.join(self.folder, "links"))
        os.symlink("../shoal", os.path.join(self.folder, "links/shoal"))
        self.assertEqual(self.run_shoal("a", program="links/shoal", code=7), "[a]\n")

    def test_another_processor_or_c_library(self):
        self.launch_with(loader="/nowhere/ld.so")
        self.assertEqual(self.run_shoal(), "shoal: this is the Shoal of z80 with glibc, but here is "
                         f"{os.uname().machine}, or another C library: take the tarball of your processor, or the "
                         "image if your system has no glibc\n")

    def test_an_old_c_library(self):
        self.write("libraries", "shoal.bin: /lib/libc.so.6: version `GLIBC_2.36' not found (required by it)\n" + FOUND)
        self.assertEqual(self.run_shoal(), "shoal: this system is too old, Shoal needs glibc 2.36, GLIBCXX 3.4.30 or "
                         "newer: use the image of Shoal in a container\n")

    def test_a_missing_library_is_named(self):
        self.write("libraries", "shoal.bin: error while loading shared libraries: libstdc++.so.6: cannot open shared "
                   "object file: No such file or directory\n")
        self.assertEqual(self.run_shoal(), "shoal: libstdc++.so.6 is missing: install it, as root: apt-get install "
                         "libstdc++6, or dnf install libstdc++\n")

    def test_a_folder_of_which_a_part_is_missing(self):
        os.remove(os.path.join(self.folder, "shoal.bin"))
        self.assertIn("unpack the tarball again", self.run_shoal())


if __name__ == "__main__":
    unittest.main()
