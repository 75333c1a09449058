#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Tests of the client in runs of the simulator."""
import os
import re
import signal
import sys
import threading
import unittest

from support import BALL, ROOT, ShoalRun, run_python, scratch

import shoal
from shoal import messages

MINIMAL = 'worlds/minimal.yaml'


class Pilot:
    """The program of docs/start/4_own_program.md, with the client of the package."""

    def __init__(self, **join):
        self.ahead_m = 0.0
        self.client = shoal.Client('pilot')
        self.client.subscribe('rover1.lidar', self.on_lidar, messages.planar_lidar_t)
        self.join = join

    def on_lidar(self, scan):
        self.ahead_m = float(scan.ranges[scan.nranges // 2])

    def run(self):
        self.client.join(0.1, **self.join)
        for utime in self.client.ticks():
            self.client.publish('rover1.drive.cmd', messages.twist_command_t(
                utime=utime, forward_mps=0.5 if self.ahead_m > 1 else 0.0))


def interrupt_after(seconds):
    timer = threading.Timer(seconds, os.kill, (os.getpid(), signal.SIGINT))
    timer.start()
    return timer


class ClientTest(unittest.TestCase):

    def test_drives_the_same_run_as_the_client_in_cpp(self):
        with open(os.path.join(ROOT, 'docs', 'start', '4_own_program.md'), encoding='utf-8') as file:
            expected = re.search(r'run hash (\w{16})', file.read())[1]
        pilot = Pilot()
        with ShoalRun(MINIMAL, '--duration', '15', '--await', 'pilot') as run:
            pilot.run()
            code, printed = run.wait()
        self.assertEqual(code, 0, printed)
        self.assertIn(f'run hash {expected}', printed)
        self.assertAlmostEqual(pilot.ahead_m, 0.88, delta=0.05)
        self.assertEqual(pilot.client.end, 'last_tick')
        self.assertIsNone(pilot.client.next_tick())
        counts = pilot.client.counts
        self.assertEqual((counts['received'], counts['published'], counts['bad']), (150, 151, 0))

    def test_takes_part_in_a_run_of_its_own_process(self):
        pilot, ended = Pilot(), []
        thread = threading.Thread(target=lambda: ended.append(
            shoal.run('minimal', duration_s=5, bus='lcm', wait_for=['pilot'])))
        thread.start()
        pilot.run()
        thread.join()
        self.assertEqual(ended[0].summary['sim_time_s'], 5)
        self.assertEqual(pilot.client.end, 'last_tick')

    def test_gets_what_a_handler_raises(self):
        client = shoal.Client('pilot')

        def fail(scan):
            raise KeyError(scan.utime)

        client.subscribe('rover1.lidar', fail)
        with ShoalRun(MINIMAL, '--duration', '2', '--await', 'pilot'):
            client.join(0.1)
            with self.assertRaises(KeyError):
                for _ in client.ticks():
                    pass

    def test_counts_messages_of_another_type(self):
        received = []
        client = shoal.Client('pilot')
        client.subscribe('rover1.lidar', received.append, 'imu_t')
        with ShoalRun(MINIMAL, '--duration', '1', '--await', 'pilot'):
            client.join(0.1)
            for _ in client.ticks():
                pass
        self.assertEqual(received, [])
        self.assertEqual(client.counts['bad'], client.counts['received'])
        self.assertGreater(client.counts['bad'], 5)

    def test_leaves_when_it_is_closed(self):
        with ShoalRun(MINIMAL, '--duration', '20', '--await', 'pilot') as run:
            with shoal.Client('pilot') as client:
                client.join(0.1)
                client.next_tick()
            code, printed = run.wait()
        self.assertEqual(code, 0, printed)
        with self.assertRaisesRegex(shoal.Error, 'closed'):
            client.next_tick()

    def test_follows_without_lockstep(self):
        client = shoal.Client('observer')
        client.set_silence_limit(30)
        client.follow(0.5)
        with ShoalRun(MINIMAL, '--duration', '3', speed='10'):
            times = list(client.ticks())
        self.assertGreaterEqual(len(times), 3)
        self.assertEqual(client.end, 'last_tick')

    def test_goes_back_with_the_world(self):
        rewinds = []
        client = shoal.Client('pilot')
        client.on_rewind(rewinds.append)
        with ShoalRun(MINIMAL, '--duration', '3', '--await', 'pilot') as run:
            client.join(0.1)
            for utime in client.ticks():
                if utime % 10_000_000 == 2_000_000 and not rewinds:
                    client.publish('sim.control', messages.sim_control_request_t(
                        id=1, client='pilot', command='rewind', text='run', value=1.0))
            code, printed = run.wait()
        self.assertEqual(code, 0, printed)
        self.assertEqual(len(rewinds), 1)
        self.assertEqual(client.branch, 1)

    def test_says_why_it_cannot_join(self):
        client = shoal.Client('pilot')
        with self.assertRaisesRegex(shoal.Error, "join.*(\n.*)*comes before"):
            client.next_tick()
        with self.assertRaises(shoal.Error):
            client.join(0.1, wait_s=0.3)
        with ShoalRun(MINIMAL, '--duration', '1', '--await', 'pilot'):
            with self.assertRaisesRegex(shoal.Error, 'multiple'):
                client.join(0.0123)
        for wrong in [-1, float('nan')]:
            with self.assertRaises(shoal.Error):
                client.join(0.1, wait_s=wrong)
            with self.assertRaises(shoal.Error):
                client.follow(wrong)
        with self.assertRaises(shoal.Error):
            client.join(0.1, on_timeout='sulk')
        with self.assertRaises(shoal.Error):
            shoal.Client('pilot', 'nonsense://')

    def test_names_the_exception_of_its_program(self):
        program = ("import concurrent.futures, sys, threading, shoal\n"
                   "def drive(client):\n"
                   "    client.join(0.1)\n"
                   "    for number, utime in enumerate(client.ticks()):\n"
                   "        if number == 20:\n"
                   "            raise ZeroDivisionError('broken \"wheel\"\\n')\n"
                   "def managed():\n"
                   "    with shoal.Client('pilot') as client:\n"
                   "        drive(client)\n"
                   "def dropped():\n"
                   "    drive(shoal.Client('pilot'))\n"
                   "thread = threading.Thread(target=globals()[sys.argv[1]])\n"
                   "thread.start()\n"
                   "shoal.run('minimal', duration_s=5, bus='lcm', wait_for='pilot')\n"
                   "thread.join()\n")
        for how in ['managed', 'dropped']:
            with self.subTest(how):
                code, _, errors = run_python(program, how)
                self.assertEqual(code, 0, errors)
                self.assertRegex(errors, "warning: lockstep: client 'pilot' left at 2\.[01][0-9] s on the world's bus: "
                                 'ZeroDivisionError: broken "wheel" ; the world continues')
        for planned in ["client.close()", "sys.exit()", "raise SystemExit(0)"]:
            with self.subTest(planned):
                code, _, errors = run_python(program.replace("raise Zero", f"{planned}; return\n            raise Zero"),
                                             'managed')
                self.assertEqual((code, errors), (0, ''))

    def test_names_the_exception_that_ends_its_program(self):
        with ShoalRun(MINIMAL, '--duration', '5', '--await', 'pilot') as run:
            code, _, errors = run_python("import shoal\n"
                                         "client = shoal.Client('pilot')\n"
                                         "client.join(0.1)\n"
                                         "client.next_tick()\n"
                                         "raise KeyError('map')\n")
            self.assertEqual(code, 1, errors)
            self.assertRegex(run.wait()[1], r"client 'pilot' left at .*: KeyError: 'map'; the world continues")

    def test_has_failed_when_an_exception_ends_its_program(self):
        drive = ("def drive():\n"
                 "    with shoal.Client('pilot') as client:\n"
                 "        client.join(0.1)\n"
                 "        client.next_tick()\n"
                 "        raise KeyError('map')\n")
        program = {'name': 'broken', 'client': 'pilot', 'command': [sys.executable, scratch('broken.py')]}
        # The program ends with 1, or with 0 when only its thread ends, before the end of the run or after it.
        for call, duration_s in [('drive()', 2), ('drive()', 300), ('threading.Thread(target=drive).start()', 2),
                                ('threading.Thread(target=drive).start()', 300)]:
            with self.subTest(call=call, duration_s=duration_s):
                with open(scratch('broken.py'), 'w', encoding='utf-8') as file:
                    file.write(f'import shoal, threading\n{drive}{call}\n')
                world = {**BALL, 'physics': {'step_s': 0.01, 'gravity_mps2': 0}, 'processes': [program]}
                run = shoal.run(world, duration_s=duration_s, bus='lcm', launch=True, results=scratch('broken'))
                process, = run.summary['processes']
                self.assertEqual((process['name'], process['failed'], run.summary['passed']), ('broken', True, False))
                self.assertRegex(process['how'], "left: KeyError: 'map'|exited with code 1")

    def test_whose_exception_is_kept_is_named_by_the_error_of_the_run(self):
        code, _, errors = run_python("import concurrent.futures, shoal\n"
                                     "def drive():\n"
                                     "    client = shoal.Client('pilot')\n"
                                     "    client.join(0.1, on_timeout='end', timeout_s=0.5)\n"
                                     "    client.next_tick()\n"
                                     "    raise ZeroDivisionError\n"
                                     "with concurrent.futures.ThreadPoolExecutor() as pool:\n"
                                     "    future = pool.submit(drive)\n"
                                     "    shoal.run('minimal', duration_s=5, bus='lcm', wait_for=['pilot'])\n")
        self.assertEqual(code, 1, errors)
        self.assertRegex(errors, "no acknowledgement from 'pilot' .*; 'pilot' is a client of this process .* a future")

    def test_checks_its_numbers_at_once(self):
        # Without the check join() would fail as well, but by another error, after waiting for a simulator.
        client = shoal.Client('pilot')
        for wrong in [-1, 0, float('nan'), float('inf'), 1e10]:
            for wait in client.join, client.follow:
                with self.assertRaisesRegex(shoal.Error, 'period_s must be > 0 and <= 1e'):
                    wait(wrong)
        with self.assertRaisesRegex(shoal.Error, 'Client.join: timeout_s must be >= 0 and <= 1e'):
            client.join(0.1, timeout_s=-1)
        with self.assertRaisesRegex(TypeError, "Client.join: period_s must be a number, got '0.1'"):
            client.join('0.1')
        with self.assertRaisesRegex(TypeError, 'Client.wait_until: utime must be an integer, got 1.5'):
            client.wait_until(1.5)
        with self.assertRaisesRegex(shoal.Error, 'Client.set_silence_limit: seconds must be >= 0 and <= 1e'):
            client.set_silence_limit(-1)

    def test_refuses_what_is_no_message(self):
        client = shoal.Client('pilot')
        for wrong in [None, 5, 'text', object()]:
            with self.assertRaises(TypeError):
                client.publish('a', wrong)
        with self.assertRaises(shoal.Error):
            client.publish('a', messages.twist_command_t(forward_mps='fast'))
        with self.assertRaises(TypeError):
            client.subscribe('a', 'no function')
        with self.assertRaisesRegex(shoal.Error, 'no_such_t'):
            client.subscribe('a', print, 'no_such_t')

    def test_is_stopped_by_another_thread_and_used_by_one(self):
        client = shoal.Client('pilot')
        client.follow(1)
        refused = []

        def disturb():
            while not refused:
                try:
                    client.publish('a', messages.utime_t())
                except shoal.Error as error:
                    refused.append(str(error))
            client.stop()

        thread = threading.Thread(target=disturb)
        thread.start()
        self.assertIsNone(client.next_tick())
        thread.join()
        self.assertEqual(refused, ['the client is in use by another thread'])
        self.assertEqual(client.end, 'stopped')

    def test_ends_at_ctrl_c(self):
        for wait in [lambda client: client.join(0.1), lambda client: (client.follow(1), client.next_tick())]:
            client = shoal.Client('pilot')
            client.set_wait_warning(0)
            with self.assertRaises(KeyboardInterrupt):  # join() would otherwise end by another error, next_tick() never
                timer = interrupt_after(0.3)
                wait(client)
            timer.join()

    def test_of_a_fork_is_another_one(self):
        client = shoal.Client('pilot')
        with ShoalRun(MINIMAL, '--duration', '2', '--await', 'pilot') as run:
            client.join(0.1)
            self.assertIsNotNone(client.next_tick())
            child = os.fork()
            if child == 0:
                try:
                    client.next_tick()
                    code = 1
                except shoal.Error as error:
                    code = 0 if 'fork' in str(error) else 2
                client.stop()
                client.close()
                os._exit(code)
            self.assertEqual(os.waitpid(child, 0)[1], 0)
            for _ in client.ticks():
                pass
            self.assertEqual(run.wait()[0], 0)
        self.assertEqual(client.end, 'last_tick')

    def test_may_live_until_the_interpreter_ends(self):
        code, _, errors = run_python(
            "import shoal, threading\n"
            "client = shoal.Client('pilot')\n"
            "client.subscribe('a', print)\n"
            "client.follow(1)\n"
            "client.set_wait_warning(0)\n"
            "threading.Thread(target=client.next_tick, daemon=True).start()\n"
            "world = shoal.World('minimal')\n"
            "threading.Thread(target=world.step, args=(10**9,), daemon=True).start()\n"
            "record = shoal.RecordWriter('%s', overwrite=True)\n" % scratch('exit.lcm'))
        self.assertEqual(code, 0, errors)


if __name__ == '__main__':
    unittest.main()
