# SPDX-License-Identifier: BSD-3-Clause
"""tools/format finds and mends layout and license lines, in its own project."""
import os
import shutil
import subprocess
import tempfile
import unittest

ROOT = os.path.dirname(os.path.dirname(os.path.dirname(os.path.abspath(__file__))))
LINE = "SPDX-License-Identifier: BSD-3-Clause\n"


def has_clang_format_14():
    return any(shutil.which(name) and " 14." in subprocess.run([name, "--version"], capture_output=True, text=True).stdout
               for name in ("clang-format-14", "clang-format"))


class Format(unittest.TestCase):
    def setUp(self):
        self.folder = tempfile.mkdtemp()
        self.addCleanup(shutil.rmtree, self.folder)
        os.mkdir(os.path.join(self.folder, "tools"))
        self.tool = shutil.copy(os.path.join(ROOT, "tools", "format"), os.path.join(self.folder, "tools"))
        shutil.copy(os.path.join(ROOT, ".clang-format"), self.folder)
        subprocess.run(["git", "init", "-q", self.folder], check=True)

    def write(self, name, text):
        with open(os.path.join(self.folder, name), "w", encoding="utf-8") as file:
            file.write(text)

    def read(self, name):
        with open(os.path.join(self.folder, name), encoding="utf-8") as file:
            return file.read()

    def run_format(self, *words, path=os.environ["PATH"]):
        return subprocess.run([self.tool, *words], cwd=self.folder, capture_output=True, text=True,
                              env={**os.environ, "PATH": path})

    @unittest.skipUnless(has_clang_format_14(), "clang-format 14 does not exist")
    def test_check_names_the_files_and_changes_none(self):
        self.write("a.cpp", "// " + LINE + "int  a;\n")
        self.write("b.py", "print()\n")
        self.write("world.yaml", "shoal: 1\n")
        done = self.run_format("--check")
        self.assertEqual(done.returncode, 1)
        self.assertEqual([line.split(":")[0] for line in done.stdout.splitlines()], ["b.py", "a.cpp"])
        self.assertEqual(self.read("b.py"), "print()\n")

    @unittest.skipUnless(has_clang_format_14(), "clang-format 14 does not exist")
    def test_format_mends_what_check_names(self):
        self.write("a.cpp", "int  a;\n")
        self.write("b.sh", "#!/bin/sh\ntrue\n")
        self.write("c.lcm", "package shoal;\n")
        self.assertEqual(self.run_format().returncode, 0)
        self.assertEqual(self.read("a.cpp"), "// " + LINE + "int a;\n")
        self.assertEqual(self.read("b.sh"), "#!/bin/sh\n# " + LINE + "true\n")
        self.assertEqual(self.read("c.lcm"), "// " + LINE + "package shoal;\n")
        self.assertEqual(self.run_format("--check").returncode, 0)

    def test_another_version_of_clang_format_is_refused(self):
        programs = os.path.join(self.folder, "programs")
        os.mkdir(programs)
        for name in ("python3", "git", "env"):
            os.symlink(shutil.which(name), os.path.join(programs, name))
        with open(os.path.join(programs, "clang-format"), "w", encoding="utf-8") as file:
            file.write("#!/bin/sh\necho 'clang-format version 19.1.0'\n")
        os.chmod(file.name, 0o755)
        self.write("a.cpp", "int a;\n")
        done = self.run_format("--check", path=programs)
        self.assertEqual(done.returncode, 2)
        self.assertIn("clang-format 14 is needed (clang-format is version 19)", done.stderr)


if __name__ == "__main__":
    unittest.main()
