#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Tests of examples/ubersim_client/ubersim_client.py: programs that add their robot to a run, balance it and leave."""
import os
import re
import subprocess
import sys
import unittest

from support import BINARY_DIR, ROOT, ShoalRun, run_python, scratch

import shoal

EXAMPLE = os.path.join(ROOT, 'examples', 'ubersim_client')
IN_PYTHON = [sys.executable, os.path.join(EXAMPLE, 'ubersim_client.py')]
IN_CPP = [os.path.join(BINARY_DIR, 'bin', 'ubersim_client')]
XML = os.path.join(EXAMPLE, 'segway.xml')
EMPTY = ('shoal: 1\nname: empty\nphysics: {step_s: 0.005}\nlockstep: {timeout_s: 60, join_timeout_s: 60}\n'
         'objects: [{name: ground, fixed: true, parts: [{shape: plane}]}]\n')


def start(program, *options):
    return subprocess.Popen([*program, XML, *options], stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)


class UbersimClientTest(unittest.TestCase):

    def setUp(self):
        with open(scratch('empty.yaml'), 'w', encoding='utf-8') as file:
            file.write(EMPTY)

    def run_of_two(self, program):
        """Returns the run hash of two robots that add themselves and leave."""
        names = ['left', 'right']
        with ShoalRun(scratch('empty.yaml'), '--duration', '1', *(f'--await={name}' for name in names)) as run:
            clients = [start(program, '--name', name, '--position', '0', str(2 * i), '--seconds', '0.5', '--width', '16')
                       for i, name in enumerate(names)]
            for client in clients:
                out, errors = client.communicate(timeout=240)
                self.assertEqual((client.returncode, errors), (0, ''))
                self.assertRegex(out, 'images of 16x12, end: left')
            code, printed = run.wait()
        self.assertEqual(code, 0, printed)
        return re.search(r'run hash (\w{16})', printed)[1]

    def test_balances_sees_moves_and_leaves(self):
        with ShoalRun(scratch('empty.yaml'), '--duration', '12.5', '--await', 'cmu') as run:
            client = start(IN_PYTHON, '--tilt', '3', '--width', '64')
            out, errors = client.communicate(timeout=240)
            code, printed = run.wait()
        self.assertEqual((client.returncode, errors, code), (0, '', 0), printed)
        found = re.fullmatch(r'cmu: tilt (-?[\d.]+) deg, balanced at (-?[\d.]+) deg, (-?[\d.]+) m from its start, '
                             r'(\d+) images of 64x48, end: left\n', out)
        self.assertTrue(found, out)
        # atan(0.1 m * 22.7 kg / 72.7 kg / 0.1784 m): the center of mass above the axle, as in docs/models/segway.md.
        self.assertEqual(found[2], '-9.93')
        self.assertAlmostEqual(float(found[1]), -9.93, delta=4)  # four seconds after it leaned by 3 deg
        self.assertAlmostEqual(int(found[4]), 12 * 20, delta=2)
        # The world is empty again.
        self.assertRegex(printed, "client 'cmu' left at 12.0")

    def test_is_the_same_run_each_time_and_as_in_cpp(self):
        expected = self.run_of_two(IN_PYTHON)
        self.assertEqual(self.run_of_two(IN_PYTHON), expected)
        self.assertEqual(self.run_of_two(IN_CPP), expected)

    def test_says_what_is_wrong_with_the_xml(self):
        with open(XML, encoding='utf-8') as file:
            text = file.read()
        for wrong, error in [('', 'no XML: no element found'), ('<Client>' * 50000, 'no XML: no element found'),
                             ('<!DOCTYPE a [<!ENTITY b "c">]><Client/>', 'at most 1 MB and no <!DOCTYPE>'),
                             (' ' * 2_000_000, 'at most 1 MB'), ('\0\1', 'no XML: '),
                             (text.replace('35.0', 'heavy'), "<Box> 'Platform': <Mass> must be a number from 0 to 1000"),
                             (text.replace('35.0', 'nan'), "<Box> 'Platform': <Mass> must be a number from 0 to 1000"),
                             (text.replace('"Table"', '"A}"'), '<Box> must have a name of 1 to 31 letters'),
                             (text.replace('<Fov>60.0</Fov>', ''), "<CameraSensor> 'Cam' must have one <Fov>, got 0")]:
            with open(scratch('wrong.xml'), 'w', encoding='utf-8') as file:
                file.write(wrong)
            done = subprocess.run([*IN_PYTHON, scratch('wrong.xml')], capture_output=True, text=True, check=False)
            self.assertEqual(done.returncode, 1)
            self.assertIn(error, done.stderr)
            self.assertEqual(done.stderr.count('\n'), 1, done.stderr)

    def test_the_programs_of_the_page_run(self):
        with open(os.path.join(ROOT, 'docs', 'guides', 'spawn_vehicles.md'), encoding='utf-8') as file:
            page = file.read()
        with open(scratch('empty.yaml'), 'w', encoding='utf-8') as file:
            file.write(re.search(r'```yaml\n(shoal: 1\nname: empty\n.*?)```', page, re.S)[1])
        with ShoalRun(scratch('empty.yaml'), '--duration', '3', '--await', 'guest') as run:
            code, out, errors = run_python(re.search(r'```python\n(.*?)```', page, re.S)[1])
            self.assertEqual((code, errors), (0, ''))
            self.assertRegex(out, r'turned at -?0\.\d+ rad/s, end: left')
            code, printed = run.wait()
        self.assertEqual(code, 0, printed)
        self.assertRegex(printed, r"client 'guest' left at 2\.1")

    def test_spawn_says_why_it_is_refused(self):
        with ShoalRun(scratch('empty.yaml'), '--duration', '1', '--await', 'pilot') as run:
            with shoal.Client('pilot') as client:
                with self.assertRaisesRegex(shoal.Error, 'join.. comes before spawn'):
                    client.spawn('{name: guest}')
                client.join(0.1)
                for wrong, error in [({'nme': 'guest'}, "(?s)'pilot': .*spawn:1:2: unknown key 'nme'"),
                                     ('{name: guest, file: none.yaml}', "there is no vehicle file 'none.yaml'")]:
                    with self.assertRaisesRegex(shoal.Error, error):
                        client.spawn(wrong)
                channels = client.spawn({'name': 'guest', 'file': 'pioneer.yaml', 'with_client': True})
                self.assertEqual(channels['imu'].report_type, 'shoal.imu_t')
                self.assertEqual((channels['imu'].reports, channels['imu'].rate_hz), ('guest.imu', 100))
                self.assertEqual(channels['drive'].commands, 'guest.drive.cmd')
                self.assertEqual(channels['drive'].reports, '')
                client.next_tick()
                client.leave()
                self.assertEqual((client.end, client.next_tick()), ('left', None))
            code, printed = run.wait()
        self.assertEqual(code, 0, printed)
        for wrong in [None, 5]:
            with self.assertRaises(TypeError):
                shoal.Client('pilot').spawn(wrong)


if __name__ == '__main__':
    unittest.main()
