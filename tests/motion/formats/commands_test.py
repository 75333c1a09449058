#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Tests the commands `shoal motion export` and `import`: commands_test.py BIN."""
import os
import subprocess
import sys
import tempfile
import unittest

BIN = os.path.abspath(sys.argv.pop(1) if len(sys.argv) > 1 else "build/release/bin")
LOOP = """shoal: 1
motion: sway
vehicle: ers7
loop: true
keys:
  - {at_s: 0, joints: {lf_knee: 30, "PRM:/r1/c1/c2-Joint2:12": 0}, note: start}
  - {at_s: 0.32, joints: {lf_knee: 40, "PRM:/r1/c1/c2-Joint2:12": 20}}
  - {at_s: 0.64, joints: {lf_knee: 30, "PRM:/r1/c1/c2-Joint2:12": 0}}
"""


class Commands(unittest.TestCase):
    def setUp(self):
        self.folder = tempfile.TemporaryDirectory()
        self.addCleanup(self.folder.cleanup)
        self.write("sway.yaml", LOOP)

    def path(self, name):
        return os.path.join(self.folder.name, name)

    def write(self, name, text):
        with open(self.path(name), "w") as file:
            file.write(text)

    def text(self, name):
        with open(self.path(name)) as file:
            return file.read()

    def motion(self, *arguments, code=0):
        ran = subprocess.run([os.path.join(BIN, "shoal"), "motion", *arguments], capture_output=True, text=True,
                             cwd=self.folder.name)
        self.assertEqual(ran.returncode, code, ran.stderr)
        return ran

    def test_losses_are_printed_and_an_error_with_strict(self):
        ran = self.motion("export", "sway.yaml", "--format", "ros", "--output", "sway.ros", "--strict", code=1)
        self.assertEqual(ran.stderr.splitlines(), [
            "sway.yaml: 1 note of keys are not kept",
            "sway.yaml: one cycle of the loop is written: the player of the file repeats it",
            "sway.yaml: nothing is written, because of --strict"])
        self.assertFalse(os.path.exists(self.path("sway.ros")))
        ran = self.motion("export", "sway.yaml", "--format", "ros", "--output", "sway.ros")
        self.assertEqual(len(ran.stderr.splitlines()), 2)
        self.assertIn("joint_names: [lf_knee, head_pan]", self.text("sway.ros"))

    def test_the_vehicle_that_the_motion_names_gives_names_of_joints(self):
        self.motion("export", "sway.yaml", "--output", "sway.motion", "--loop-step-ms", "32", "--strict")
        self.assertIn(",PRM:/r2/c1/c2/c3-Joint2:23,PRM:/r1/c1/c2-Joint2:12\n", self.text("sway.motion"))
        self.motion("export", "sway.yaml", "--output", "kept.motion", "--keep-names")
        self.assertIn(",lf_knee,PRM:/r1/c1/c2-Joint2:12\n", self.text("kept.motion"))
        self.motion("import", "sway.motion", "--vehicle", "ers7", "--loop-step-ms", "32", "--output", "again.yaml", "--strict")
        again = self.text("again.yaml")
        self.assertIn("loop: true", again)
        self.assertIn("at_s: 0.64, joints: {lf_knee: 0.523599, head_pan: 0}", again)
        self.assertIn("note: start", again)

    def test_an_mtn_file_of_the_ers7_has_all_its_joints_within_their_limits(self):
        ran = self.motion("export", "sway.yaml", "--output", "sway.mtn")
        self.assertIn("joints that the motion does not name stay at rest: neck_tilt", ran.stderr)
        self.motion("import", "sway.mtn", "--vehicle", "ers7", "--output", "all.yaml", "--strict")
        self.motion("check", "all.yaml")

    def test_lights_go_to_tekkotsu_and_back_and_are_shown_checked_mirrored_and_played(self):
        self.write("glow.yaml", """shoal: 1
motion: glow
vehicle: ers7
lights: [face_a, back_rear_color]
keys:
  - {at_s: 0, joints: {head_nod: 0, face_a: 0, back_rear_color: 0.5}}
  - {at_s: 1, joints: {head_nod: 20, face_a: 1}}
sounds: [{at_s: 0.5, sound: bark}]
""")
        ran = self.motion("export", "glow.yaml", "--output", "glow.mot")
        self.assertIn("glow.yaml: 1 sound is not kept", ran.stderr)
        self.assertIn("LED:faceA\t1.000000", self.text("glow.mot"))
        self.motion("import", "glow.mot", "--vehicle", "ers7", "--output", "again.yaml", "--strict")
        again = self.text("again.yaml")
        self.assertIn("lights: [face_a, back_rear_color]", again)
        self.assertIn("at_s: 1, joints: {head_nod: 0.349066, face_a: 1", again)
        ran = self.motion("export", "glow.yaml", "--output", "glow.mtn")
        self.assertIn("glow.yaml: intensities of 2 lights are not kept", ran.stderr)
        self.assertIn("1.000 s, 1 joint, 2 lights, 2 keys", self.motion("show", "glow.yaml").stdout)
        self.motion("check", "glow.yaml")
        self.motion("edit", "mirror", "glow.yaml", "--output", "other.yaml")
        self.assertIn("lights: [face_b, back_rear_color]", self.text("other.yaml"))
        self.motion("edit", "set", "glow.yaml", "--at", "0.5", "wireless=1")
        self.assertIn("lights: [face_a, back_rear_color, wireless]", self.text("glow.yaml"))
        self.motion("play", "glow.yaml", "--world", "ers7_studio")
        self.write("dark.yaml", self.text("glow.yaml").replace("sound: bark", "sound: brak"))
        ran = self.motion("check", "dark.yaml", code=1)
        self.assertIn("sound 'brak' at 0.500 s: no speaker of the vehicle has a sound of this name", ran.stdout)

    def test_existing_files_are_kept_without_overwrite(self):
        self.write("sway.csv", "mine")
        ran = self.motion("export", "sway.yaml", "--output", "sway.csv", code=2)
        self.assertIn("'sway.csv' exists; --overwrite replaces it", ran.stderr)
        self.assertEqual(self.text("sway.csv"), "mine")
        self.motion("export", "sway.yaml", "--output", "sway.csv", "--overwrite")
        self.assertEqual(self.text("sway.csv").splitlines()[0], "t_s,lf_knee,head_pan")
        self.motion("export", "sway.yaml", "--format", "csv", "--output", "sway.yaml", "--overwrite", code=2)
        self.assertEqual(self.text("sway.yaml"), LOOP)

    def test_frames_of_a_csv_file_stand_beside_the_motion(self):
        self.write("walk.csv", "t_s,lf_knee\n0,0.5\n0.008,0.6\n")
        self.motion("import", "walk.csv", "--output", "walk.yaml")
        self.assertIn('frames: "walk.csv"', self.text("walk.yaml"))
        self.motion("import", "walk.csv", "--output", "other.yaml")
        self.assertEqual(self.text("other.csv"), self.text("walk.csv"))
        self.motion("show", "other.yaml")

    def test_errors_say_where_and_what(self):
        self.write("bad.motion", "#WEBOTS_MOTION,V1.0,lf_knee\n0,p,x\n")
        ran = self.motion("import", "bad.motion", "--output", "bad.yaml", code=2)
        self.assertEqual(ran.stderr, "bad.motion:2:5: a position must be a number from -1000000 to 1000000, got 'x'\n")
        ran = self.motion("import", "none.mtn", "--output", "bad.yaml", code=4)
        self.assertIn("none.mtn: does not exist", ran.stderr)
        ran = self.motion("export", "sway.yaml", "--output", "sway.xyz", code=2)
        self.assertIn("--format: is needed, because 'sway.xyz' does not have the ending of a known format", ran.stderr)
        ran = self.motion("export", "sway.yaml", "--output", "sway.skill", code=2)
        self.assertIn("has no number from 0 to 15 in OpenCat", ran.stderr)

    def test_a_skill_of_the_bittle_is_written_and_read(self):
        self.write("greet.yaml", "shoal: 1\nmotion: greet\nvehicle: bittle\nease: cosine\nkeys:\n"
                   "  - {at_s: 0, joints: {lf_shoulder: 30, lf_knee: 30}}\n  - {at_s: 0.6, joints: {lf_shoulder: -60}}\n")
        self.motion("export", "greet.yaml", "--output", "greet.skill")
        # 90 degrees in 0.6 s are 30 steps of 20 ms: 3 degrees, or 12 quarters of one, a step.
        self.assertIn("  0, 0, 0, 0, 0, 0, 0, 0, -60, 0, 0, 0, 30, 0, 0, 0, 12, 0, 0, 0,\n", self.text("greet.skill"))
        self.motion("import", "greet.skill", "--vehicle", "bittle", "--output", "again.yaml")
        self.assertIn("at_s: 0.6", self.text("again.yaml"))


if __name__ == "__main__":
    unittest.main()
