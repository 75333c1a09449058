# SPDX-License-Identifier: BSD-3-Clause
"""tools/build_progress does what its text says, on a build tree."""
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
  command = echo $$$$ >started.new && mv started.new started && exec tail -f /dev/null
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

    def test_a_signal_ends_the_build_and_its_steps(self):
        # As a terminal does, to all programs, and as kill does, to one.
        for send, number, code in ((os.killpg, signal.SIGINT, 130), (os.kill, signal.SIGINT, 130),
                                   (os.kill, signal.SIGTERM, 143), (os.kill, signal.SIGHUP, 129)):
            build = subprocess.Popen(self.command("forever"), stdout=subprocess.PIPE, stderr=subprocess.STDOUT,
                                     text=True, start_new_session=True)
            started = os.path.join(self.folder, "started")
            while not os.path.exists(started) and build.poll() is None:
                os.sched_yield()
            send(build.pid, number)
            output, _ = build.communicate(timeout=60)
            self.assertEqual((build.returncode, output),
                             (code, "tools/build: build stopped; run the same command again to continue\n"))
            with open(started, encoding="utf-8") as file:
                self.assertFalse(os.path.exists(f"/proc/{file.read().strip()}"))
            os.remove(started)

    def test_a_folder_that_is_not_configured_is_named(self):
        os.remove(os.path.join(self.folder, "build.ninja"))
        done = subprocess.run(self.command(), capture_output=True, text=True)
        self.assertEqual((done.returncode, done.stderr),
                         (1, f"tools/build: {self.folder} is not configured: call tools/build\n"))


if __name__ == "__main__":
    unittest.main()
