#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""The exported object of OPEN-R compiles, and commands the numbers of the C table.

open_r_object_test.py BIN: BIN has the program shoal.  open_r_stubs.hpp stands in for the SDK; def.h is written from
stub.cfg, as stubgen2 does by Sony's Programmer's Guide."""
import os
import re
import subprocess
import sys
import tempfile
import unittest

FOLDER = os.path.dirname(os.path.abspath(__file__))
ROOT = os.path.abspath(os.path.join(FOLDER, *[".."] * 3))
BIN = os.path.abspath(sys.argv.pop(1) if len(sys.argv) > 1 else "build/release/bin")
MOTION = os.path.join(ROOT, "vehicles", "motions", "ers7", "wave.yaml")
HEADERS = ["ODataFormats", "OObject", "OObserver", "OPENRAPI", "OSubject", "OSyslog", "RCRegion", "core_macro"]
MAIN = """#include <cstdio>
#include "WaveMotion.h"
int main() {
  WaveMotion object;
  OSystemEvent event;
  if (object.DoInit(event) != oSUCCESS || object.DoStart(event) != oSUCCESS) return 1;
  do object.Ready(OReadyEvent()); while (Robot::one().play());
  object.DoStop(event);
  object.DoDestroy(event);
}
"""
SERVICE = re.compile(r'Service : "(\w+)\.(\w+)\.(\w+)\.([SO])", (null|\w+\(\)), (null|\w+\(\))')


def shoal(*arguments):
    return subprocess.run([os.path.join(BIN, "shoal"), "motion", "export", *arguments], capture_output=True, text=True,
                          timeout=60)


def read(*path):
    with open(os.path.join(*path), encoding="utf-8") as file:
        return file.read()


class OpenRObject(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.scratch = tempfile.TemporaryDirectory()
        cls.folder = os.path.join(cls.scratch.name, "object")
        cls.ended = shoal(MOTION, "--format", "openr", "--output", cls.folder)

    @classmethod
    def tearDownClass(cls):
        cls.scratch.cleanup()

    def test_the_folder_has_the_files_of_an_object(self):
        self.assertEqual(self.ended.returncode, 0, self.ended.stderr)
        self.assertEqual(sorted(os.listdir(self.folder)),
                         ["CONNECT.CFG", "OBJECT.CFG", "WaveMotion.cc", "WaveMotion.h", "stub.cfg", "wave.ocf",
                          "wave_frames.h"])

    def test_its_table_is_that_of_openr_c(self):
        table = os.path.join(self.scratch.name, "wave.h")
        self.assertEqual(shoal(MOTION, "--format", "openr-c", "--output", table).returncode, 0)
        self.assertEqual(read(self.folder, "wave_frames.h"), read(table))

    def test_its_entries_connect_what_the_stub_declares(self):
        stub = read(self.folder, "stub.cfg").splitlines()
        self.assertEqual(stub[:3], ["ObjectName : WaveMotion", "NumOfOSubject : 1", "NumOfOObserver : 1"])
        services = [SERVICE.fullmatch(line) for line in stub[3:]]
        self.assertTrue(all(services), stub)
        self.assertEqual([service[4] for service in services], ["S", "O"])
        self.assertEqual(read(self.folder, "OBJECT.CFG"), "/MS/OPEN-R/MW/OBJS/WAVE.BIN\n")
        subject, observer = read(self.folder, "CONNECT.CFG").split()
        self.assertEqual(subject, ".".join(services[0].groups()[:4]))
        self.assertEqual(observer, "OVirtualRobotComm.Effector.OCommandVectorData.O")
        # object NAME STACK HEAP PRIORITY CACHE TLB MODE
        self.assertRegex(read(self.folder, "wave.ocf"), r"\Aobject WaveMotion \d+ \d+ 128 cache tlb user\n\Z")

    def build_and_run(self):
        build = os.path.join(self.scratch.name, "build")
        os.makedirs(os.path.join(build, "OPENR"), exist_ok=True)
        for header in HEADERS:
            with open(os.path.join(build, "OPENR", header + ".h"), "w", encoding="utf-8") as file:
                file.write(f'#include "{FOLDER}/open_r_stubs.hpp"\n')
        services = SERVICE.findall(read(self.folder, "stub.cfg"))
        with open(os.path.join(build, "def.h"), "w", encoding="utf-8") as file:
            for kind, count, prefix in [("S", "numOfSubject", "sbj"), ("O", "numOfObserver", "obs")]:
                names = [service[1] for service in services if service[3] == kind]
                file.write(f"const int {count} = {len(names)};\n")
                file.writelines(f"const int {prefix}{name} = {i};\n" for i, name in enumerate(names))
        with open(os.path.join(build, "main.cc"), "w", encoding="utf-8") as file:
            file.write(MAIN)
        # The compiler of the SDK is of 2004.
        program = os.path.join(build, "object")
        subprocess.run(["g++", "-std=c++98", "-Wall", "-Wextra", "-Werror", f"-I{build}", f"-I{self.folder}",
                        os.path.join(build, "main.cc"), os.path.join(self.folder, "WaveMotion.cc"), "-o", program],
                       check=True, timeout=300)
        return subprocess.run([program], capture_output=True, text=True, check=True, timeout=60).stdout.splitlines()

    def test_it_compiles_and_commands_the_numbers_of_the_table(self):
        lines = self.build_and_run()
        table = read(self.folder, "wave_frames.h")
        locators = re.findall(r'^    "(.*)",$', table, re.MULTILINE)
        numbers = [[int(value) for value in row.split(", ")] for row in re.findall(r"\{(-?\d[-\d, ]*)\}", table)]
        self.assertEqual(len(numbers[0]), len(locators))
        # The power, a package that holds the joints where they are, then the gains of all joints but the ears.
        self.assertEqual(lines[0], "power 1")
        gains = {line.split()[1]: line.split()[2:] for line in lines if line.startswith("gain")}
        self.assertEqual(set(gains), {locator for locator in locators if "Joint2" in locator})
        self.assertEqual(len(gains), 18)
        self.assertEqual(gains["PRM:/r2/c1/c2-Joint2:22"], ["20", "4", "1", "14", "2", "15"])
        self.assertEqual([line.split()[0] for line in lines[:20]], ["power", "package"] + ["gain"] * 18)
        frames = []
        for line in lines:
            words = line.split()
            if words[0] != "package":
                continue
            joints = {words[i]: [int(value) for value in words[i + 1:i + 5]] for i in range(1, len(words), 5)}
            frames += [{name: values[k] for name, values in joints.items()} for k in range(4)]
        self.assertTrue(all(value == 100000 for frame in frames[:4] for value in frame.values()))
        # The end is the table.
        played = [[frame[name] for name in gains] for frame in frames[-len(numbers):]]
        self.assertEqual(played, [[row[locators.index(name)] for name in gains] for row in numbers])
        # The approach: at 0.5 rad/s, the usual start of a motion, and at least 0.5 s; 1e-6 rad of rounding.
        approach = frames[4:-len(numbers)]
        self.assertGreaterEqual(len(approach) * 0.008, 0.5 - 0.032)
        for before, after in zip(frames[3:], approach):
            self.assertLessEqual(max(abs(after[name] - before[name]) for name in gains), 0.5e6 * 0.008 + 1)
        self.assertEqual(list(approach[-1].values()), [frames[-len(numbers)][name] for name in approach[-1]])

    def test_what_is_there_is_not_replaced(self):
        again = shoal(MOTION, "--format", "openr", "--output", self.folder)
        self.assertEqual(again.returncode, 2)
        self.assertIn("WaveMotion.h' exists; --overwrite replaces it", again.stderr)
        file = os.path.join(self.scratch.name, "file")
        open(file, "w").close()
        self.assertIn("must be a folder for this format", shoal(MOTION, "--format", "openr", "--output", file).stderr)

    def test_joints_without_gains_are_refused_and_ears_are_left_out(self):
        path = os.path.join(self.scratch.name, "other.yaml")
        for joint, error in [("hip", "joint 'hip' is not a locator of Sony's ERS-7"),
                             ('"PRM:/r1/c1/c2/c3/e5-Joint4:15"', "names no joint that an object of OPEN-R moves")]:
            with open(path, "w", encoding="utf-8") as file:
                file.write(f"shoal: 1\nmotion: other\nkeys: [{{at_s: 0, joints: {{{joint}: 0}}}}]\n")
            refused = shoal(path, "--format", "openr", "--output", os.path.join(self.scratch.name, "other"))
            self.assertEqual(refused.returncode, 2)
            self.assertIn(error, refused.stderr)
        wag = os.path.join(os.path.dirname(MOTION), "wag.yaml")
        ears = shoal(wag, "--format", "openr", "--output", os.path.join(self.scratch.name, "wag"))
        self.assertIn("the object does not move the ears, which are solenoids: ear_l, ear_r", ears.stderr)


if __name__ == "__main__":
    unittest.main()
