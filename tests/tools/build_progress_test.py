# SPDX-License-Identifier: BSD-3-Clause
"""tools/build_progress and tools/setup do what their texts say, on a build tree and their own list."""
import os
import shutil
import signal
import subprocess
import sys
import tempfile
import unittest

ROOT = os.path.dirname(os.path.dirname(os.path.dirname(os.path.abspath(__file__))))

# One edge waits for a file that never comes, so that an interrupt meets a build that is under way.
NINJA = """rule step
  command = touch $out
  description = Building CXX object $out
rule broken
  command = echo x.cpp:1:1: error: oops && exit 3
  description = Building CXX object $out
rule endless
  command = touch started && tail -f /dev/null
%s
build bad: broken
build forever: endless
build all: phony %s
default all
"""


class BuildProgress(unittest.TestCase):
    def setUp(self):
        self.folder = tempfile.mkdtemp()
        self.addCleanup(shutil.rmtree, self.folder)
        outputs = [f"o{i}" for i in range(20)]
        with open(os.path.join(self.folder, "build.ninja"), "w", encoding="utf-8") as file:
            file.write(NINJA % ("\n".join(f"build {name}: step" for name in outputs), " ".join(outputs)))
        with open(os.path.join(self.folder, "CMakeCache.txt"), "w", encoding="utf-8") as file:
            file.write(f"CMAKE_GENERATOR:INTERNAL=Ninja\nCMAKE_MAKE_PROGRAM:FILEPATH={shutil.which('ninja')}\n"
                       "CMAKE_PROJECT_NAME:STATIC=p\n")

    def command(self, *targets):
        return [sys.executable, os.path.join(ROOT, "tools", "build_progress"), self.folder, *targets]

    def test_a_log_has_a_line_for_each_tenth(self):
        done = subprocess.run(self.command(), capture_output=True, text=True)
        self.assertEqual(done.returncode, 0, done.stdout + done.stderr)
        self.assertEqual([line[:7] for line in done.stdout.splitlines()], [f"[{i:2}/20]" for i in range(2, 21, 2)])

    def test_errors_are_printed_whole_and_the_exit_code_is_that_of_the_build(self):
        done = subprocess.run(self.command("bad"), capture_output=True, text=True)
        self.assertNotEqual(done.returncode, 0)
        self.assertIn("x.cpp:1:1: error: oops", done.stdout)

    def test_an_interrupt_ends_the_build(self):
        build = subprocess.Popen(self.command("forever"), stdout=subprocess.PIPE, text=True, start_new_session=True)
        while not os.path.exists(os.path.join(self.folder, "started")) and build.poll() is None:
            os.sched_yield()
        os.killpg(build.pid, signal.SIGINT)
        output, _ = build.communicate(timeout=60)
        self.assertNotEqual(build.returncode, 0)
        self.assertIn("interrupted", output)


class Setup(unittest.TestCase):
    def setUp(self):
        self.folder = tempfile.mkdtemp()
        self.addCleanup(shutil.rmtree, self.folder)
        os.mkdir(os.path.join(self.folder, "tools"))
        self.tool = shutil.copy(os.path.join(ROOT, "tools", "setup"), os.path.join(self.folder, "tools"))
        with open(os.path.join(self.folder, "tools", "apt-packages.txt"), "w", encoding="utf-8") as file:
            file.write("# A list.\n\n# [run]\n# build\nno-such-a\n# [test]\n# tests\nno-such-b\n# [ci]\n"
                       "# fuzzing (needs clang)\nno-such-c\nno-such-d\n# lint\nno-such-e\n")

    def setup_says(self, *words):
        return subprocess.run([self.tool, *words], capture_output=True, text=True).stdout

    def test_each_section_includes_those_before_it(self):
        self.assertEqual(self.setup_says("--for", "run", "--list").split(), ["no-such-a"])
        self.assertEqual(self.setup_says("--list").split(), ["no-such-a", "no-such-b"])
        self.assertEqual(self.setup_says("--for", "ci", "--list").split(), [f"no-such-{c}" for c in "abcde"])

    @unittest.skipUnless(shutil.which("dpkg-query"), "not a Debian system")
    def test_what_is_left_out_is_named_in_one_line(self):
        self.assertEqual(self.setup_says("--for", "test", "--left-out"),
                         "left out: fuzzing, lint (tools/setup --for ci)\n")


if __name__ == "__main__":
    unittest.main()
