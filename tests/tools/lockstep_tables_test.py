# SPDX-License-Identifier: BSD-3-Clause
"""tools/lockstep_tables.py, with the shortest of its tables.

    python3 lockstep_tables_test.py BINARIES
"""
import os
import subprocess
import sys
import unittest

ROOT = os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "..")
BINARIES = sys.argv.pop()


def table(*options):
    """Exit code, and the cells of each row."""
    tool, world = os.path.join(ROOT, "tools", "lockstep_tables.py"), os.path.join(ROOT, "worlds", "coop_land.yaml")
    done = subprocess.run([sys.executable, tool, *options, "--bin", BINARIES, "--world", world],
                          stdout=subprocess.PIPE, text=True, check=False)
    lines = done.stdout.splitlines()[2:]
    return done.returncode, [[cell.strip() for cell in line.strip("|").split("|")] for line in lines]


class Tables(unittest.TestCase):
    def test_hashes_do_not_depend_on_threads_and_clients_that_are_stopped(self):
        code, rows = table("hashes", "--speeds", "max", "--threads", "1,2", "--duration", "3")
        self.assertEqual(code, 0, rows)
        clients = ["as they are", "stopped at random"]
        self.assertEqual([row[1:3] for row in rows], [[threads, how] for threads in "12" for how in clients])
        self.assertRegex(rows[0][4], "^[0-9a-f]{16}$")
        self.assertEqual(len({row[4] for row in rows}), 1)

    def test_a_client_that_is_stalled_changes_nothing_when_the_world_waits_for_it(self):
        _, undisturbed = table("hashes", "--speeds", "max", "--threads", "1", "--duration", "3")
        code, (killed, stalled) = table("killed", "--policies", "wait", "--duration", "3")
        self.assertEqual(code, 0)
        self.assertIn("the world waits", killed[2])
        self.assertEqual(killed[3:6], ["leave --client rover2", "3", "1"])
        self.assertNotEqual(killed[6], undisturbed[0][4])
        self.assertEqual(stalled[3:], ["SIGCONT", "3", "0", undisturbed[0][4]])


if __name__ == "__main__":
    unittest.main()
