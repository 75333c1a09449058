# SPDX-License-Identifier: BSD-3-Clause
"""Runs every command of README.md, docs/start/README.md and docs/start/more_to_try.md, in this order.

    python3 readme_test.py SOURCE BINARY_DIRECTORY

The first two pages run in a copy of the checkout (checkout_copy.py), the third in an empty folder with what the second
one has installed.  Runs are shortened by documented options (see SHORTER), and happen in their own network namespace, where there can be one, else on their own LCM port.
"""
import glob
import json
import os
import re
import shlex
import sys
import tarfile
import unittest

from checkout_copy import CheckoutCopy, in_own_network  # it adds the folder of own_ports
from own_ports import own_ports, url_of
from page_run import PageRun, Terminal
from page_steps import commands_outside_blocks

SOURCE, BINARY_DIR = (os.path.abspath(path) for path in sys.argv[1:3])
PROGRAMS = ("tools/", "build/release/bin/", "cmake --install ", "~/shoal/bin/", "shoal ")

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
WHOLE = {"sonar_tank"}


def shortened(command):
    words = shlex.split(command, comments=True)
    names = [os.path.basename(words[0]), *words[1:2]]
    more = SHORTER.get(tuple(names), SHORTER.get(tuple(names[:1]), []))
    # A run beside a second terminal is ended from there.
    if WHOLE.intersection(words) or "forever" in words:
        return command
    command = command.split(" #")[0]
    for option, value in zip(more[::2], more[1::2]):
        command = re.sub(f" {option} \\S+", "", command) + f" {option} {value}"
    if "coop_land_separate" in words and os.environ["PAGE_TEST_NETWORK"] != "own":  # its buses have fixed ports
        first = own_ports()
        command += "".join(f" --set 'buses.bus{i}.lcm_url={url_of(first + i)}'" for i in (1, 2, 3))
    return command


class ShortRun(PageRun):
    def __init__(self, terminal):
        super().__init__(terminal, shortened)

    def accepts(self, command, exit_code):
        """Rules of a world may fail in so short a run; all else may not."""
        words = shlex.split(command)
        if exit_code != 1 or "--duration" not in words:
            return False
        if "study" in words:
            look = glob.glob(self.terminal.path("results/*_" + words[words.index("--duration") + 1] + "s/study.json"))
            return len(look) > 0 and all(read_json(path)["failed_runs"] == [] for path in look)
        world = next((word for word in words[1:] if word.endswith(".yaml")), words[-1])
        results = "results/" + os.path.splitext(os.path.basename(world))[0]
        if "--results" in words:
            results = words[words.index("--results") + 1]
        summary = read_json(self.terminal.path(results + "/summary.json"))
        return summary["ended"] == "duration" and not any(process["failed"] for process in summary["processes"])


def read_json(path):
    with open(path, encoding="utf-8") as file:
        return json.load(file)


class Readme(unittest.TestCase):
    def make_clone(self):
        self.copy = CheckoutCopy(SOURCE, BINARY_DIR)
        self.addCleanup(self.copy.remove)
        self.terminal = Terminal(self.copy.checkout, self.copy.environment)
        self.addCleanup(self.terminal.close)

    def add_tarball(self):
        """Adds the tarball of this version, as tools/package names it; its program is a link to that of the build."""
        with open(os.path.join(SOURCE, "CMakeLists.txt"), encoding="utf-8") as file:
            version = re.search(r"project\(shoal VERSION ([0-9.]+)", file.read())[1]
        folder = f"shoal-{version}-linux-x86_64"
        with tarfile.open(os.path.join(self.copy.checkout, folder + ".tar.xz"), "w:xz") as tar:
            program = tarfile.TarInfo(folder + "/bin/shoal")
            program.type, program.linkname = tarfile.SYMTYPE, os.path.join(BINARY_DIR, "bin/shoal")
            tar.addfile(program)

    def run_page(self, name):
        with open(os.path.join(SOURCE, name), encoding="utf-8") as file:
            text = file.read()
        self.assertEqual(commands_outside_blocks(text, PROGRAMS), [], "stand in sentences, where they are not run")
        for failure in ShortRun(self.terminal).run(text, name):
            self.fail(failure)

    def test_every_command_works_in_a_clone(self):
        self.make_clone()
        self.add_tarball()
        self.run_page("README.md")
        with open(self.copy.ctest_calls, encoding="utf-8") as file:
            self.assertEqual(len(file.readlines()), 1, "tools/test")
        self.run_page("docs/start/README.md")
        self.assertEqual(self.terminal.run(["mkdir ~/work", "cd ~/work"])[0], 0)
        self.run_page("docs/start/more_to_try.md")

    def test_the_readme_is_short(self):
        with open(os.path.join(SOURCE, "README.md"), encoding="utf-8") as file:
            self.assertLessEqual(len(file.readlines()), 90)


if __name__ == "__main__":
    in_own_network()
    unittest.main(argv=sys.argv[:1], failfast=True)
