"""examples/python/coop_auv.py beside the programs of worlds/coop_underwater.yaml, as docs/howto_python.md shows it.

    python3 python_example_test.py BINARIES LCM_GEN
"""
import glob
import os
import subprocess
import sys
import tempfile
import unittest

HERE = os.path.dirname(os.path.abspath(__file__))
ROOT = os.path.join(HERE, "..", "..")
BINARIES, LCM_GEN = sys.argv[1:3]


def options_of_the_page():
    """What docs/howto_python.md writes after coop_auv.py."""
    with open(os.path.join(ROOT, "docs", "howto_python.md"), encoding="utf-8") as file:
        line = next(line for line in file if "python3 examples/python/coop_auv.py" in line)
    return line.split("coop_auv.py", 1)[1].replace("&", "").split()


class Example(unittest.TestCase):
    def test_finds_the_auv_of_the_world_as_it_is(self):
        with tempfile.TemporaryDirectory() as types:
            subprocess.run([LCM_GEN, "--python", "--ppath", types,
                            *glob.glob(os.path.join(ROOT, "bridges", "lcm", "types", "*.lcm"))], check=True)
            sys.path[:0] = [types, os.path.join(ROOT, "examples", "python")]
            sys.path.append(os.path.join(HERE, "python"))  # after a real lcm, where there is one
            os.environ["LCM_DEFAULT_URL"] = f"udpm://239.255.76.67:{10000 + os.getpid() * 4 % 20000}?ttl=0"
            import coop_auv
            auv, bus = coop_auv.attach(coop_auv.parse(options_of_the_page()))
            with tempfile.TemporaryFile("w+") as log:
                exit_code = self.run_world(bus, log)
                log.seek(0)
                self.assertEqual(exit_code, 0, log.read())
            self.assertAlmostEqual(auv.ekf.time_s, 1767225600 + 600, delta=2)

    def run_world(self, bus, log):
        """Exit code 0: the rules below are kept.  Seeds 1 to 4 have 0.9 to 1.3 m, dead reckoning some 30 m."""
        run = subprocess.Popen(
            [os.path.join(BINARIES, "shoal"), "run", os.path.join(ROOT, "worlds", "coop_underwater.yaml"),
             "--launch", "--await", "auv_python", "--duration", "600",
             "--set", "metrics=[{name: python, vehicle: auv, channel: auv.python_estimate, from_s: 120}]",
             "--set", "pass=[{metric: python.rms_m, below: 5}, {metric: python.samples, above: 900}]"],
            stdout=log, stderr=subprocess.STDOUT)
        try:
            bus.run()
            return run.wait(60)
        finally:
            run.kill()
            run.wait()


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1])
