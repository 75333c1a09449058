# SPDX-License-Identifier: BSD-3-Clause
"""A copy of the checkout in which the commands of a page run as they would for someone who has just cloned it.

Nothing is compiled: a stand-in for ninja puts those programs into the copy's build/release/bin that it was asked
for, out of the build tree of the test, so a program that tools/run forgets to build is missing here as it is in a clone.
A stand-in for ctest notes that it was called.
"""
import os
import shutil
import subprocess
import sys
import tempfile

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), ".."))

from own_ports import own_url  # noqa: E402

STAND_IN_CMAKE = """#!/usr/bin/env python3
import os, re, shutil, subprocess, sys
binary_dir, arguments, here = {binary_dir!r}, sys.argv[1:], "build/release"
os.makedirs(here + "/bin", exist_ok=True)
if arguments[:2] == ["--preset", "release"]:
    with open(here + "/CMakeCache.txt", "w") as cache:
        cache.write("CMAKE_HOME_DIRECTORY:INTERNAL=" + os.getcwd() + "\\n")
    open(here + "/build.ninja", "w").close()
    sys.exit(0)
if arguments[:2] == ["--install", here]:
    os.execv({cmake!r}, [{cmake!r}, "--install", binary_dir, *arguments[2:]])
if arguments in (["--version"], ["--list-presets"]):
    os.execv({cmake!r}, [{cmake!r}, *arguments])
sys.exit("cmake: not expected: " + " ".join(arguments))
"""

STAND_IN_NINJA = """#!/usr/bin/env python3
import os, re, shutil, subprocess, sys
binary_dir, arguments = {binary_dir!r}, sys.argv[1:]
here, targets = arguments[1], [each for each in arguments[2:] if not each.startswith("-")]
if "-n" in arguments or not targets:
    sys.exit(0)  # a plan; or everything, for the tests: programs come only by what tools/run asks for
links = subprocess.run([{ninja!r}, "-C", binary_dir, "-t", "commands", *targets], capture_output=True, text=True,
                       check=True)
for linked in re.findall(r" -o ((?:bin|lib/shoal)/[^ ]+)", links.stdout):
    os.makedirs(os.path.dirname(here + "/" + linked), exist_ok=True)
    for path in linked, linked + ".args.yaml":  # the declaration of its arguments, where it has one
        if os.path.exists(here + "/" + path) or not os.path.exists(binary_dir + "/" + path):
            continue
        try:
            os.link(binary_dir + "/" + path, here + "/" + path)
        except OSError:
            shutil.copy2(binary_dir + "/" + path, here + "/" + path)
"""


class CheckoutCopy:
    """`folder`: the user's home, with the copy in `folder`/checkout; removed by remove()."""

    def __init__(self, source, binary_dir):
        self.source, self.binary_dir = source, binary_dir
        self.folder = tempfile.mkdtemp(prefix="page-test-", dir=binary_dir)
        self.checkout = os.path.join(self.folder, "checkout")
        self.stand_ins = os.path.join(self.folder, "stand_ins")
        self.ctest_calls = os.path.join(self.folder, "ctest_calls")
        self.copy_files()
        os.mkdir(self.stand_ins)
        self.write_program("cmake", STAND_IN_CMAKE.format(binary_dir=binary_dir, cmake=shutil.which("cmake")))
        self.write_program("ninja", STAND_IN_NINJA.format(binary_dir=binary_dir, ninja=shutil.which("ninja")))
        self.write_program("ctest", f'#!/bin/sh\necho "$PWD $*" >> "{self.ctest_calls}"\n')
        self.environment = dict(own_bus(), HOME=self.folder, PATH=self.stand_ins + os.pathsep + os.environ["PATH"])

    def remove(self):
        shutil.rmtree(self.folder)

    def copy_files(self):
        listed = subprocess.run(["git", "-C", self.source, "ls-files", "-z", "--cached", "--others",
                                 "--exclude-standard"], capture_output=True, text=True)
        if listed.returncode != 0:  # not a checkout: an unpacked archive
            made = {"build", "results", ".git"}
            shutil.copytree(self.source, self.checkout,
                            ignore=lambda at, names: made & set(names) if at == self.source else set())
            return
        for name in filter(None, listed.stdout.split("\0")):
            if os.path.isfile(os.path.join(self.source, name)):
                target = os.path.join(self.checkout, name)
                os.makedirs(os.path.dirname(target), exist_ok=True)
                shutil.copy2(os.path.join(self.source, name), target)

    def write_program(self, name, text):
        path = os.path.join(self.stand_ins, name)
        with open(path, "w", encoding="utf-8") as file:
            file.write(text)
        os.chmod(path, 0o755)


def own_bus():
    """The environment, with LCM's default, or with a port of this test's own where it shares the network."""
    environment = {key: value for key, value in os.environ.items() if not key.startswith("LCM_")}
    if environment.get("PAGE_TEST_NETWORK") != "own":
        environment["LCM_DEFAULT_URL"] = own_url()
    return environment


def in_own_network():
    """Starts this program again in its own network namespace, if that is allowed."""
    enter = ["unshare", "--map-root-user", "--net", "sh", "-c",
             'ip link set lo multicast on && ip link set lo up && ip route add 224.0.0.0/4 dev lo && exec "$@"', "sh"]
    if "PAGE_TEST_NETWORK" in os.environ:
        return
    if shutil.which("unshare") and subprocess.run([*enter, "true"], capture_output=True).returncode == 0:
        os.environ["PAGE_TEST_NETWORK"] = "own"
        os.execvp(enter[0], [*enter, sys.executable, *sys.argv])
    os.environ["PAGE_TEST_NETWORK"] = "shared"
