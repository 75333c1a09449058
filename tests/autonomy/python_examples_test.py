# SPDX-License-Identifier: BSD-3-Clause
"""The Python examples: the filter against the truth and closed forms, the frame against the bytes of the C++ codec, the
datagrams of LCM."""
import math
import os
import random
import re
import struct
import sys
import types
import unittest

ROOT = os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "..")
sys.path[:0] = [os.path.join(ROOT, "examples", "python"), os.path.join(ROOT, "tests")]

# coop_auv.py imports them; Debian has no lcm for Python, and nothing of them is called here.
for name in ("lcm", "shoal"):
    sys.modules.setdefault(name, types.ModuleType(name))

import coop_auv  # noqa: E402
import small_lcm  # noqa: E402
from marine_ekf import MarineEkf, turned  # noqa: E402
from own_ports import own_url  # noqa: E402


class Filter(unittest.TestCase):
    def test_heading_bias_makes_it_unsure_across_the_way(self):
        ekf = MarineEkf(0, (0, 0), 0, heading_bias_std_rad=0.05, speed_scale_std=0.02, heading_noise=0, speed_noise=0)
        ekf.walks = [0] * 6
        for t in range(1, 1001):
            ekf.predict(t, (0, 2))
        self.assertAlmostEqual(math.sqrt(ekf.P[0][0]), 2000 * 0.05, delta=1e-6)
        self.assertAlmostEqual(math.sqrt(ekf.P[1][1]), 2000 * 0.02, delta=1e-6)

    def test_an_old_range_belongs_to_where_it_was(self):
        ekf = MarineEkf(0, (100, 0), 3)
        for t in range(1, 21):
            ekf.predict(t, (2, 1))
        self.assertTrue(ekf.update_range(10.5, math.hypot(121, 10.5), 1, (0, 0, 0), (0, 0, 0), 0))
        self.assertAlmostEqual(ekf.x[0], 140, delta=1e-9)
        self.assertAlmostEqual(ekf.x[1], 20, delta=1e-9)

    def test_ranges_bound_the_error(self):
        dice = random.Random(1)
        ekf = MarineEkf(0, (0, 0), 1, states=6)
        beacons = ((300, 300, -1), (900, -250, -1))
        clock_m, reckoned = 18.0, [0.0, 0.0]
        for t in range(1, 801):
            measured = turned((1.5, 0), 0.07 + 0.02 * dice.gauss(0, 1))
            ekf.predict(t, measured)
            reckoned = [reckoned[i] + measured[i] for i in (0, 1)]
            if t % 10 == 0 and t > 5:
                received = t - 3.2  # the packet is complete later
                beacon = beacons[t // 10 % 2]
                slant = math.hypot(1.5 * received - beacon[0], beacon[1], 19)
                ekf.update_range(received, slant + clock_m + dice.gauss(0, 1), 1, beacon, (0.01, 0, 0.01), -20)
        self.assertGreater(math.hypot(reckoned[0] - 1200, reckoned[1]), 75)
        self.assertLess(math.hypot(ekf.x[0] - 1200, ekf.x[1]), 4)
        self.assertAlmostEqual(ekf.x[4], clock_m, delta=3)

    def test_beacon_that_contradicts_is_refused_and_moves_nothing(self):
        ekf = MarineEkf(0, (100, 0), 1, states=6)
        before = list(ekf.x), [list(row) for row in ekf.P]
        for range_m in [250] * 20 + [math.nan] * 20:
            self.assertFalse(ekf.update_range(0, range_m, 1, (0, 0, 0), (0, 0, 0), 0, beacon=1))
        self.assertEqual((ekf.x, ekf.P), before)
        # It is believed again after five that fit.
        used = [ekf.update_range(0, 100, 1, (0, 0, 0), (0, 0, 0), 0, beacon=1) for _ in range(5)]
        self.assertEqual(used, [False] * 4 + [True])

    def test_what_two_beacons_say_alike_is_the_clock(self):
        ekf = MarineEkf(0, (100, 50), 1, states=6)
        ranges = (1, (0, 50, 0), 100), (2, (100, 0, 0), 50)
        used = [ekf.update_range(0, slant - 1500, 1, beacon_m, (0, 0, 0), 0, beacon)
                for beacon, beacon_m, slant in ranges * 3]
        self.assertEqual(used, [False] * 4 + [True] * 2)
        self.assertAlmostEqual(ekf.x[4], -1500, delta=3)
        self.assertAlmostEqual(math.hypot(ekf.x[0] - 100, ekf.x[1] - 50), 0, delta=0.1)
        self.assertLess(ekf.P[0][0], 1.01)

    def test_what_they_say_alike_and_ever_more_is_its_drift(self):
        ekf = MarineEkf(0, (100, 50), 1, states=6)
        for i in range(31):
            ekf.predict(10 * i, (0, 0))
            beacon, beacon_m, slant = ((1, (0, 50, 0), 100), (2, (100, 0, 0), 50))[i % 2]
            used = ekf.update_range(10 * i, slant + 750 + 1.5 * i, 1, beacon_m, (0, 0, 0), 0, beacon)
            self.assertEqual(used, i >= 4)
        self.assertAlmostEqual(ekf.x[5], 0.15, delta=0.02)
        self.assertLess(math.hypot(ekf.x[0] - 100, ekf.x[1] - 50), 1)

    def test_gps_is_believed_when_it_contradicts_for_long(self):
        ekf = MarineEkf(0, (0, 0), 1)
        self.assertFalse(any(ekf.update_position((300, 0), 1) for _ in range(4)))
        self.assertFalse(ekf.update_position((math.nan, 0), 1))
        self.assertTrue(ekf.update_position((300, 0), 1))
        self.assertAlmostEqual(ekf.x[0], 300, delta=0.1)


class Declaration(unittest.TestCase):
    def test_has_the_options_of_the_program_with_their_defaults(self):
        with open(coop_auv.__file__ + ".args.yaml", encoding="utf-8") as file:
            text = file.read()
        declared = dict(re.findall(r"- \{name: (\w+),.* default: ([^,}]+)", text))
        self.assertEqual(declared, {name: f"{value:g}" if isinstance(value, float) else value
                                    for name, value in vars(coop_auv.parse([])).items()})


class Frame(unittest.TestCase):
    # The frame of the test AcousticFrame.BytesAreWhereTheTableSays.
    BYTES = bytes([0x10, 7, 0, 0, 3, 0xE8, 0, 0, 0, 100, 0xFF, 0xFF, 0xFF, 0x9C, 0, 0, 255, 0, 31, 0xFF, 0xFF, 0x81, 0,
                   150, 0x40, 0])

    def test_is_read_as_it_was_written(self):
        data = self.BYTES + coop_auv.checksum(self.BYTES).to_bytes(2, "big")
        state = coop_auv.decode_frame(data, 3 * 86400 * 10**6)
        self.assertEqual(state["sender"], 7)
        self.assertEqual(state["utime"], (3 * 86400 + 1) * 10**6)
        self.assertEqual(state["position_m"], (1, -1, -2.55))
        self.assertAlmostEqual(state["covariance_m2"][0], 0.31**2)
        self.assertAlmostEqual(state["velocity_mps"][1], 1.5)

    def test_checksum_is_the_published_one(self):
        self.assertEqual(coop_auv.checksum(b"123456789"), 0x29B1)

    def test_what_is_no_frame_is_refused(self):
        data = self.BYTES + coop_auv.checksum(self.BYTES).to_bytes(2, "big")
        self.assertIsNone(coop_auv.decode_frame(data[:-1], 0))
        for bit in range(8 * len(data)):
            bad = bytearray(data)
            bad[bit // 8] ^= 1 << bit % 8
            self.assertIsNone(coop_auv.decode_frame(bytes(bad), 0))


    def test_refuses_what_the_codec_in_cpp_refuses(self):
        near = 3 * 86400 * 10**6
        for at, value in ((2, b"\x24\x0c\x84\x00"), (17, b"\0\0"), (19, b"\0\0"), (21, b"\x80")):
            bad = bytearray(self.BYTES)
            bad[at:at + len(value)] = value  # no time of a week, no deviations, a correlation of -128 / 127
            self.assertIsNone(coop_auv.decode_frame(bytes(bad) + coop_auv.checksum(bad).to_bytes(2, "big"), near), at)
        data = self.BYTES + coop_auv.checksum(self.BYTES).to_bytes(2, "big")
        self.assertIsNotNone(coop_auv.decode_frame(data, near + 61 * 10**6))
        self.assertIsNone(coop_auv.decode_frame(data, near + 62 * 10**6))  # a minute and a second after its time


def report(**fields):
    return types.SimpleNamespace(**fields)


class Navigator(unittest.TestCase):
    def started(self):
        auv = coop_auv.CoopAuv()
        auv.on_ahrs(report(quat=(math.cos(0.25), 0.0, 0.0, math.sin(0.25))))  # 0.5 rad left of east
        auv.on_gps(report(gps_lock=1, utime=0, xyz_pos=(10.0, 20.0, 0.0), horizontal_accuracy=1.0))
        return auv

    def test_goes_where_the_ahrs_says(self):
        auv = self.started()
        auv.on_compass(report(heading_true_rad=3.0))  # counts less
        auv.on_dvl(report(utime=10**6, bottom_lock=1, velocity_mps=(2.0, 0.0, 0.0)))
        self.assertAlmostEqual(auv.ekf.x[0], 10 + 2 * math.cos(0.5))
        self.assertAlmostEqual(auv.ekf.x[1], 20 + 2 * math.sin(0.5))

    def test_does_with_a_compass(self):
        auv = coop_auv.CoopAuv()
        auv.on_compass(report(heading_true_rad=math.pi / 2 - 0.5))
        self.assertAlmostEqual(auv.yaw_rad, 0.5)

    def test_ranges_come_from_the_sender_itself(self):
        sent = (3 * 86400 + 2) * 10**6
        data = Frame.BYTES + coop_auv.checksum(Frame.BYTES).to_bytes(2, "big")  # of a second before

        def place_after(*packets):
            auv = self.started()
            auv.ekf.time_s = sent * 1e-6
            auv.ekf.motion[0] = (auv.ekf.time_s, 0.0, 0.0)
            before = list(auv.ekf.x)
            for source, later_s in packets:
                auv.on_modem(report(utime=sent + later_s * 10**6, sent_utime=sent + later_s * 10**6, source=source,
                                    travel_time_s=0.02, data=data))
            return None if auv.ekf.x == before else auv.ekf.x

        once = place_after(("boat", 0))
        self.assertIsNotNone(once)
        self.assertEqual(place_after(("boat", 0), ("relay", 0)), once)
        self.assertIsNone(place_after(("relay", 10)))

    def test_nonsense_does_no_harm(self):
        auv = self.started()
        before = list(auv.ekf.x), auv.yaw_rad, auv.depth_m
        nan = math.nan
        auv.on_ahrs(report(quat=(nan, 0.0, 0.0, 0.0)))
        auv.on_ahrs(report(quat=(0.0, 0.0, 0.0, 0.0)))
        auv.has_ahrs = False
        auv.on_compass(report(heading_true_rad=nan))
        auv.on_pressure(report(depth_m=nan))
        auv.on_dvl(report(utime=10**6, bottom_lock=1, velocity_mps=(nan, 0.0, 0.0)))
        auv.on_gps(report(gps_lock=1, utime=10**7, xyz_pos=(nan, 0.0, 0.0), horizontal_accuracy=1.0))
        auv.on_gps(report(gps_lock=1, utime=10**7, xyz_pos=(0.0, 0.0, 0.0), horizontal_accuracy=nan))
        near = 3 * 86400 * 10**6
        data = Frame.BYTES + coop_auv.checksum(Frame.BYTES).to_bytes(2, "big")
        auv.on_modem(report(utime=near, sent_utime=near, source="boat", travel_time_s=nan, data=data))
        self.assertEqual((list(auv.ekf.x), auv.yaw_rad, auv.depth_m), before)


class SmallLcm(unittest.TestCase):
    """Datagrams as LCM 1.3.1 writes them: lcm/udpm_util.h."""
    URL = own_url()

    def setUp(self):
        self.lcm = small_lcm.LCM(self.URL)
        self.addCleanup(self.lcm.socket.close)

    def test_a_short_message_is_one_datagram(self):
        datagram = struct.pack(">II", 0x4C433032, 7) + b"a.b\0data\0more"
        self.assertEqual(self.lcm.message_of(datagram, "one"), ("a.b", b"data\0more"))

    def test_a_long_message_is_whole_when_all_parts_came_in_any_order(self):
        first, second = (struct.pack(">IIIIHH", 0x4C433033, 9, 5, offset, part, 2) for part, offset in ((0, 0), (1, 3)))
        self.assertEqual(self.lcm.message_of(second + b"lo", "one"), (None, None))
        self.assertEqual(self.lcm.message_of(first + b"c\0hel", "two"), (None, None), "of another sender")
        self.assertEqual(self.lcm.message_of(first + b"c\0hel", "one"), ("c", b"hello"))

    def test_a_newer_message_of_a_sender_takes_the_place_of_one_that_lacks_parts(self):
        for number in 1, 2:
            part = struct.pack(">IIIIHH", 0x4C433033, number, 5, 3, 1, 2)
            self.assertEqual(self.lcm.message_of(part + b"lo", "one"), (None, None))
        first = struct.pack(">IIIIHH", 0x4C433033, 2, 5, 0, 0, 2)
        self.assertEqual(self.lcm.message_of(first + b"c\0hel", "one"), ("c", b"hello"))

    def test_what_is_no_datagram_of_lcm_is_no_message(self):
        for datagram in b"", b"short", bytes(30), struct.pack(">II", 0x4C433033, 1):
            self.assertEqual(self.lcm.message_of(datagram, "one"), (None, None))

    def test_a_message_that_is_too_long_to_be_sent_is_an_error(self):
        with self.assertRaisesRegex(ValueError, "a.b: a message of 70000 bytes"):
            self.lcm.publish("a.b", bytes(70000))


class Page(unittest.TestCase):
    def test_shows_the_handlers_of_the_example(self):
        with open(os.path.join(ROOT, "examples", "python", "coop_auv.py"), encoding="utf-8") as file:
            text = file.read()
        handlers = text[text.index("class CoopAuv:"):text.index("    def estimate(self):")].rstrip()
        with open(os.path.join(ROOT, "docs", "guides", "python_auv.md"), encoding="utf-8") as file:
            self.assertIn(handlers, file.read())


if __name__ == "__main__":
    unittest.main()
