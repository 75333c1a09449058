# SPDX-License-Identifier: BSD-3-Clause
"""The programs of examples/python, in runs: coop_auv.py as docs/guides/python_auv.md shows it, lockstep_client.py.

    python3 python_example_test.py BINARIES LCM_GEN [PACKAGES]

PACKAGES: folder with the Python package; its message classes are then used instead of those of lcm-gen
"""
import glob
import json
import os
import random
import shutil
import subprocess
import sys
import tempfile
import unittest
from unittest import mock

HERE = os.path.dirname(os.path.abspath(__file__))
ROOT = os.path.join(HERE, "..", "..")
BINARIES, LCM_GEN, *PACKAGES = sys.argv[1:]
sys.path.insert(0, os.path.join(ROOT, "tests"))

from own_ports import end_with_parent, own_url  # noqa: E402


def options_of_the_page():
    """What docs/guides/python_auv.md writes after coop_auv.py."""
    with open(os.path.join(ROOT, "docs", "guides", "python_auv.md"), encoding="utf-8") as file:
        line = next(line for line in file if "python3 examples/python/coop_auv.py" in line)
    return line.split("coop_auv.py", 1)[1].replace("&", "").split()


def prepare():
    """The message types of this tree and a bus of the test's own; once, before the examples are imported."""
    types = tempfile.TemporaryDirectory()
    os.environ["LCM_DEFAULT_URL"] = own_url()
    if PACKAGES:
        sys.path[:0] = [*PACKAGES, os.path.join(ROOT, "examples", "python")]
        return types
    subprocess.run([LCM_GEN, "--python", "--ppath", types.name,
                    *glob.glob(os.path.join(ROOT, "messages", "*", "*.lcm"))], check=True)
    sys.path[:0] = [types.name, os.path.join(ROOT, "examples", "python")]
    return types


class Example(unittest.TestCase):
    def test_finds_the_auv_of_the_world_as_it_is(self):
        import coop_auv
        auv, bus = coop_auv.attach(coop_auv.parse(options_of_the_page()))
        # Exit code 0: the rules are kept.  The rms error is some 1 m, that of dead reckoning some 30 m.
        self.run_world(bus, "coop_underwater.yaml", "--launch", "--await", "auv_python", "--duration", "600",
                       "--set", "metrics=[{name: python, type: position_error, vehicle: auv, "
                       "channel: auv.python_estimate, from_s: 120}]",
                       "--set", "pass=[python.rms_m < 5, python.samples > 900]")
        self.assertAlmostEqual(auv.ekf.time_s, 1767225600 + 600, delta=2)

    def test_drives_to_the_wall_though_messages_are_lost(self):
        import lockstep_client
        pilot = lockstep_client.Pilot("rover1")
        self.run_world(pilot.client, "minimal.yaml", "--await", "pilot", "--duration", "15", "--speed", "max")
        undisturbed = pilot.ahead_m
        self.assertLess(undisturbed, 1.1)
        self.assertGreater(undisturbed, 0.5)
        lossy = lockstep_client.Pilot("rover1")
        lose(lossy.client.lc)
        self.run_world(lossy.client, "minimal.yaml", "--await", "pilot", "--duration", "15", "--speed", "max")
        self.assertEqual(lossy.ahead_m, undisturbed)

    def test_signs_where_a_run_is_controlled_with_its_key(self):
        import lockstep_client
        pilot = lockstep_client.Pilot("rover1")
        options = ["minimal.yaml", "--await", "pilot", "--duration", "15", "--speed", "max"]
        self.run_world(pilot.client, *options)
        with tempfile.TemporaryDirectory() as results:
            key_file = os.path.join(results, "run.key")

            def keyed_pilot():
                with open(key_file, encoding="ascii") as file, mock.patch.dict(
                        os.environ, {"SHOAL_RUN_KEY": file.read().strip()}):
                    return lockstep_client.Pilot("rover1")

            keyed = self.run_world(keyed_pilot, *options, "--control-key", "--results", results, "--no-plots",
                                   wait_for=key_file)
            with open(os.path.join(results, "summary.json"), encoding="utf-8") as file:
                control = json.load(file)["control"]
            self.assertFalse(os.path.exists(key_file))
        self.assertEqual(keyed.ahead_m, pilot.ahead_m)
        self.assertTrue(control["needs_key"])
        self.assertEqual(control["refused_requests"], 0)

    def test_is_refused_where_it_has_no_key(self):
        import lockstep_client
        pilot = lockstep_client.Pilot("rover1")
        with self.assertRaisesRegex(SystemExit, "can only be controlled with its key"):
            self.run_world(pilot.client, "minimal.yaml", "--await", "pilot", "--control-key")

    @unittest.skipUnless(shutil.which("javac"), "there is no Java compiler")
    def test_java_client_compiles(self):
        with tempfile.TemporaryDirectory() as folder:
            subprocess.run([LCM_GEN, "--java", "--jpath", folder,
                            *glob.glob(os.path.join(ROOT, "messages", "*", "*.lcm"))], check=True)
            done = subprocess.run(["javac", "-d", os.path.join(folder, "classes"), "-sourcepath",
                                   os.path.join(HERE, "java") + os.pathsep + folder,
                                   os.path.join(ROOT, "examples", "java", "LockstepClient.java")],
                                  capture_output=True, text=True)
            self.assertEqual(done.returncode, 0, done.stderr)

    def test_python_client_ignores_replies_to_another_of_its_name(self):
        import lockstep_client
        import shoal
        client = lockstep_client.Pilot("rover1").client
        refusal = shoal.sim_control_reply_t()
        refusal.id, refusal.client, refusal.session, refusal.ok = client.id, "pilot", client.session + 1, False
        client.on_reply("sim.control.reply", refusal.encode())
        self.assertFalse(client.joined)
        grant = shoal.sim_control_reply_t()
        grant.id, grant.client, grant.session, grant.ok = client.id, "pilot", client.session, True
        client.on_reply("sim.control.reply", grant.encode())
        self.assertTrue(client.joined)
        client.on_reply("sim.control.reply", refusal.encode())
        refusal.session = client.session
        with self.assertRaises(SystemExit):
            client.on_reply("sim.control.reply", refusal.encode())

    def test_python_client_leaves_a_tick_that_lacks_messages_for_a_later_one(self):
        import lockstep_client
        import shoal
        client = lockstep_client.Pilot("rover1").client

        def tick(sequence, crcs):
            due = shoal.sim_due_t()
            due.name, due.session, due.sequence = "pilot", client.session, sequence
            due.count, due.channel, due.crc = len(crcs), [0] * len(crcs), crcs
            message = shoal.sim_tick_t()
            message.count, message.client = 1, [due]
            client.on_tick("sim.tick", message.encode())

        tick(1, [12345])
        self.assertFalse(client.has_all())
        tick(2, [])
        self.assertTrue(client.has_all())
        client.handle()
        self.assertEqual(client.ack.sequence, 2)
        tick(1, [12345])  # late
        self.assertIsNone(client.tick)

    def test_says_after_three_seconds_what_it_waits_for(self):
        waiting = subprocess.Popen([sys.executable, os.path.join(ROOT, "examples", "python", "lockstep_client.py")],
                                   text=True, env=dict(os.environ, PYTHONPATH=sys.path[0]), stderr=subprocess.PIPE)
        try:
            self.assertIn("'pilot' waits for a simulator to answer its join on 'sim.control.reply', at udpm://",
                          waiting.stderr.readline())
        finally:
            waiting.kill()
            waiting.communicate()

    def test_python_client_ignores_what_is_no_message(self):
        import lockstep_client
        client = lockstep_client.Pilot("rover1").client
        for channel, handler in client.protocol.items():
            client.only_valid(handler)(channel, b"no message")

    def run_world(self, client, world, *options, wait_for=None):
        """`client`, or a function that makes its pilot once the file `wait_for` is there."""
        with tempfile.TemporaryFile("w+") as log:
            run = subprocess.Popen([os.path.join(BINARIES, "shoal"), "run", os.path.join(ROOT, "worlds", world),
                                    *options], stdout=log, stderr=subprocess.STDOUT,
                                   preexec_fn=end_with_parent)
            pilot = None
            try:
                while wait_for and not (os.path.exists(wait_for) and os.path.getsize(wait_for)):
                    self.assertIsNone(run.poll())
                if wait_for:
                    pilot = client()
                    client = pilot.client
                client.run()
                exit_code = run.wait(240)
            finally:
                run.kill()
                run.wait()
            log.seek(0)
            self.assertEqual(exit_code, 0, log.read())
        return pilot


def lose(lc):
    """Every tenth message that is sent, and every tenth that comes, gets lost."""
    dice, publish = random.Random(1), lc.publish
    lc.publish = lambda channel, data: None if dice.random() < 0.1 else publish(channel, data)
    lc.handlers = [(pattern, lambda channel, data, handler=handler:
                    None if dice.random() < 0.1 else handler(channel, data)) for pattern, handler in lc.handlers]


if __name__ == "__main__":
    TYPES = prepare()
    unittest.main(argv=sys.argv[:1])
