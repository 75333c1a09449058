# SPDX-License-Identifier: BSD-3-Clause
"""Runs every command of README.md, in order, in a copy of the checkout, as somebody would who has just cloned it.

    python3 readme_test.py SOURCE BINARY_DIRECTORY

Nothing is compiled: a stand-in for cmake puts those programs into the copy's build/release/bin that `--build` was asked
for, out of BINARY_DIRECTORY, so a program that tools/run forgets to build is missing here as it is in a clone.  A
stand-in for ctest notes that it was called.  Runs are shortened by documented options (see SHORTER), and happen in a
network namespace of their own, where there can be one, else on an LCM port of their own.
"""
import glob
import json
import os
import re
import shlex
import shutil
import subprocess
import sys
import tempfile
import time
import unittest

SOURCE, BINARY_DIR = (os.path.abspath(path) for path in sys.argv[1:3])
PROGRAMS = ("tools/", "build/release/bin/", "cmake --install ", "~/shoal/bin/")
LIMIT_S = 100

# What is appended to a command of this program that begins like this.
SHORTER = {
    ("run",): ["--duration", "3"],  # tools/run
    ("shoal", "run"): ["--duration", "3"],
    ("shoal", "snap"): ["--at", "5"],
    ("shoal", "spy"): ["--duration", "1"],
    ("shoal", "bench"): ["--warm-up", "0.2", "--measure", "0.5"],
    ("shoal", "study"): ["--seeds", "1", "--duration", "3"],
}
# Worlds of which a later command looks at a certain time.
WHOLE = {"worlds/sonar_tank.yaml"}


def commands_in(text):
    """(commands, the run beside which they go) of each block of `sh`, and of the sentences before it."""
    found = []
    for before, block in re.findall(r"(.*?)(?:^```sh\n(.*?)^```$|\Z)", text, re.S | re.M):
        before = re.sub(r"^```.*?^```$", "", before, flags=re.S | re.M)
        inline = [code for code in re.findall(r"`([^`\n]+)`", before)
                  if code.startswith(PROGRAMS) and len(code.split()) > 1 and code != "build/release/bin/shoal run"]
        paragraph = before.strip().rsplit("\n\n", 1)[-1]
        lines = [line for line in block.splitlines() if line.strip() and not line.startswith("#")]
        if "second terminal" in paragraph:
            found.append((inline[:-1], None))
            found.append((lines, inline[-1]))
        else:
            found.append((inline + lines, None))
    return [(commands, beside) for commands, beside in found if commands]


def shortened(words):
    names = [os.path.basename(words[0]), *words[1:2]]
    more = SHORTER.get(tuple(names), SHORTER.get(tuple(names[:1]), []))
    if WHOLE.intersection(words):
        return words
    for option, value in zip(more[::2], more[1::2]):
        if option in words:
            words[words.index(option) + 1] = value
        else:
            words += [option, value]
    return words


STAND_IN_CMAKE = """#!/usr/bin/env python3
import os, re, shutil, subprocess, sys
binary_dir, arguments, here = {binary_dir!r}, sys.argv[1:], "build/release"
os.makedirs(here + "/bin", exist_ok=True)
if arguments[:2] == ["--preset", "release"]:
    with open(here + "/CMakeCache.txt", "w") as cache:
        cache.write("CMAKE_HOME_DIRECTORY:INTERNAL=" + os.getcwd() + "\\n")
    sys.exit(0)
if arguments[:2] == ["--install", here]:
    os.execv({cmake!r}, [{cmake!r}, "--install", binary_dir, *arguments[2:]])
if arguments[:2] != ["--build", here]:
    sys.exit("cmake: not expected: " + " ".join(arguments))
if arguments[2:3] != ["--target"]:
    sys.exit(0)  # everything, for the tests; programs come only by what tools/run asks for
links = subprocess.run(["ninja", "-C", binary_dir, "-t", "commands", *arguments[3:]], capture_output=True, text=True,
                       check=True)
for path in re.findall(r" -o (bin/[^ ]+)", links.stdout):
    if os.path.exists(here + "/" + path):
        continue
    try:
        os.link(binary_dir + "/" + path, here + "/" + path)
    except OSError:
        shutil.copy2(binary_dir + "/" + path, here + "/" + path)
"""


class Readme(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.folder = tempfile.mkdtemp(prefix="readme-test-", dir=BINARY_DIR)
        cls.clone = os.path.join(cls.folder, "checkout")
        cls.copy_checkout()
        cls.stand_ins = os.path.join(cls.folder, "stand_ins")
        os.mkdir(cls.stand_ins)
        cls.ctest_calls = os.path.join(cls.folder, "ctest_calls")
        cls.write_program("cmake", STAND_IN_CMAKE.format(binary_dir=BINARY_DIR, cmake=shutil.which("cmake")))
        cls.write_program("ctest", f'#!/bin/sh\necho "$PWD $*" >> "{cls.ctest_calls}"\n')
        cls.environment = dict(os.environ, PATH=cls.stand_ins + os.pathsep + os.environ["PATH"], HOME=cls.folder)
        cls.environment["LCM_DEFAULT_URL"] = f"udpm://239.255.76.67:{10000 + os.getpid() * 4 % 20000}?ttl=0"

    @classmethod
    def tearDownClass(cls):
        shutil.rmtree(cls.folder)

    @classmethod
    def copy_checkout(cls):
        listed = subprocess.run(["git", "-C", SOURCE, "ls-files", "-z", "--cached", "--others", "--exclude-standard"],
                                capture_output=True, text=True)
        if listed.returncode != 0:  # not a checkout: an unpacked archive
            made = {"build", "results", ".git"}
            shutil.copytree(SOURCE, cls.clone, ignore=lambda at, names: made & set(names) if at == SOURCE else set())
            return
        for name in filter(None, listed.stdout.split("\0")):
            if os.path.isfile(os.path.join(SOURCE, name)):
                target = os.path.join(cls.clone, name)
                os.makedirs(os.path.dirname(target), exist_ok=True)
                shutil.copy2(os.path.join(SOURCE, name), target)

    @classmethod
    def write_program(cls, name, text):
        path = os.path.join(cls.stand_ins, name)
        with open(path, "w", encoding="utf-8") as file:
            file.write(text)
        os.chmod(path, 0o755)

    def test_every_command_does_what_it_says(self):
        with open(os.path.join(SOURCE, "README.md"), encoding="utf-8") as file:
            groups = commands_in(file.read())
        self.assertGreater(sum(len(commands) for commands, _ in groups), 30)
        for commands, beside in groups:
            run = self.start_beside(beside) if beside else None
            for command in commands:
                with self.subTest(command=command):
                    self.run_command(command)
            if run:
                self.assertEqual(run.wait(LIMIT_S), 0, beside)
        with open(self.ctest_calls, encoding="utf-8") as file:
            self.assertEqual(len(file.readlines()), 1, "tools/test")

    def words_of(self, command):
        self.assertTrue(command.startswith(PROGRAMS), command)
        words = shlex.split(command, comments=True)
        return shortened([re.sub("^~", self.folder, word) for word in words])

    def shell(self, words, **options):
        return subprocess.Popen(["sh", "-c", "exec " + shlex.join(words)], cwd=self.clone, env=self.environment,
                                stdin=subprocess.DEVNULL, text=True, **options)

    def run_command(self, command):
        words, begin = self.words_of(command), time.monotonic()
        process = self.shell(words, stdout=subprocess.PIPE, stderr=subprocess.PIPE)
        try:
            output, errors = process.communicate(timeout=LIMIT_S)
        except subprocess.TimeoutExpired:
            process.kill()
            self.fail(f"{shlex.join(words)}: not done after {LIMIT_S} s")
        if os.environ.get("README_TEST_TIMES"):
            print(f"{time.monotonic() - begin:6.1f} s  {process.returncode}  {shlex.join(words)}", file=sys.stderr)
        said = f"{shlex.join(words)}\n{output}{errors}"
        # Rules of a world may fail in so short a run; all else may not.
        if process.returncode == 1 and "--duration" in words:
            self.assert_only_rules_failed(words, said)
        else:
            self.assertEqual(process.returncode, 0, said)
        self.assertNotIn("cannot", errors, said)
        if " control rewind " in command:
            self.assertIn("go on with `shoal control resume`", errors, said)
        if command.split("#")[0].strip().endswith(" control resume"):
            self.assertNotIn("paused", self.where())

    def assert_only_rules_failed(self, words, said):
        name = os.path.splitext(os.path.basename(next(word for word in words if word.endswith(".yaml"))))[0]
        if "study" in words:
            look = glob.glob(os.path.join(self.clone, "results", "*_" + words[words.index("--duration") + 1] + "s"))
            with open(os.path.join(look[0], "study.json"), encoding="utf-8") as file:
                self.assertEqual(json.load(file)["failed_runs"], [], said)
            return
        with open(os.path.join(self.clone, "results", name, "summary.json"), encoding="utf-8") as file:
            summary = json.load(file)
        self.assertEqual(summary["ended"], "duration", said)
        self.assertFalse(any(process["failed"] for process in summary["processes"]), said)

    def where(self):
        done = subprocess.run(["build/release/bin/shoal", "control", "where", "--timeout", "1"], cwd=self.clone,
                              env=self.environment, capture_output=True, text=True)
        return done.stdout

    def start_beside(self, command):
        """The run of the first terminal, ten times as fast, once it is 6 s old: a command may rewind it by 5 s."""
        words = shlex.split(command, comments=True)
        run = self.shell([*words, "--speed", "10"], stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        self.addCleanup(run.wait)
        self.addCleanup(run.kill)
        deadline = time.monotonic() + LIMIT_S
        while time.monotonic() < deadline:
            time_s = re.search(r"step \d+, ([0-9.]+) s", self.where())
            if time_s and float(time_s[1]) > 6:
                return run
            self.assertIsNone(run.poll(), command)
        self.fail(f"{command}: nobody answers")


def in_own_network():
    """Starts this program again in a network namespace of its own, if that is allowed."""
    enter = ["unshare", "--map-root-user", "--net", "sh", "-c",
             'ip link set lo multicast on && ip link set lo up && ip route add 224.0.0.0/4 dev lo && exec "$@"', "sh"]
    if "README_TEST_INSIDE" in os.environ:
        return
    os.environ["README_TEST_INSIDE"] = "1"
    if shutil.which("unshare") and subprocess.run([*enter, "true"], capture_output=True).returncode == 0:
        os.execvp(enter[0], [*enter, sys.executable, *sys.argv])


if __name__ == "__main__":
    in_own_network()
    unittest.main(argv=sys.argv[:1])
