#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Exported motions, played by independent players of the other programs, command the same set points as the motion.

correspondence_test.py BIN: BIN has the program shoal.  The players are in players/; they are written from descriptions
of the formats and share no code with the exporter.  Set points are those of the keys, computed here, and in the last
test those of a motion_player in a world."""
import csv
import io
import math
import os
import random
import re
import subprocess
import sys
import tempfile
import unittest

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))

from players import sony_player, tekkotsu_player, webots_player  # noqa: E402

URAD = 1e-6
FRAME_MS = 8
BIN = os.path.abspath(sys.argv.pop(1) if len(sys.argv) > 1 else "build/release/bin")
EASING = {"linear": lambda s: s, "cosine": lambda s: (1 - math.cos(math.pi * s)) / 2, "smooth": lambda s: s * s * (3 - 2 * s)}
JOINTS = ["hip", "knee", "ankle"]


ROOT = os.path.abspath(os.path.join(os.path.dirname(__file__), *[".."] * 3))


def names_of_ers7(list_name):
    """Names of the joints in other programs, as in the file of the ERS-7."""
    with open(os.path.join(ROOT, "vehicles", "joint_names", "ers7.yaml")) as file:
        part = file.read().split(f"- list: {list_name}\n")[1].split("- list:")[0]
    return {joint: name.strip('"') for joint, name in re.findall(r"^      (\w+): (\S+)$", part, re.MULTILINE)}


class Motion:
    """Keys of each joint: [(time in ms, value in rad, easing)]."""

    def __init__(self, seed, tick_ms, easings):
        draw = random.Random(seed)
        self.keys = {}
        end_ms = tick_ms * draw.randrange(40, 120)
        for joint in JOINTS:
            times = sorted(draw.sample(range(1, end_ms // tick_ms), draw.randrange(2, 9)))
            self.keys[joint] = [(time * tick_ms, draw.uniform(-2, 2), draw.choice(easings)) for time in [0, *times, end_ms // tick_ms]]
        self.end_ms = end_ms

    def text(self, loop=False):
        times = sorted({time for keys in self.keys.values() for time, _, _ in keys})
        lines = ["shoal: 1", "motion: wave", "angles: rad", "start: {max_velocity: 5, min_s: 0.4}", f"loop: {str(loop).lower()}", "keys:"]
        for time in times:
            eases = {}
            for joint, keys in self.keys.items():
                for at, value, ease in keys:
                    if at == time:
                        eases.setdefault(ease, []).append(f"{joint}: {value!r}")
            assert len(eases) == 1 or time == 0 or len(set(eases)) == 1, "a key has one easing"
            joined = ", ".join(value for values in eases.values() for value in values)
            lines.append(f"  - {{at_s: {time / 1000!r}, joints: {{{joined}}}, ease: {next(iter(eases))}}}")
        return "\n".join(lines) + "\n"

    def close_loop(self):
        for joint, keys in self.keys.items():
            time, _, ease = keys[-1]
            keys[-1] = (time, keys[0][1], ease)

    def one_easing_each_time(self):
        chosen = {}
        for joint, keys in self.keys.items():
            self.keys[joint] = [(time, value, chosen.setdefault(time, ease)) for time, value, ease in keys]
        return self

    def value_at(self, joint, time_ms):
        keys = self.keys[joint]
        for (from_ms, before, _), (to_ms, after, ease) in zip(keys, keys[1:]):
            if from_ms <= time_ms < to_ms:
                return before + EASING[ease]((time_ms - from_ms) / (to_ms - from_ms)) * (after - before)
        return keys[-1][1]


def motions(count, tick_ms, easings=("linear", "cosine", "smooth")):
    return [Motion(seed, tick_ms, easings).one_easing_each_time() for seed in range(count)]


class Correspondence(unittest.TestCase):
    def setUp(self):
        self.folder = tempfile.TemporaryDirectory()
        self.addCleanup(self.folder.cleanup)

    def path(self, name):
        return os.path.join(self.folder.name, name)

    def shoal(self, *arguments, binary=False):
        ran = subprocess.run([os.path.join(BIN, "shoal"), *arguments], capture_output=True, cwd=self.folder.name)
        self.assertEqual(ran.returncode, 0, ran.stderr.decode())
        return ran.stdout if binary else ran.stdout.decode()

    def exported(self, text, name, *options):
        with open(self.path("wave.yaml"), "w") as file:
            file.write(text)
        self.shoal("motion", "export", "wave.yaml", "--overwrite", "--output", name, *options)
        with open(self.path(name), "rb") as file:
            return file.read()

    def test_webots_commands_the_set_points_at_each_control_step(self):
        for motion in motions(20, FRAME_MS):
            text = self.exported(motion.text(), "wave.motion").decode()
            for step_ms in (8, 16, 32):
                names, commands = webots_player.play(text, step_ms)
                self.assertEqual(names, JOINTS)
                # The last command is that of the step in which the motion ends.
                self.assertEqual((len(commands) - 1) * step_ms, math.ceil(motion.end_ms / step_ms) * step_ms)
                for number, command in enumerate(commands):
                    for joint, value in zip(names, command):
                        self.assertAlmostEqual(value, motion.value_at(joint, number * step_ms), delta=URAD)

    def test_webots_repeats_a_loop_in_its_period(self):
        for motion in motions(10, 32):
            motion.close_loop()
            for step_ms in (8, 16, 32):
                text = self.exported(motion.text(loop=True), "wave.motion", "--loop-step-ms", str(step_ms)).decode()
                period = motion.end_ms // step_ms
                names, commands = webots_player.play(text, step_ms, loop_steps=2 * period + 3)
                for number, command in enumerate(commands):
                    for joint, value in zip(names, command):
                        self.assertAlmostEqual(value, motion.value_at(joint, number % period * step_ms), delta=URAD)

    def test_sony_sends_the_set_points_but_the_last(self):
        for motion in motions(20, 16, ["linear"]):
            names, frames = sony_player.play(self.exported(motion.text(), "wave.mtn"))
            self.assertEqual(names, JOINTS)
            # The last key is not sent: the last frame is one before the end.
            self.assertEqual((len(frames) - 1) * FRAME_MS, motion.end_ms - FRAME_MS)
            for number, (values, between) in enumerate(frames):
                for joint, value in zip(names, values):
                    allowed = (2 * between + 2) * URAD
                    self.assertAlmostEqual(value * URAD, motion.value_at(joint, number * FRAME_MS), delta=allowed)

    def test_tekkotsu_commands_the_set_points_after_the_approach(self):
        approach_ms = 400
        for motion in motions(20, FRAME_MS):
            text = self.exported(motion.text(), "wave.mot").decode()
            for step_ms in (8, 16, 32):
                posture = {joint: 0.1 for joint in JOINTS}
                played = tekkotsu_player.play(text, step_ms, posture)
                self.assertEqual(played[-1][0], approach_ms + motion.end_ms)
                for joint, (value, weight) in played[0][1].items():
                    self.assertEqual((value, weight), (0.1, 0.0), "the approach starts at the posture")
                for time_ms, outputs in played:
                    if time_ms < approach_ms:
                        continue
                    for joint in JOINTS:
                        value, weight = outputs[joint]
                        self.assertEqual(weight, 1.0)
                        self.assertAlmostEqual(value, motion.value_at(joint, time_ms - approach_ms), delta=URAD)

    def test_the_c_table_has_the_set_points_of_all_frames(self):
        for motion in motions(5, FRAME_MS):
            text = self.exported(motion.text(), "wave.h").decode()
            self.assertEqual(re.findall(r'"(.*)"', text), JOINTS)
            rows = re.findall(r"\{(-?\d+(?:, -?\d+)*)\}", text)
            count = int(re.search(r"#define WAVE_FRAMES (\d+)", text).group(1))
            self.assertEqual((count - 1) * FRAME_MS, motion.end_ms)
            self.assertEqual(len(rows), math.ceil(count / 4) * 4)
            for number, row in enumerate(rows):
                for joint, value in zip(JOINTS, row.split(", ")):
                    expected = motion.value_at(joint, min(number, count - 1) * FRAME_MS)
                    self.assertAlmostEqual(int(value) * URAD, expected, delta=URAD)

    def test_files_that_are_read_again_are_the_same_motion(self):
        for motion in motions(3, 16, ["linear"]):
            for name in ("again.csv", "again.trajectory.yaml", "again.play_motion2.yaml", "again.motion", "again.mtn", "again.mot"):
                self.exported(motion.text(), name)
                self.shoal("motion", "import", name, "--overwrite", "--output", "read.yaml")
                rows = list(csv.reader(io.StringIO(self.shoal("motion", "show", "read.yaml", "--frames"))))
                for row in rows[1:]:
                    for joint, value in zip(rows[0][1:], row[1:]):
                        self.assertAlmostEqual(float(value), motion.value_at(joint, round(float(row[0]) * 1000)), delta=URAD)
                self.assertEqual(round(float(rows[-1][0]) * 1000), motion.end_ms, name)

    def frames_of(self, path):
        """Joints and set points of a motion file at its frames, by shoal."""
        rows = list(csv.reader(io.StringIO(self.shoal("motion", "show", path, "--frames"))))
        return rows[0][1:], [[float(word) for word in row[1:]] for row in rows[1:]]

    def test_shipped_motions_of_the_ers7(self):
        prm, outputs = names_of_ers7("open-r"), names_of_ers7("tekkotsu")
        folder = os.path.join(ROOT, "vehicles", "motions", "ers7")
        motions_of_ers7 = sorted(name for name in os.listdir(folder) if name.endswith(".yaml"))
        self.assertTrue(motions_of_ers7)
        for file in motions_of_ers7:
            path = os.path.join(folder, file)
            joints, frames = self.frames_of(path)

            def check(frame, names, values):
                for joint, expected in zip(joints, frames[frame]):
                    if joint in names and names[joint] in values:
                        self.assertAlmostEqual(values[names[joint]], expected, delta=URAD, msg=f"{file} {joint} frame {frame}")

            for name in ("ers7.motion", "ers7.mot", "ers7.mtn"):
                self.shoal("motion", "export", path, "--overwrite", "--vehicle", "ers7", "--output", name)
            with open(self.path("ers7.motion")) as exported:
                devices, commands = webots_player.play(exported.read(), FRAME_MS)
            self.assertLessEqual({prm[joint] for joint in joints}, set(devices))
            self.assertLessEqual(abs(len(commands) - len(frames)), 1)
            for frame, command in enumerate(commands[:len(frames)]):
                check(frame, prm, dict(zip(devices, command)))
            with open(self.path("ers7.mot")) as exported:
                of_outputs = tekkotsu_player.parse(exported.read())
            start_ms = min(min(keys) for keys in of_outputs.values())
            for frame in range(len(frames)):
                check(frame, outputs, {name: tekkotsu_player.value_at(keys, 0.0, start_ms + frame * FRAME_MS)[0]
                                       for name, keys in of_outputs.items()})
            with open(self.path("ers7.mtn"), "rb") as exported:
                read = sony_player.parse(exported.read())
            self.assertEqual(read["locators"], list(prm.values()), "all joints, in the order of the sample player")

    def test_a_player_in_a_world_has_the_same_set_points(self):
        """The exported file against the set points of a joint_group in a record of a run."""
        motion = motions(1, 16, ["linear"])[0]
        text = self.exported(motion.text(), "wave.motion").decode()
        mtn = self.exported(motion.text(), "wave.mtn")
        with open(self.path("leg.yaml"), "w") as file:
            file.write(WORLD)
        self.shoal("run", "leg.yaml", "--bus", "none", "--speed", "max", "--record", "run.log", "--quiet",
                   "--duration", str(motion.end_ms / 1000 + 1))
        rows = list(csv.DictReader(io.StringIO(self.shoal("log", "csv", "run.log", "leg.group"))))
        states = list(csv.DictReader(io.StringIO(self.shoal("log", "csv", "run.log", "leg.player"))))
        columns = {joint: number for number, joint in enumerate(JOINTS)}
        names, commands = webots_player.play(text, FRAME_MS)
        _, frames = sony_player.play(mtn)
        compared = 0
        # Servos that stand before the player take its command in the next step.
        for row, state in zip(rows[1:], states):
            self.assertEqual(int(row["utime"]), int(state["utime"]) + FRAME_MS * 1000)
            if int(state["phase"]) != 2:
                continue
            frame = round(float(state["at_s"]) * 1000 / FRAME_MS)
            self.assertAlmostEqual(float(state["at_s"]) * 1000, frame * FRAME_MS, delta=1e-6)
            for number, joint in enumerate(names):
                set_point = float(row[f"set_point[{columns[joint]}]"])
                self.assertAlmostEqual(commands[frame][number], set_point, delta=URAD)
                if frame < len(frames):
                    self.assertAlmostEqual(frames[frame][0][number] * URAD, set_point, delta=(2 * frames[frame][1] + 2) * URAD)
            compared += 1
        # Every frame but the first, before the run, and the last, after which the player is idle.
        self.assertGreaterEqual(compared, motion.end_ms // FRAME_MS - 2)


WORLD = """shoal: 1
physics: {step_s: 0.008, gravity_mps2: 0}
vehicles:
  - name: leg
    model:
      shoal: 1
      vehicle: leg
      bodies:
        - {name: thigh, position_m: [0, 0, 1], parts: [{shape: sphere, radius_m: 0.05, mass_kg: 0.2}]}
        - {name: shin, position_m: [0, 0, 0.8], parts: [{shape: sphere, radius_m: 0.05, mass_kg: 0.1}]}
        - {name: foot, position_m: [0, 0, 0.6], parts: [{shape: sphere, radius_m: 0.05, mass_kg: 0.1}]}
      joints:
        - {name: hip, type: hinge, bodies: [thigh, world], anchor_m: [0, 0, 1.2], axis: [0, 1, 0]}
        - {name: knee, type: hinge, bodies: [shin, thigh], anchor_m: [0, 0, 0.9], axis: [0, 1, 0]}
        - {name: ankle, type: hinge, bodies: [foot, shin], anchor_m: [0, 0, 0.7], axis: [0, 1, 0]}
      devices:
        - {name: hip, type: joint_servo, joint: hip, max_velocity: 1000, max_effort: 100, kp: 100}
        - {name: knee, type: joint_servo, joint: knee, max_velocity: 1000, max_effort: 100, kp: 100}
        - {name: ankle, type: joint_servo, joint: ankle, max_velocity: 1000, max_effort: 100, kp: 100}
        - {name: group, type: joint_group, rate_hz: 125}
        - {name: player, type: motion_player, group: group, rate_hz: 125, motions: [{file: wave.yaml}],
           play: {motion: wave, skip_approach: true}}
"""

if __name__ == "__main__":
    unittest.main()
