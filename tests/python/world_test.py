#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Tests of worlds in the process of Python."""
import json
import os
import re
import signal
import subprocess
import threading
import unittest

import numpy as np
from support import BALL, SHOAL, comma_locale, run_python, scratch

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

    def test_is_the_same_where_numbers_have_a_comma(self):
        # Two hulls by their derivatives.
        world = """
shoal: 1
medium: {water: {}}
vehicles:
  - {name: auv, file: remus_prestero.yaml, position_m: [0, 0, -10]}
  - {name: float, file: glider.yaml, position_m: [50, 0, -10]}
"""
        with open(scratch('comma.yaml'), 'w', encoding='utf-8') as file:
            file.write(world)
        with comma_locale():
            self.assertEqual(f'{1.5:n}', '1,5')
            here = shoal.World(scratch('comma.yaml'), seed=7)
            here.run_until(3)
            hashes = f'{here.state_hash():016x}', f'{here.run_hash():016x}'
        self.assertEqual(hashes, hashes_of_program(scratch('comma.yaml'), 3, '--seed', '7'))

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
        # Also when the program takes them only later.
        world.restore(snapshot)
        world.step(4)
        self.assertEqual(len(imu.take()), 4)

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
        with self.assertRaisesRegex(shoal.Error, "no vehicle or object 'extra'$"):
            world.remove('extra')
        with self.assertRaisesRegex(shoal.Error, "no vehicle or object 'rovre1'; did you mean 'rover1'"):
            world.remove('rovre1')

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

    def test_refuses_misspelled_channels(self):
        world = shoal.World('minimal')
        command = shoal.messages.twist_command_t(forward_mps=0.5)
        for use in world.last, world.subscribe:
            for wrong, meant in [('rover1.lider', 'rover1.lidar'), ('lidar', 'rover1.lidar'),
                                 ('rover1', 'rover1.drive.cmd'), ('rover1.drive.cdm', 'rover1.drive.cmd')]:
                with self.subTest(wrong), self.assertRaisesRegex(
                        shoal.Error, f"nothing in the world publishes on '{wrong}'; did you mean '{meant}'"):
                    use(wrong)
            with self.assertRaisesRegex(shoal.Error, "'rover1/lidar' .* 'rover1.lidar.truth': it needs 'truth: true'"):
                use('rover1.lidar.truth')
            with self.assertRaisesRegex(shoal.Error, r'sim\.\* are those of a run'):
                use('sim.state')
        for wrong in ['rover1.drive', 'rover1.drive.cnd', 'rover2.drive.cmd']:
            with self.subTest(wrong), self.assertRaisesRegex(
                    shoal.Error, f"no device, metric or event reads '{wrong}'; did you mean 'rover1.drive.cmd'"):
                world.publish(wrong, command)
        self.assertIsNone(world.last('rover1.lidar'))
        self.assertIsNone(world.last('rover1.drive.cmd'))
        world.spawn(name='rover2', file='rover.yaml', position_m=[0, 3, 0])
        world.publish('rover2.drive.cmd', command)
        self.assertIsNone(world.last('rover2.lidar'))

    def test_warns_once_of_channels_that_only_the_program_has(self):
        code, _, errors = run_python(
            "import shoal\n"
            "world = shoal.World('minimal')\n"
            "quiet = world.subscribe('planner.goal')\n"
            "for _ in range(3):\n"
            "    world.publish('planner.goal', shoal.messages.utime_t())\n"
            "    world.publish('planner.path', shoal.messages.utime_t())\n"
            "assert len(quiet.take()) == 3\n"
            "snapshot = world.snapshot()\n"
            "world.restore(snapshot)\n"
            "world.branch().last('planner.path')\n"
            "world.last('planner.path'), world.last('rest'), world.last('rest')\n")
        self.assertEqual(code, 0, errors)
        self.assertEqual([line.partition(' (at')[0] for line in errors.splitlines()], [
            "warning: last or subscribe: nothing in the world publishes on 'planner.goal', nor has the program yet",
            "warning: publish: no device, metric or event reads 'planner.path', and the program has not subscribed to it",
            "warning: last or subscribe: nothing in the world publishes on 'rest', nor has the program yet"])

    def test_refuses_commands_that_a_device_would_ignore(self):
        world = shoal.World('minimal')
        with self.assertRaisesRegex(shoal.Error, "'rover1.drive.cmd' takes shoal.twist_command_t.*, got shoal.imu_t"):
            world.publish('rover1.drive.cmd', shoal.messages.imu_t())
        for wrong in [float('nan'), float('inf')]:
            with self.assertRaisesRegex(shoal.Error, "'rover1.drive.cmd': .*forward_mps"):
                world.publish('rover1.drive.cmd', shoal.messages.twist_command_t(forward_mps=wrong))
        state = world.state_hash()
        world.publish('rover1.drive.cmd', shoal.messages.twist_command_t(forward_mps=1))
        world.step(100)
        self.assertNotEqual(world.state_hash(), state)

    def test_takes_nan_in_commands_whose_devices_take_it(self):
        taken = set()
        for folder, _, names in os.walk('devices'):
            for name in names:
                with open(os.path.join(folder, name), encoding='utf-8') as file:
                    taken |= set(re.findall(r'decode<shoal::(\w+_t)>\(payload, (?:shoal::)?Finite::any\)', file.read()))
        taken.remove('modem_received_t')  # of the network of modems, no command
        with open('python/world/world_channels.cpp', encoding='utf-8') as file:
            known = set(re.findall(r'"shoal\.(\w+)"', file.read()))
        self.assertEqual(known, taken)
        world = shoal.World('coop_underwater')
        world.spawn(name='boat', file='naive_boat.yaml', position_m=[100, 0, 0])
        world.publish('boat.drive.cmd', shoal.messages.helm_command_t(speed_mps=1, heading_rad=float('nan')))
        with self.assertRaisesRegex(shoal.Error, "'boat.drive.cmd': .*thrust"):
            world.publish('boat.drive.cmd', shoal.messages.thrust_rudder_command_t(thrust=float('nan')))

    def test_gives_each_wrong_argument_one_sentence(self):
        world = shoal.World(BALL)
        deep: dict = {}
        cycle: dict = {'a': deep}
        deep['b'] = cycle
        wide: object = 1
        for _ in range(5000):
            wide = [wide]
        for use, kind, rule in [
                (lambda: world.step(1.5), TypeError, 'World.step: count must be an integer, got 1.5'),
                (lambda: world.step(True), TypeError, 'World.step: count must be an integer, got True'),
                (lambda: world.step(-1), shoal.Error, 'World.step: count must be >= 0, got -1'),
                (lambda: world.step(2**70), shoal.Error, 'World.step: count must be <= 9223372036854775807, got'),
                (lambda: world.run_until('5'), TypeError, "World.run_until: time_s must be a number, got '5'"),
                (lambda: world.run_until(float('nan')), shoal.Error, 'time_s must be >= 0 and <= 1e.09, got nan'),
                (lambda: shoal.World(BALL, seed=1.5), TypeError, 'World: seed must be an integer, got 1.5'),
                (lambda: shoal.World(BALL, seed=-1), shoal.Error, 'World: seed must be >= 0, got -1'),
                (lambda: shoal.World(BALL, set=[1]), TypeError, r'World: set must be a dict, got \[1\]'),
                (lambda: shoal.World({**BALL, 'name': '\ud800'}), shoal.Error, 'World: a text has characters that UTF-8'),
                (lambda: shoal.World('\ud800'), shoal.Error, 'World: world has characters that a path cannot hold'),
                (lambda: shoal.World('a\0b'), shoal.Error, 'World: world must not have the character 0'),
                (lambda: shoal.World({**BALL, 'objects': wide}), shoal.Error, 'World: a value may be nested at most 100'),
                (lambda: world.do(cycle), shoal.Error, 'World.do: .* or contains itself'),
                (lambda: world.do({'gravity_mps2': float('nan')}), shoal.Error, 'World.do: a number must be finite, got nan'),
                (lambda: world.do({'gravity_mps2': print}), TypeError, 'World.do: a value must be text, a number'),
                (lambda: world.last(5), TypeError, 'World.last: channel must be a str, got 5'),
                (lambda: world.last(''), shoal.Error, "a channel has 1 to 63 characters, got ''"),
                (lambda: world.last('\ud800'), shoal.Error, 'World.last: channel has characters that UTF-8 cannot'),
                (lambda: world.subscribe('ball.imu', 0), shoal.Error, 'World.subscribe: capacity must be >= 1, got 0'),
                (lambda: world.publish(None, b''), TypeError, 'World.publish: channel must be a str, got None'),
                (lambda: world.state(b'ball'), TypeError, "World.state: vehicle must be a str, got b'ball'"),
                (lambda: world.states(5), TypeError, 'World.states: vehicles must be a list of names, got 5'),
                (lambda: world.states(['ball', 5]), TypeError, 'World.states: each of vehicles must be a str, got 5'),
                (lambda: world.state('bal'), shoal.Error, "there is no vehicle 'bal'; did you mean 'ball'"),
                (lambda: world.restore('x'), TypeError, "World.restore: snapshot must be bytes, got 'x'"),
                (lambda: world.use_threads(257), shoal.Error, 'World.use_threads: threads must be <= 256, got 257'),
                (lambda: shoal.set_log_level(3), TypeError, 'set_log_level: level must be a str, got 3'),
                (lambda: shoal.Client(5), TypeError, 'Client: name must be a str, got 5'),
                (lambda: shoal.read(5), TypeError, 'read: path must be a path, got 5'),
                (lambda: shoal.read('x', ['a']), TypeError, r"read: a channel must be a str, got \['a'\]")]:
            with self.subTest(rule), self.assertRaisesRegex(kind, rule) as caught:
                use()
            self.assertNotIn('\n', str(caught.exception))

    def test_takes_one_name_for_a_list_of_one(self):
        world = shoal.World(BALL)
        self.assertEqual(world.states('ball').shape, (1,))

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
            with self.assertRaisesRegex(shoal.Error, 'threads must be (>= 0, got -1|<= 256, got 257)'):
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
        while world.step_number == 0:  # on a busy machine the signal may come before the first step
            timer = threading.Timer(0.3, os.kill, (os.getpid(), signal.SIGINT))
            with self.assertRaises(KeyboardInterrupt):
                timer.start()
                world.run_until(1e6)
            timer.join()
        world.step()  # it can continue


if __name__ == '__main__':
    unittest.main()
