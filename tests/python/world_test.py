#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Tests of worlds in the process of Python."""
import json
import os
import signal
import subprocess
import threading
import unittest

import numpy as np
from support import BALL, SHOAL, run_python, scratch

import shoal

COOP_LAND = 'worlds/coop_land.yaml'


def hashes_of_program(world, duration_s, *more):
    """Hashes that `shoal run` prints for a world without programs."""
    output = subprocess.run([SHOAL, 'run', world, '--bus', 'none', '--speed', 'max', '--quiet', '--duration',
                             str(duration_s), '--results', scratch('run'), '--no-plots', *more],
                            capture_output=True, text=True, check=False)
    if output.returncode != 0:
        raise AssertionError(output.stderr)
    with open(scratch('run/summary.json'), encoding='utf-8') as file:
        summary = json.load(file)
    return summary['state_hash'], summary['run_hash']


class WorldTest(unittest.TestCase):

    def test_has_the_hashes_of_the_program(self):
        for name in ['coop_land', 'coop_underwater', 'dynamic_warehouse', 'ers7_show']:
            with self.subTest(name):
                path = f'worlds/{name}.yaml'
                world = shoal.World(path, seed=7)
                world.run_until(3)
                state, run = hashes_of_program(path, 3, '--seed', '7')
                self.assertEqual(f'{world.state_hash():016x}', state)
                self.assertEqual(f'{world.run_hash():016x}', run)

    def test_falls_as_newton_says(self):
        world = shoal.World(BALL)
        self.assertEqual(world.vehicles, ['ball'])
        self.assertEqual(world.devices('ball'), ['ball/imu'])
        world.run_until(1)
        self.assertEqual((world.step_number, world.time_s), (100, 1.0))
        self.assertEqual(world.utime, world.last('ball.imu').utime)
        state = world.state('ball')
        # The step is exact for constant gravity; air is off.
        g = 100 - state['position_m'][2]
        self.assertAlmostEqual(g, 9.80665 / 2, delta=1e-9 * g)
        self.assertAlmostEqual(state['velocity_mps'][2], -9.80665, delta=1e-3 * 9.80665)
        np.testing.assert_array_equal(state['orientation'], [1, 0, 0, 0])
        self.assertEqual(world.states().shape, (1,))

    def test_gives_messages_as_objects(self):
        world = shoal.World(BALL)
        self.assertIsNone(world.last('ball.imu'))
        imu = world.subscribe('ball.imu')
        world.step(50)
        received = imu.take()
        self.assertEqual(len(received), 50)
        self.assertIsInstance(received[0], shoal.messages.imu_t)
        self.assertEqual(world.last('ball.imu'), received[-1])
        self.assertEqual(world.channels()['ball.imu'], 'shoal.imu_t')
        self.assertEqual(imu.take(), [])

    def test_goes_back_and_branches(self):
        world = shoal.World(COOP_LAND)
        world.step(100)
        snapshot = world.snapshot()
        other = world.branch()
        world.step(200)
        ended = world.state_hash(), world.run_hash()
        world.restore(snapshot)
        self.assertEqual(world.step_number, 100)
        world.step(200)
        self.assertEqual((world.state_hash(), world.run_hash()), ended)
        other.step(200)
        self.assertEqual((other.state_hash(), other.run_hash()), ended)
        other.do({'gravity_mps2': 1.62})
        other.step(1)
        world.step(1)
        self.assertNotEqual(other.state_hash(), world.state_hash())

    def test_drops_unread_messages_of_another_future(self):
        world = shoal.World(BALL)
        imu = world.subscribe('ball.imu')
        snapshot = world.snapshot()
        world.step(10)
        world.restore(snapshot)
        self.assertEqual(imu.take(), [])
        world.step(3)
        self.assertEqual(len(imu.take()), 3)

    def test_adds_removes_and_breaks(self):
        world = shoal.World(COOP_LAND)
        before = world.vehicles
        self.assertEqual(world.spawn(name='extra', file='rover.yaml', position_m=[50, 50, 0]), ['extra'])
        self.assertEqual(world.vehicles, [*before, 'extra'])
        world.fault('extra/odometry', 'stuck')
        world.clear_fault('extra/odometry')
        world.step(10)
        world.remove('extra')
        self.assertEqual(world.vehicles, before)
        with self.assertRaisesRegex(shoal.Error, "no vehicle or object 'extra'"):
            world.remove('extra')

    def test_has_vehicles_that_include_a_shipped_one(self):
        with open(scratch('own_rover.yaml'), 'w', encoding='utf-8') as file:
            file.write('include: rover.yaml\nshoal: 1\nvehicle: own_rover\n'
                       'devices: [{name: imu, type: imu}]\n')
        world = shoal.World({'shoal': 1, 'name': 'own', 'vehicles': [{'name': 'r1', 'file': scratch('own_rover.yaml')}]})
        self.assertIn('r1/imu', world.devices('r1'))
        self.assertIn('r1/lidar', world.devices('r1'))

    def test_refuses_with_the_text_of_the_program(self):
        candidates = sorted(name for name in os.listdir('tests/bad_worlds') if name.endswith('.yaml'))
        path = os.path.join('tests/bad_worlds', candidates[0])
        with self.assertRaises(shoal.Error) as caught:
            shoal.World(path)
        printed = subprocess.run([SHOAL, 'run', path, '--bus', 'none'], capture_output=True, text=True, check=False)
        for line in str(caught.exception).splitlines():
            self.assertIn(line, printed.stderr)
        with self.assertRaisesRegex(shoal.Error, 'world:.*physics'):
            shoal.World({**BALL, 'physics': {'step_s': -1}})
        with self.assertRaisesRegex(shoal.Error, 'no_such'):
            shoal.World('no_such.yaml')
        with self.assertRaises(TypeError):
            shoal.World(3)

    def test_warns_on_standard_error_unless_it_is_silenced(self):
        code = ("import shoal\n"
                "world = shoal.World({'shoal': 1, 'name': 'deep', 'objects': ["
                "{'name': 'ground', 'fixed': True, 'parts': [{'shape': 'plane'}]},"
                "{'name': 'box', 'position_m': [0, 0, 0], 'parts': [{'shape': 'box', 'size_m': [1, 1, 1], 'mass_kg': 1}]}]})")
        self.assertEqual(run_python(code)[:2], (0, ''))
        self.assertRegex(run_python(code)[2], "warning: .*object 'box'.* deep")
        self.assertEqual(run_python("import shoal\nshoal.set_log_level('off')\n" + code), (0, '', ''))
        with self.assertRaisesRegex(shoal.Error, "got 'loud'"):
            shoal.set_log_level('loud')

    def test_survives_wrong_use(self):
        world = shoal.World(BALL)
        with self.assertRaisesRegex(shoal.Error, '>= 0'):
            world.step(-1)
        with self.assertRaises(shoal.Error):
            world.run_until(float('nan'))
        with self.assertRaisesRegex(shoal.Error, "no vehicle 'nobody'"):
            world.state('nobody')
        with self.assertRaises(shoal.Error):
            world.restore(b'')
        with self.assertRaises(shoal.Error):
            world.restore(world.snapshot()[:-3])
        with self.assertRaises(shoal.Error):
            world.publish('ball.imu', b'12345678')
        with self.assertRaises(shoal.Error):
            world.subscribe('x' * 64)
        with self.assertRaises(TypeError):
            world.step('many')
        for threads in [-1, 257]:
            with self.assertRaisesRegex(shoal.Error, 'threads must be 0 to 256'):
                world.use_threads(threads)
        imu = world.subscribe('ball.imu')
        del world
        self.assertEqual(imu.take(), [])  # the subscription keeps the world alive

    def test_may_be_used_by_one_thread_at_a_time(self):
        world = shoal.World(COOP_LAND)
        started = threading.Event()
        errors = []

        def work():
            started.set()
            world.step(2000)

        thread = threading.Thread(target=work)
        thread.start()
        started.wait()
        while thread.is_alive() and not errors:
            try:
                world.state_hash()
            except shoal.Error as error:
                errors.append(str(error))
        thread.join()
        self.assertEqual(errors, ['the world is in use by another thread'])

    def test_steps_several_worlds_in_threads(self):
        worlds = [shoal.World(COOP_LAND, seed=seed) for seed in (1, 1, 2)]
        threads = [threading.Thread(target=world.step, args=(500,)) for world in worlds]
        for thread in threads:
            thread.start()
        for thread in threads:
            thread.join()
        self.assertEqual(worlds[0].run_hash(), worlds[1].run_hash())
        self.assertNotEqual(worlds[0].run_hash(), worlds[2].run_hash())

    def test_does_not_work_in_a_fork(self):
        world = shoal.World(BALL)
        child = os.fork()
        if child == 0:
            try:
                world.step()
                code = 1
            except shoal.Error as error:
                code = 0 if 'fork' in str(error) else 2
            del world
            os._exit(code)
        self.assertEqual(os.waitpid(child, 0)[1], 0)

    def test_stops_at_ctrl_c(self):
        world = shoal.World(COOP_LAND)
        timer = threading.Timer(0.3, os.kill, (os.getpid(), signal.SIGINT))
        timer.start()
        with self.assertRaises(KeyboardInterrupt):
            world.run_until(1e6)
        timer.join()
        self.assertGreater(world.step_number, 0)
        world.step()  # it can continue


if __name__ == '__main__':
    unittest.main()
