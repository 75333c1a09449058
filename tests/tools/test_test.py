# SPDX-License-Identifier: BSD-3-Clause
"""tools/test --again runs what failed again, alone, and says what passed then."""
import os
import shutil
import subprocess
import tempfile
import unittest

ROOT = os.path.dirname(os.path.dirname(os.path.dirname(os.path.abspath(__file__))))

# The first run fails two tests; one of them, alone, fails as often as FAILURES says.  With PARTS there are parts of
# programs, of which `ended` came to its end, and `cut` did not: it crashed in its first test.
CTEST = r"""#!/bin/sh
echo "$*" >> calls
case "$*" in
  *--show-only*parts*|*parts*--show-only*)
     [ -z "$PARTS" ] || printf '  Test #1: ended.part_0\n  Test #2: ended.part_1\n  Test #3: cut.part_0\n' ;;
  *--show-only*) printf '  Test #4: Cut.Crashes\n  Test #5: Cut/0.IsLost  # TypeParam = int\n' ;;
  *-C*parts*)
     mkdir -p Testing/Temporary
     printf '1:ended.part_0\n3:cut.part_0\n9:Steady.Fails\n' > Testing/Temporary/LastTestsFailed.log
     printf '[ RUN      ] Ended.Passes\n[       OK ] Ended.Passes (1 ms)\n' > ended.0.log
     printf '[ RUN      ] Shaky/Test.OfTwo/0\n[  FAILED  ] Shaky/Test.OfTwo/0, where GetParam() = 3 (1 ms)\n' >> ended.0.log
     printf '[==========] 2 tests from 2 test suites ran. (2 ms total)\n[  FAILED  ] Shaky/Test.OfTwo/0\n' >> ended.0.log
     printf '[ RUN      ] Cut.Crashes\n' > cut.0.log
     exit 8 ;;
  *Cut/0*) exit 0 ;;
  *--no-tests=error*Steady*) exit 8 ;;
  *--no-tests=error*Crashes*) exit 8 ;;
  *--no-tests=error*) [ "$(grep -c -- '--no-tests.*Shaky' calls)" -gt "$FAILURES" ] ;;
  *) mkdir -p Testing/Temporary
     printf '4:Steady.Fails\n7:Shaky/Test.OfTwo/0  # GetParam() = 0x55\n' > Testing/Temporary/LastTestsFailed.log; exit 8 ;;
esac
"""


class Again(unittest.TestCase):

    def setUp(self):
        self.folder = tempfile.mkdtemp()
        self.addCleanup(shutil.rmtree, self.folder)
        for name in ("tools", "tests", "build/release", "bin"):
            os.makedirs(os.path.join(self.folder, name))
        shutil.copy(os.path.join(ROOT, "tools", "test"), os.path.join(self.folder, "tools"))
        for name, text in (("tools/build", "#!/bin/sh\n"), ("tools/setup", "#!/bin/sh\n"),
                           ("tools/with_bus", '#!/bin/sh\nexec "$@"\n'), ("bin/ctest", CTEST), ("tests/flaky.txt", "")):
            path = os.path.join(self.folder, name)
            with open(path, "w", encoding="utf-8") as file:
                file.write(text)
            os.chmod(path, 0o755)

    def run_test(self, *options, failures=0, parts=""):
        path = os.path.join(self.folder, "bin") + os.pathsep + os.environ["PATH"]
        done = subprocess.run([os.path.join(self.folder, "tools", "test"), *options], capture_output=True, text=True,
                              env={**os.environ, "PATH": path, "FAILURES": str(failures), "PARTS": parts})
        with open(os.path.join(self.folder, "build", "release", "calls"), encoding="utf-8") as calls:
            return done.returncode, done.stdout.splitlines(), len(calls.readlines())

    def test_a_test_that_passes_alone_is_called_flaky_and_one_that_does_not_fails(self):
        self.assertEqual(self.run_test("--again"), (8, ["FAILED Steady.Fails", "FLAKY Shaky/Test.OfTwo/0"], 5))

    def test_a_second_try_may_fail_and_a_third_may_not(self):
        self.assertEqual(self.run_test("--again", failures=1)[1][1], "FLAKY Shaky/Test.OfTwo/0")

    def test_a_third_failure_is_one(self):
        self.assertEqual(self.run_test("--again", failures=2)[1][1], "FAILED Shaky/Test.OfTwo/0")

    def test_a_test_that_is_known_to_be_flaky_gets_no_second_try(self):
        with open(os.path.join(self.folder, "tests", "flaky.txt"), "w", encoding="utf-8") as file:
            file.write("Shaky/Test.OfTwo/0 2026-11-28 a port\n")
        self.assertEqual(self.run_test("--again"), (8, ["FAILED Steady.Fails", "FAILED Shaky/Test.OfTwo/0"], 4))

    def test_the_tests_of_a_part_that_failed_are_repeated_alone(self):
        code, lines, _ = self.run_test("--again", parts="yes")
        self.assertEqual((code, lines), (8, ["FLAKY Shaky/Test.OfTwo/0", "FAILED Cut.Crashes", "FAILED Steady.Fails"]))

    def test_the_tests_that_a_part_did_not_come_to_are_run(self):
        self.run_test("--again", parts="yes")
        with open(os.path.join(self.folder, "build", "release", "calls"), encoding="utf-8") as calls:
            self.assertEqual([line for line in calls if "Cut/0" in line],
                             ["--output-on-failure --parallel %d -R ^(Cut/0\\.IsLost)( |$)\n" % (os.cpu_count() * 3 // 2 + 1)])

    def test_a_part_that_failed_without_a_test_that_did_fails(self):
        path = os.path.join(self.folder, "bin", "ctest")
        with open(path, encoding="utf-8") as file:
            text = file.read()
        with open(path, "w", encoding="utf-8") as file:
            file.write(text.replace("FAILED  ] Shaky", "     OK ] Shaky"))
        self.assertEqual(self.run_test("--again", parts="yes")[1][0], "FAILED ended.part_0")

    def test_without_again_the_first_failure_counts(self):
        self.assertEqual(self.run_test(), (8, [], 1))


if __name__ == "__main__":
    unittest.main()
