#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Runs an example of examples/python with short settings, as a script; each ends in an image.

    examples_test.py first_run
"""
import os
import re
import subprocess
import sys
import unittest

from support import ROOT, SCRATCH, SHOAL, scratch

NAME = sys.argv.pop(1)
SHORT = {'SECONDS': '40', 'RUNS': '6', 'WORLDS': '4', 'STEPS': '120'}
# What each must find, as a pattern of its output; the numbers are within what any seed gives.
EXPECTED = {
    'first_run': r'after 12 s at \[ ?4\.0',
    'own_client': r'run hash \w{16}',
    'read_record': r'\n400 estimates, [1-9]\d* packets received',
    'allan_deviation': r'adis16470: angular random walk 0\.3\d+ deg/sqrt\(h\)',  # the data sheet: 0.34
    'random_policy': r'\d+ episodes, mean return -?\d',
    'dead_reckoning': r'after 40 s: rms error 0\.[0-9]+ m',
    'range_only_filter': r'rms error 0\.[01]\d+ m',
    'slurm_sweep': r'cooperative\.rms_m: median [0-9.]+ m at 0, ',
}


class ExampleTest(unittest.TestCase):

    def test_ends_in_an_image(self):
        with open(os.path.join(ROOT, 'examples', 'python', NAME + '.py'), encoding='utf-8') as file:
            text = file.read()
        self.assertTrue(re.search(r'^# %% \[markdown\]$', text, re.M))
        done = subprocess.run([sys.executable, os.path.join(ROOT, 'examples', 'python', NAME + '.py')], cwd=SCRATCH,
                              env={**os.environ, **SHORT, 'PATH': os.path.dirname(SHOAL) + ':' + os.environ['PATH']}, capture_output=True, text=True, check=False)
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertRegex(done.stdout, EXPECTED[NAME])
        with open(scratch(NAME + '.png'), 'rb') as file:
            self.assertEqual(file.read(8), b'\x89PNG\r\n\x1a\n')


if __name__ == '__main__':
    unittest.main()
