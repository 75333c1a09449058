#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Tests of message classes and records."""
import os
import pickle
import random
import unittest

import numpy as np
from support import ROOT, SCRATCH, run_python, scratch

import shoal
from shoal import messages


class MessagesTest(unittest.TestCase):

    def test_of_every_type_are_read_as_they_were_written(self):
        self.assertGreater(len(messages.types()), 50)
        for name in messages.types():
            with self.subTest(name):
                made = getattr(messages, name)()
                payload = made.encode()
                self.assertEqual(getattr(messages, name).decode(payload).encode(), payload)

    def test_have_arrays_of_numpy(self):
        scan = messages.planar_lidar_t(utime=5, ranges=[1, 2.5, 3])
        again = messages.planar_lidar_t.decode(scan.encode())
        self.assertEqual(again.nranges, 3)
        np.testing.assert_array_equal(again.ranges, np.float32([1, 2.5, 3]))
        self.assertTrue(again.ranges.dtype.isnative)
        self.assertEqual(again, messages.decode(scan.encode()))
        self.assertEqual(pickle.loads(pickle.dumps(again)), again)

    def test_have_pixels_without_a_copy(self):
        pixels = np.arange(640 * 480, dtype=np.uint8)
        payload = messages.image_t(width=640, height=480, row_stride=640, data=pixels).encode()
        image = messages.image_t.decode(payload)
        np.testing.assert_array_equal(image.data, pixels)
        self.assertFalse(image.data.flags.writeable)
        self.assertFalse(image.data.flags.owndata)
        start = np.frombuffer(payload, np.uint8).ctypes.data
        self.assertTrue(start < image.data.ctypes.data < start + len(payload))

    def test_refuse_what_a_type_cannot_hold(self):
        imu = messages.imu_t
        wrong = [
            (messages.planar_lidar_t(nranges=2, ranges=[1, 2, 3]), "'shoal.planar_lidar_t.nranges' must be the length"),
            (messages.planar_lidar_t(ranges=[[1]]), 'array of 1 dimension'),
            (messages.planar_lidar_t(ranges='abc'), 'an array of numbers'),
            (messages.planar_lidar_t(utime=1.5), 'an integer'),
            (messages.planar_lidar_t(utime=2**63), 'an integer'),
            (messages.planar_lidar_t(rad0='north'), 'a number'),
            (messages.image_t(data=[256]), 'integers from 0 to 255'),
            (messages.image_t(data=[0.5]), 'integers from 0 to 255'),
        ]
        for message, rule in wrong:
            with self.subTest(rule), self.assertRaisesRegex(shoal.Error, rule):
                message.encode()
        with self.assertRaises(TypeError):
            imu(no_such=1)
        with self.assertRaises(AttributeError):
            imu().no_such = 1
        with self.assertRaises(AttributeError):
            messages.no_such_t

    def test_refuse_every_wrong_payload(self):
        good = messages.planar_lidar_t(utime=5, ranges=np.ones(20)).encode()
        generator = random.Random(1)
        refused = 0
        for _ in range(20_000):
            bad = bytearray(good[:generator.randrange(len(good) + 1)])
            for _ in range(generator.randrange(4)):
                if bad:
                    bad[generator.randrange(len(bad))] = generator.randrange(256)
            try:
                messages.decode(bytes(bad))
            except shoal.Error:
                refused += 1
        self.assertGreater(refused, 10_000)


class RecordTest(unittest.TestCase):

    def test_is_read_as_it_was_written(self):
        path = scratch('own.lcm')
        sent = [messages.utime_t(utime=number) for number in range(100)]
        with shoal.RecordWriter(path, overwrite=True) as record:
            for message in sent:
                record.write('a' if message.utime % 2 else 'b', message.utime, message)
        events = list(shoal.read(path))
        self.assertEqual([event.message.utime for event in events], list(range(100)))
        self.assertEqual([event.utime for event in shoal.read(path, 'a')], list(range(1, 100, 2)))
        with self.assertRaises(shoal.Error):
            shoal.RecordWriter(path)
        with self.assertRaises(shoal.Error):
            record.write('a', 1, sent[0])

    def test_of_a_run_has_its_messages(self):
        path = scratch('run.lcm')
        run = shoal.run('worlds/coop_land.yaml', duration_s=2, record=path, overwrite=True)
        self.assertEqual(run.summary['sim_time_s'], 2)
        world = shoal.World('worlds/coop_land.yaml')
        world.run_until(2)
        self.assertEqual(run.run_hash, f'{world.run_hash():016x}')
        channels = {event.channel for event in shoal.read(path)}
        self.assertIn('sim.info', channels)

    def test_as_mcap_has_the_same_messages(self):
        paths = [scratch('same.lcm'), scratch('same.mcap')]
        for path in paths:
            shoal.run('worlds/coop_underwater.yaml', duration_s=2, record=path, overwrite=True)
        log, mcap = ([event for event in shoal.read(path) if event.channel != 'sim.info'] for path in paths)
        self.assertGreater(len(log), 300)
        self.assertEqual([event.channel for event in mcap], [event.channel for event in log])
        self.assertEqual([event.message for event in mcap], [event.message for event in log])
        self.assertEqual([event.utime for event in mcap], [event.utime for event in log])
        self.assertEqual(shoal.read(paths[1]).problems, [])

    def test_has_a_table_for_each_channel(self):
        path = scratch('table.lcm')
        with shoal.RecordWriter(path, overwrite=True) as record:
            for number in range(5):
                record.write('imu', 10 * number, messages.imu_t(utime=number, linear_acceleration_mps2=[number, 0, 9.8]))
                record.write('scan', number, messages.planar_lidar_t(ranges=np.ones(number)))
        imu = shoal.table(path, 'imu')
        np.testing.assert_array_equal(imu['time_utime'], [0, 10, 20, 30, 40])
        np.testing.assert_array_equal(imu['linear_acceleration_mps2_0'], np.arange(5))
        self.assertEqual(len(shoal.table(path, 'scan')['ranges'][3]), 3)
        with self.assertRaisesRegex(shoal.Error, "no messages on 'nothing'"):
            shoal.table(path, 'nothing')

    def test_with_a_misspelled_channel_is_told_from_one_without_messages(self):
        path = scratch('own2.lcm')
        with shoal.RecordWriter(path, overwrite=True) as record:
            record.write('rover1.lidar', 1, messages.utime_t())
        read = ("import shoal, sys\n"
                "events = shoal.read(sys.argv[1], *sys.argv[2:])\n"
                "print(len(list(events)), len(list(events)))\n")
        self.assertEqual(run_python(read, path, 'rover1.lidar')[1:], ('1 0\n', ''))
        code, printed, errors = run_python(read, path, 'rover1.lider', 'rover1.lidar')
        self.assertEqual((code, printed), (0, '1 0\n'))
        self.assertEqual(errors, f"warning: {path}: no messages on 'rover1.lider'; did you mean 'rover1.lidar'?\n")
        with self.assertRaisesRegex(shoal.Error, "no messages on 'rover1.lider'; did you mean 'rover1.lidar'"):
            shoal.table(path, 'rover1.lider')

    def test_is_not_any_file(self):
        with open(scratch('pixels.png'), 'wb') as file:
            file.write(b'\x89PNG\r\n\x1a\n' + bytes(500))
        for name, rule in [(scratch('pixels.png'), 'pixels.png: is not an LCM log'),
                           (os.path.join(ROOT, 'README.md'), 'README.md: is not an LCM log'), (SCRATCH, SCRATCH)]:
            with self.subTest(name), self.assertRaisesRegex(shoal.Error, rule):
                shoal.read(name)
        os.replace(scratch('pixels.png'), scratch('pixels.mcap'))
        with self.assertRaisesRegex(shoal.Error, 'pixels.mcap'):
            list(shoal.read(scratch('pixels.mcap')))
        shoal.RecordWriter(scratch('empty.lcm'), overwrite=True).close()
        self.assertEqual(list(shoal.read(scratch('empty.lcm'))), [])

    def test_that_is_damaged_is_read_as_far_as_it_goes(self):
        path = scratch('cut.lcm')
        with shoal.RecordWriter(path, overwrite=True) as record:
            for number in range(10):
                record.write('a', number, messages.utime_t(utime=number))
        with open(path, 'r+b') as file:
            file.truncate(os.path.getsize(path) - 5)
        self.assertEqual(len(list(shoal.read(path))), 9)
        with self.assertRaises(shoal.Error):
            next(shoal.read(scratch('none.lcm')))


if __name__ == '__main__':
    unittest.main()
