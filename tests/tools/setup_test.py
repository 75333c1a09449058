# SPDX-License-Identifier: BSD-3-Clause
"""tools/setup and tools/build report each failure in one sentence, and continue at the next call.

Nothing is installed or compiled: apt-get, cmake, ninja and others are scripts of a few lines, alone in PATH.
"""
import os
import shutil
import signal
import subprocess
import tempfile
import time
import unittest

ROOT = os.path.dirname(os.path.dirname(os.path.dirname(os.path.abspath(__file__))))
COMMANDS = ("awk basename bash cat chmod dirname env grep head mkdir mktemp python3 rm sed sort tail touch tr").split()
PACKAGES = ("# A list.\n\n# [run]\n# build\nno-such-a\n# [test]\n# tests\nno-such-b\n# [release]\n"
            "# packages\nno-such-c\n# [ci]\n# fuzzing (needs clang)\nno-such-d\nno-such-e\n# lint\nno-such-f\n")
DEBIAN = 'PRETTY_NAME="Debian GNU/Linux {0}"\nID=debian\nVERSION_ID="{0}"\n'
# apt-get install notes its packages, which dpkg-query then finds.
STUBS = {
    "apt-get": '''echo "$@" >>"$SCRATCH/apt-calls"
[ "$2" != install ] || shift 4
printf "installed, %s, \\n" "$@" >>"$SCRATCH/installed"''',
    "dpkg": 'echo "dpkg $*" >>"$SCRATCH/apt-calls"',
    "dpkg-query": 'cat "$SCRATCH/installed" 2>/dev/null || true',
    "id": "echo 0",
    "sleep": 'echo "$@" >>"$SCRATCH/sleeps"',
    "ccache": 'echo "$HOME/.cache/ccache"',
    "c++": "exit 1",
    "cmake": """case "$1" in
  --version) echo "cmake version 3.25.1" ;;
  --list-presets) printf 'Available configure presets:\\n\\n  "release" - what users run\\n  "dev"     - asserts\\n' ;;
  *) echo "$@ CCACHE_DISABLE=${CCACHE_DISABLE:-}" >>"$SCRATCH/cmake-calls"; touch build/release/build.ninja ;;
esac""",
    "ninja": 'case "$*" in *-n*) exit 1 ;; esac; echo "[1/1] Linking CXX executable bin/shoal"',
}


class Scratch(unittest.TestCase):
    """A checkout of the scripts alone, with a PATH of stubs."""

    def setUp(self):
        self.folder = tempfile.mkdtemp()
        self.addCleanup(shutil.rmtree, self.folder)
        os.chmod(self.folder, 0o755)
        for name in ("tools", "bin", "home"):
            os.mkdir(self.path(name))
        for name in ("setup", "build", "build_progress", "run"):
            shutil.copy(os.path.join(ROOT, "tools", name), self.path("tools"))
        self.write("tools/apt-packages.txt", PACKAGES)
        self.write("CMakeLists.txt", "cmake_minimum_required(VERSION 3.25)\n")
        self.write("os-release", DEBIAN.format(12))
        for name in COMMANDS:
            os.symlink(shutil.which(name), self.path("bin", name))
        for name, text in STUBS.items():
            self.stub(name, text)

    def path(self, *names):
        return os.path.join(self.folder, *names)

    def write(self, name, text):
        os.makedirs(os.path.dirname(self.path(name)), exist_ok=True)
        with open(self.path(name), "w", encoding="utf-8") as file:
            file.write(text)

    def read(self, name):
        if not os.path.exists(self.path(name)):
            return ""
        with open(self.path(name), encoding="utf-8") as file:
            return file.read()

    def stub(self, name, text):
        self.write(f"bin/{name}", f"#!{shutil.which('bash')}\n{text}\n")
        os.chmod(self.path("bin", name), 0o755)

    def install(self, *packages):
        self.write("installed", "".join(f"installed, {package}, \n" for package in packages))

    def process(self, *words, **options):
        environment = {"PATH": self.path("bin"), "HOME": self.path("home"), "SCRATCH": self.folder, "LC_ALL": "C.UTF-8",
                       "SHOAL_OS_RELEASE": self.path("os-release")}
        return subprocess.Popen([self.path(words[0]), *words[1:]], env=environment, text=True, stdin=subprocess.DEVNULL,
                                stdout=subprocess.PIPE, stderr=subprocess.STDOUT, **options)

    def run_script(self, *words, code=0, **options):
        """Runs a script and returns its lines."""
        process = self.process(*words, **options)
        output = process.communicate(timeout=60)[0]
        self.assertEqual(process.returncode, code, output)
        return output.splitlines()

    def lines_when_stopped(self, number, code, *words):
        """Sends a signal, as a terminal does to all of its programs, when the file `started` is there."""
        process = self.process(*words, start_new_session=True)
        while not os.path.exists(self.path("started")) and process.poll() is None:
            time.sleep(0.01)
        os.killpg(process.pid, number)
        output = process.communicate(timeout=60)[0]
        self.assertEqual(process.returncode, code, output)
        return output.splitlines()


class Setup(Scratch):
    INSTALLING = "installing: no-such-a"

    def setup_fails(self, sentence, code=1, before=(INSTALLING,)):
        lines = self.run_script("tools/setup", "--for", "run", code=code)
        self.assertEqual(lines, [*before, f"tools/setup: {sentence}"])

    def apt_prints(self, *lines, update=""):
        text = "\n".join(lines)
        self.stub("apt-get", f'case "$*" in *update*) printf "%s\\n" "{update}" ;; '
                             f'*) cat <<"END"\n{text}\nEND\nexit 100 ;; esac')

    def test_each_section_includes_those_before_it(self):
        self.assertEqual(self.run_script("tools/setup", "--for", "run", "--list"), ["no-such-a"])
        self.assertEqual(self.run_script("tools/setup", "--list"), ["no-such-a", "no-such-b"])
        self.assertEqual(self.run_script("tools/setup", "--for", "release", "--list"), [f"no-such-{c}" for c in "abc"])
        self.assertEqual(self.run_script("tools/setup", "--for", "ci", "--list"), [f"no-such-{c}" for c in "abcdef"])

    def test_what_is_left_out_is_named_in_one_line(self):
        self.assertEqual(self.run_script("tools/setup", "--for", "test", "--left-out"),
                         ["left out: packages, fuzzing, lint (tools/setup --for ci)"])

    def test_what_is_missing_is_installed_once(self):
        self.install("no-such-b")
        self.assertEqual(self.run_script("tools/setup"), [self.INSTALLING])
        self.assertEqual(self.read("apt-calls"), "-qq update\n-qq install -y --no-install-recommends no-such-a\n")
        self.assertEqual(self.run_script("tools/setup"), [])

    def test_wrong_words_are_named(self):
        self.assertEqual(self.run_script("tools/setup", "--for", "x", code=2),
                         ["tools/setup: --for must be run, test, release or ci, got 'x'"])
        self.assertEqual(self.run_script("tools/setup", "--for", code=2), ["tools/setup: --for needs run, test, release or ci"])

    def test_another_system_than_debian(self):
        os.remove(self.path("bin", "dpkg-query"))
        self.write("os-release", "NAME=Fedora\nID=fedora\nVERSION_ID=40\nPRETTY_NAME='Fedora Linux 40'\n")
        self.setup_fails("Fedora Linux 40 has no apt: install what tools/apt-packages.txt lists by hand, then call "
                         "cmake --preset release and cmake --build build/release", 2, [])

    def test_an_old_debian(self):
        self.write("os-release", DEBIAN.format(11))
        self.setup_fails("Debian GNU/Linux 11 is too old, Debian 12 is needed: use it in a container "
                         "(docker build -t shoal .)", 2, [])

    def test_a_package_that_the_release_does_not_have(self):
        self.apt_prints("E: Unable to locate package no-such-a", "E: Package 'other' has no installation candidate")
        self.setup_fails("Debian GNU/Linux 12 does not have these packages: no-such-a other (docker build "
                         "-t shoal . uses Debian 12)")

    def test_no_network(self):
        sentence = ("no connection to the package server: check network and /etc/apt/sources.list, then run the same "
                    "command again")
        self.apt_prints("E: Failed to fetch http://x/a.deb  Temporary failure resolving 'x'",
                        "E: Unable to fetch some archives, maybe run apt-get update or try with --fix-missing?")
        self.setup_fails(sentence)
        # Without the lists of an earlier update apt knows no package.
        self.apt_prints("E: Unable to locate package no-such-a",
                        update="W: Failed to fetch http://x/InRelease  Could not connect to x:80")
        self.setup_fails(sentence)

    def test_no_right_to_install(self):
        self.stub("id", "echo 1000")
        self.setup_fails("there is no sudo: run as root: apt-get install no-such-a", 2, [])
        self.stub("sudo", "echo 'sudo: a terminal is required to read the password'; exit 1")
        self.setup_fails("sudo does not permit it: run as root: apt-get install no-such-a", 2)
        self.stub("sudo", 'exec "$@"')
        self.assertEqual(self.run_script("tools/setup", "--for", "run"), [self.INSTALLING])

    def test_waits_for_a_lock(self):
        lock = ("E: Could not get lock /var/lib/dpkg/lock-frontend. It is held by process 12 (apt-get)\n"
                "E: Unable to acquire the dpkg frontend lock, is another process using it?")
        self.stub("apt-get", 'case "$*" in *update*) exit ;; esac\n'
                             f'[ -e "$SCRATCH/unlocked" ] || {{ echo "{lock}"; exit 100; }}')
        self.stub("sleep", 'touch "$SCRATCH/unlocked"')
        waiting = "tools/setup: waiting up to 10 min for process 12 (apt-get), which has locked the packages"
        self.assertEqual(self.run_script("tools/setup", "--for", "run"), [self.INSTALLING, waiting])
        os.remove(self.path("unlocked"))
        self.stub("sleep", 'echo "$@" >>"$SCRATCH/sleeps"')
        self.setup_fails("process 12 (apt-get) has locked the packages for 10 min: run the same command again when it "
                         "has ended", before=(self.INSTALLING, waiting))
        self.assertEqual(self.read("sleeps"), "2\n" * 300)

    def test_an_interrupted_installation_is_completed(self):
        self.stub("dpkg", '[ "$*" != "--configure -a" ] || touch "$SCRATCH/configured"')
        self.stub("apt-get", """case "$*" in *update*) exit ;; esac
[ -e "$SCRATCH/configured" ] && exit
echo "E: dpkg was interrupted, you must manually run 'dpkg --configure -a' to correct the problem."
exit 100""")
        completing = "tools/setup: completing an interrupted installation by dpkg --configure -a"
        self.assertEqual(self.run_script("tools/setup", "--for", "run"), [self.INSTALLING, completing])
        os.remove(self.path("configured"))
        self.stub("dpkg", "echo 'dpkg: error processing package x (--configure):'; exit 1")
        self.setup_fails("apt-get failed: dpkg: error processing package x (--configure):",
                         before=(self.INSTALLING, completing))

    def test_other_failures_of_apt(self):
        self.apt_prints("E: You don't have enough free space in /var/cache/apt/archives/.")
        self.setup_fails("the disk is full: free some space (apt-get clean frees that of apt), then run the same "
                         "command again")
        self.apt_prints("W: Not using locking for read only lock file", "E: Unable to write: Read-only file system")
        self.setup_fails("the system's folders are read-only: packages cannot be installed here: no-such-a")
        self.apt_prints("The following packages have unmet dependencies:",
                        "E: Unable to correct problems, you have held broken packages.")
        self.setup_fails("installed packages conflict: run apt-get --fix-broken install, then the same command again")
        self.apt_prints("Reading lists", "E: The value 'x' is invalid for APT::Default-Release", "E: More")
        self.setup_fails("apt-get failed: The value 'x' is invalid for APT::Default-Release")

    def test_a_signal_stops_it_and_the_next_call_continues(self):
        self.stub("apt-get", ': >"$SCRATCH/started"; exec tail -f /dev/null')
        stopped = "tools/setup: installation stopped; run the same command again to continue"
        for number, code in ((signal.SIGINT, 130), (signal.SIGTERM, 143), (signal.SIGHUP, 129)):
            self.assertEqual(self.lines_when_stopped(number, code, "tools/setup", "--for", "run"),
                             [self.INSTALLING, stopped])
            os.remove(self.path("started"))
        self.stub("apt-get", STUBS["apt-get"])
        self.assertEqual(self.run_script("tools/setup", "--for", "run"), [self.INSTALLING])


class Build(Scratch):
    BUILT = "[1/1]"

    def setUp(self):
        super().setUp()
        self.install("no-such-a", "no-such-b")

    def build_fails(self, sentence, code=1, before=(), words=(), **options):
        lines = self.run_script("tools/build", *words, code=code, **options)
        self.assertEqual(lines, [*before, f"tools/build: {sentence}"])

    def cache(self, home=None, generator="Ninja", compiler="c++"):
        self.write("build/release/CMakeCache.txt", f"CMAKE_HOME_DIRECTORY:INTERNAL={home or self.folder}\n"
                   f"CMAKE_CACHEFILE_DIR:INTERNAL={home or self.folder}/build/release\n"
                   f"CMAKE_GENERATOR:INTERNAL={generator}\nCMAKE_CXX_COMPILER:STRING={compiler}\n")

    def test_builds_what_is_asked_for(self):
        self.assertEqual(self.run_script("tools/build", "shoal"), [self.BUILT])
        self.assertEqual(self.read("cmake-calls"),
                         "--preset release -DSHOAL_TESTS=ON -DSHOAL_PYTHON=ON CCACHE_DISABLE=\n")

    def test_wrong_words_are_named(self):
        self.build_fails("unknown option '--x'", 2, words=["--x"])
        self.build_fails("--preset needs a name", 2, words=["--preset"])
        self.build_fails("unknown preset 'nope'; presets: release, dev", 2, words=["--preset", "nope"])
        self.assertFalse(os.path.exists(self.path("build")))

    def test_an_old_cmake(self):
        self.stub("cmake", "echo 'cmake version 3.18.4'")
        self.build_fails("cmake must be >= 3.25, got 3.18.4: install a newer one, such as that of Debian 12")

    def test_a_failed_setup_ends_it(self):
        self.install()
        os.remove(self.path("bin", "dpkg-query"))
        self.assertEqual(len(self.run_script("tools/build", code=2)), 1)

    def test_a_folder_that_cannot_be_written(self):
        self.write("build", "a file")
        sentence = f"cannot write to {self.path('build/release')}: %s; correct this, or build in a copy of the checkout"
        self.build_fails(sentence % "Not a directory")
        os.remove(self.path("build"))
        os.makedirs(self.path("build/release"), mode=0o555)
        other_user = {"user": 65534} if os.getuid() == 0 else {}
        self.build_fails(sentence % "Permission denied", **other_user)

    def test_a_compiler_cache_that_cannot_be_written_is_not_used(self):
        self.write("home/.cache", "a file")
        self.assertEqual(self.run_script("tools/build"), [
            f"tools/build: building without the compiler cache, because {self.path('home/.cache/ccache')} cannot be "
            "written", self.BUILT])
        self.assertIn("CCACHE_DISABLE=1", self.read("cmake-calls"))

    def test_the_tree_of_another_checkout_generator_or_compiler_is_configured_again(self):
        for cache in ({"home": "/no/such/folder"}, {"generator": "Unix Makefiles"}, {"compiler": "no-such-compiler"}):
            self.cache(**cache)
            first, *rest = self.run_script("tools/build")
            self.assertRegex(first, "^tools/build: configuring build/release again, which was made for ")
            self.assertIn(*cache.values(), first)
            self.assertEqual(rest, [self.BUILT])
            self.assertIn("--fresh", self.read("cmake-calls").splitlines()[-1])
        self.cache()
        self.assertEqual(self.run_script("tools/build"), [self.BUILT])
        self.assertNotIn("--fresh", self.read("cmake-calls").splitlines()[-1])

    def configuring(self, text):
        self.stub("cmake", STUBS["cmake"].replace("  *)", f"  *) {text} ;;\n  never)"))

    def test_an_error_of_cmake_is_one_line_with_the_file_of_the_rest(self):
        self.configuring("""printf -- '-- Found A\\n-- No package lcm found\\nCMake Error at CMakeLists.txt:3 (message):
  lcm is
  missing\\n\\n\\nCMake Error: more\\n-- Configuring incomplete, errors occurred!\\n'; exit 1""")
        self.build_fails("cannot configure: CMake Error at CMakeLists.txt:3 (message): lcm is missing (all output: "
                         "build/release/configure.log)")
        self.assertIn("No package lcm found", self.read("build/release/configure.log"))

    def test_a_full_disk_while_configuring(self):
        self.configuring("echo 'CMake Error: Cannot write CMakeCache.txt: No space left on device'; exit 1")
        self.build_fails(f"the disk of {self.path('build/release')} is full: free some space, then run the same "
                         "command again")

    def test_a_signal_while_configuring(self):
        self.configuring(': >"$SCRATCH/started"; exec tail -f /dev/null')
        for number, code in ((signal.SIGINT, 130), (signal.SIGTERM, 143)):
            self.assertEqual(self.lines_when_stopped(number, code, "tools/build"), [
                "tools/build: configuring stopped; run the same command again to continue"])
            os.remove(self.path("started"))

    def failing(self, output):
        text = output.replace("'", "'\\''")
        self.stub("ninja", f"printf '%s\\n' '[1/1] Building CXX object a.o' 'FAILED: a.o' 'g++ -c a.cpp' '{text}' "
                           "'ninja: build stopped: subcommand failed.'; exit 1")

    def test_a_full_disk_while_compiling(self):
        self.failing("/tmp/x.s: Fatal error: can't fill 256 bytes in section .data of a.o: 'No space left on device'")
        lines = self.run_script("tools/build", code=1)
        self.assertRegex(lines[-1], r"^tools/build: the disk of \S+( or \S+)? is full: free some space, then run the "
                                    "same command again$")
        self.assertEqual(lines[:-1], ["[1/1]"])
        self.stub("ninja", STUBS["ninja"])
        self.assertEqual(self.run_script("tools/build"), [self.BUILT])

    def test_too_little_memory_while_compiling(self):
        self.failing("g++: fatal error: Killed signal terminated program cc1plus")
        self.build_fails("the compiler ran out of memory: put CMAKE_BUILD_PARALLEL_LEVEL=1 before the command",
                         before=["[1/1]"])

    def test_an_error_in_the_code_is_printed_whole(self):
        self.failing("a.cpp:1:1: error: oops")
        self.assertEqual(self.run_script("tools/build", code=1),
                         ["[1/1]", "FAILED: a.o", "g++ -c a.cpp", "a.cpp:1:1: error: oops"])

    def test_run_reports_a_missing_world_before_it_builds(self):
        self.assertEqual(self.run_script("tools/run", "no_such", code=2), [
            f"tools/run: there is no world 'no_such', neither here nor in {self.path('worlds')}"])
        self.assertEqual(self.read("cmake-calls"), "")
        for name in ("worlds/yard.yaml", "worlds/group/yard.yaml"):
            self.write(name, "")
        self.write("build/release/bin/shoal", '#!/usr/bin/env bash\necho "$@"\n')
        os.chmod(self.path("build/release/bin/shoal"), 0o755)
        for world in ("yard", "yard.yaml", "worlds/yard.yaml", "group/yard", self.path("worlds/yard.yaml")):
            self.assertEqual(self.run_script("tools/run", world), [self.BUILT, f"run {world} --results results/yard"])

    def test_a_signal_while_compiling_and_the_next_call_continues(self):
        self.write("worlds/yard.yaml", "")
        self.stub("ninja", 'case "$*" in *-n*) exit 1 ;; esac; : >"$SCRATCH/started"; exec tail -f /dev/null')
        for number, code, *command in ((signal.SIGINT, 130, "tools/build"), (signal.SIGTERM, 143, "tools/build"),
                                       (signal.SIGINT, 130, "tools/run", "yard")):
            self.assertEqual(self.lines_when_stopped(number, code, *command),
                             ["tools/build: build stopped; run the same command again to continue"])
            os.remove(self.path("started"))
        self.stub("ninja", STUBS["ninja"])
        self.assertEqual(self.run_script("tools/build"), [self.BUILT])


if __name__ == "__main__":
    unittest.main()
