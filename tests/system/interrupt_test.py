# SPDX-License-Identifier: BSD-3-Clause
"""Ctrl-C at random moments of a run with programs, serial ports, a record, snapshots and plots: nothing stays behind.

    python3 interrupt_test.py BINARIES [HOW_MANY [SEED]]

Needs a network with multicast.  Each moment is one run; some get a second Ctrl-C soon after the first.
"""
import os
import random
import signal
import subprocess
import sys
import tempfile
import time
import unittest

ROOT = os.path.abspath(os.path.join(os.path.dirname(__file__), "..", ".."))
BINARIES = os.path.abspath(sys.argv[1])
HOW_MANY = int(sys.argv[2]) if len(sys.argv) > 2 else 12
SEED = int(sys.argv[3]) if len(sys.argv) > 3 else 1
del sys.argv[1:]
sys.path.insert(0, os.path.join(ROOT, "tests"))

from own_ports import end_with_parent, own_url  # noqa: E402

URL = own_url()
PATIENCE_S = 200
# Files that a run may leave: what it was asked to write.
WANTED = ("world.yaml", "said", "run.lcm", "results", "tmp")


def write_world(folder):
    """The cooperative mission on land, with a pseudo-terminal and FIFOs."""
    with open(os.path.join(ROOT, "worlds", "coop_land.yaml"), encoding="utf-8") as file:
        world = file.read().replace("file: rover_", f"file: {ROOT}/vehicles/rover_")
    for rover, kind in (("rover1", "pty"), ("rover2", "fifo")):
        start = f"{{name: {rover}, file"
        serial = f"{{path: {folder}/{rover}, kind: {kind}}}"
        assert start in world
        world = world.replace(start, f"{{name: {rover}, overrides: {{devices.modem.serial: {serial}}}, file")
    with open(os.path.join(folder, "world.yaml"), "w", encoding="utf-8") as file:
        file.write(world)


def processes_of(mark):
    """Process ids and command lines of those that live and have `mark` in their environment."""
    found = []
    for pid in filter(str.isdigit, os.listdir("/proc")):
        try:
            with open(f"/proc/{pid}/environ", "rb") as environment, open(f"/proc/{pid}/cmdline", "rb") as line:
                if mark.encode() in environment.read():
                    found.append((int(pid), line.read().replace(b"\0", b" ").decode()))
        except OSError:  # it ended, or is not ours
            pass
    return found


class Attempt:
    """A run, in its own session, as a shell would start it."""

    def __init__(self, folder):
        self.folder, self.mark = folder, f"SHOAL_INTERRUPT_TEST={folder}"
        write_world(folder)
        os.mkdir(os.path.join(folder, "tmp"))
        name, value = self.mark.split("=")
        self.shown = open(os.path.join(folder, "said"), "w+", encoding="utf-8")
        self.shoal = subprocess.Popen(
            [os.path.join(BINARIES, "shoal"), "run", "world.yaml", "--launch", "--lcm-url", URL, "--duration", "5",
             "--snapshot-at", "2,4", "--record", "run.lcm", "--results", "results", "--allow-path", folder],
            cwd=folder, env={**os.environ, name: value, "TMPDIR": os.path.join(folder, "tmp")}, stdin=subprocess.DEVNULL,
            stdout=self.shown, stderr=self.shown, start_new_session=True,
            preexec_fn=end_with_parent)

    def interrupt(self):
        try:  # the group in the foreground, as a terminal does
            os.killpg(self.shoal.pid, signal.SIGINT)
        except ProcessLookupError:
            pass

    def wait(self):
        try:
            return self.shoal.wait(PATIENCE_S)
        except subprocess.TimeoutExpired:
            return "still runs"

    def left(self, timeout_s=0):
        """What stayed behind that should not have, after `timeout_s` for processes that die with their run."""
        until = time.monotonic() + timeout_s
        while processes_of(self.mark) and time.monotonic() < until:
            time.sleep(0.01)
        left = [f"process {pid}: {line}" for pid, line in processes_of(self.mark)]
        for where, folders, files in os.walk(self.folder):
            for name in folders + files:
                path = os.path.relpath(os.path.join(where, name), self.folder)
                unmatched = path.split("/")[0] not in WANTED or path.startswith("tmp/")
                if unmatched or os.path.islink(os.path.join(where, name)) or name.endswith((".part", ".lock", ".tmp")):
                    left.append(f"file {path}")
        return left

    def end(self):
        for pid, _ in processes_of(self.mark):
            os.kill(pid, signal.SIGKILL)
        self.shoal.wait()
        self.shown.seek(0)
        shown = self.shown.read()
        self.shown.close()
        return shown


class Interrupt(unittest.TestCase):
    def test_leaves_nothing_behind_at_any_moment(self):
        with tempfile.TemporaryDirectory() as folder:
            attempt = Attempt(folder)
            begin = time.monotonic()
            code, length_s = attempt.wait(), time.monotonic() - begin
            left, shown = attempt.left(), attempt.end()
            self.assertIn(code, (0, 1), shown)  # 5 s are too few for the rules of the world
            self.assertEqual(left, [])
        chance, wrong, codes = random.Random(SEED), [], {}
        for i in range(HOW_MANY):
            at_s, again_s = chance.uniform(0, 1.05 * length_s), chance.choice([None, None, 0.01, 0.1])
            with tempfile.TemporaryDirectory() as folder:
                attempt = Attempt(folder)
                time.sleep(at_s)
                attempt.interrupt()
                if again_s:
                    time.sleep(again_s)
                    attempt.interrupt()
                code = attempt.wait()
                left, shown = attempt.left(PATIENCE_S if again_s else 0), attempt.end()
            codes[code] = codes.get(code, 0) + 1
            print(f"{i}: {at_s:.2f} s: exit code {code}, {len(left)} left", flush=True)
            # A second signal that came late, on a busy machine, ends the run at once: only its processes must be gone.
            if again_s and "ended by another signal" in shown:
                left = [each for each in left if each.startswith("process")]
            # Before it catches signals it ends by this one; it may also have been over before.
            if left or code not in (130, -signal.SIGINT, 0, 1):
                wrong.append(f"{i}: {at_s:.3f} of {length_s:.3f} s, again after {again_s}: exit code {code}, {left}\n{shown}")
        print(f"{HOW_MANY} runs of {length_s:.2f} s, exit codes {codes}")
        self.assertEqual("\n".join(wrong), "")


if __name__ == "__main__":
    unittest.main()
