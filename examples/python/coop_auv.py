#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Estimates where an AUV is, beside whatever steers it, in lockstep with the simulator.

    PYTHONPATH=build/release/python:examples/python python3 examples/python/coop_auv.py --name auv --sound-speed-mps 1506

Reads NAME.dvl, .ahrs or .compass, .pressure, .gps and .modem; publishes NAME.python_estimate.
"""
import argparse
import math
import struct
import sys

import shoal

from lockstep_client import LockstepClient
from marine_ekf import MarineEkf, turned

PERIOD_S = 0.5
WEEK_MS = 7 * 24 * 3600 * 1000
NEWEST_S = 3
MAX_TRAVEL_S = 60  # 90 km; below 0 the own clock is behind
OLDEST_MS = 60 * 1000
FIRST_SUNDAY_MS = 3 * 24 * 3600 * 1000


def checksum(data):
    """CRC-16/CCITT-FALSE."""
    remainder = 0xFFFF
    for byte in data:
        remainder ^= byte << 8
        for _ in range(8):
            remainder = (remainder << 1) ^ (0x1021 if remainder & 0x8000 else 0)
        remainder &= 0xFFFF
    return remainder


def decode_frame(data, near_utime):
    """The state in a frame of docs/guides/slots_and_frames.md, as a dict; None when it is none, or of more
    than a minute from then."""
    if len(data) != 28 or data[0] != 0x10 or checksum(data[:26]) != struct.unpack(">H", data[26:])[0]:
        return None
    week_ms, east, north = struct.unpack(">Iii", data[2:14])
    east_std, north_std, correlation, speed, course = struct.unpack(">HHbHH", data[17:26])
    if week_ms >= WEEK_MS or east_std == 0 or north_std == 0 or abs(correlation) > 127:
        return None
    near_ms = near_utime // 1000
    ahead_ms = (week_ms - (near_ms - FIRST_SUNDAY_MS) + WEEK_MS // 2) % WEEK_MS - WEEK_MS // 2
    if abs(ahead_ms) > OLDEST_MS:
        return None
    return {
        "sender": data[1],
        "utime": (near_ms + ahead_ms) * 1000,
        "position_m": (east / 100, north / 100, -int.from_bytes(data[14:17], "big") / 100),
        "covariance_m2": ((east_std / 100) ** 2, correlation / 127 * east_std * north_std / 1e4,
                          (north_std / 100) ** 2),
        "velocity_mps": turned((speed / 100, 0.0), course / 65536 * 2 * math.pi),
    }


def finite(*numbers):
    return all(map(math.isfinite, numbers))


class CoopAuv:
    def __init__(self, sound_speed_mps=1500.0, heading_noise=0.035):
        self.sound_speed_mps, self.heading_noise = sound_speed_mps, heading_noise
        self.ekf = None
        self.yaw_rad = None
        self.has_ahrs = False
        self.depth_m = 0.0
        self.fix_utime = 0
        self.senders = {}

    def on_ahrs(self, attitude):
        w, x, y, z = attitude.quat  # of the body in the world
        if abs(math.hypot(w, x, y, z) - 1) < 0.01:
            self.yaw_rad = math.atan2(2 * (w * z + x * y), 1 - 2 * (y * y + z * z))
            self.has_ahrs = True

    def on_compass(self, compass):
        if not self.has_ahrs and finite(compass.heading_true_rad):
            self.yaw_rad = math.pi / 2 - compass.heading_true_rad

    def on_pressure(self, pressure):
        if finite(pressure.depth_m):
            self.depth_m = pressure.depth_m

    def on_gps(self, fix):
        if fix.gps_lock < 1 or self.yaw_rad is None or not finite(*fix.xyz_pos[:2]) or not fix.horizontal_accuracy > 0:
            return
        if self.ekf is None:
            self.ekf = MarineEkf(fix.utime * 1e-6, fix.xyz_pos[:2], fix.horizontal_accuracy, states=6,
                                 heading_noise=self.heading_noise)
        elif fix.utime - self.fix_utime < 5_000_000:
            return
        else:
            self.ekf.update_position(fix.xyz_pos[:2], fix.horizontal_accuracy)
        self.fix_utime = fix.utime

    def on_dvl(self, dvl):
        if self.ekf is not None and dvl.bottom_lock and finite(*dvl.velocity_mps[:2]):
            self.ekf.predict(dvl.utime * 1e-6, turned(dvl.velocity_mps[:2], self.yaw_rad))

    def on_modem(self, packet):
        state = decode_frame(bytes(packet.data), packet.sent_utime)
        if state is None or self.ekf is None or not abs(packet.travel_time_s) < MAX_TRAVEL_S:
            return
        moved_s = (packet.sent_utime - state["utime"]) * 1e-6
        # A forwarded message is older, and from another position: its travel time is unrelated to the sender.
        if abs(moved_s) > NEWEST_S or self.senders.setdefault(state["sender"], packet.source) != packet.source:
            return
        east, north, up = state["position_m"]
        beacon = (east + moved_s * state["velocity_mps"][0], north + moved_s * state["velocity_mps"][1], up)
        range_m = packet.travel_time_s * self.sound_speed_mps
        self.ekf.update_range(packet.utime * 1e-6, range_m, math.hypot(1.0, 0.001 * range_m), beacon,
                              state["covariance_m2"], -self.depth_m, state["sender"])

    def estimate(self):
        message = shoal.estimate_t()
        P = self.ekf.P
        message.utime = round(self.ekf.time_s * 1e6)
        message.position_m = [self.ekf.x[0], self.ekf.x[1], -self.depth_m]
        message.covariance_m2 = [P[0][0], P[0][1], 0.0, P[1][0], P[1][1], 0.0, 0.0, 0.0, 0.01]
        message.yaw_rad = self.yaw_rad + self.ekf.x[2]
        message.clock_error_s = self.ekf.x[4] / self.sound_speed_mps
        return message


def attach(options):
    """Navigator of a vehicle, as a client of the lockstep for LockstepClient.run()."""
    name = options.name
    auv = CoopAuv(options.sound_speed_mps, options.heading_noise_radprtHz)
    bus = LockstepClient(name + "_python", PERIOD_S)
    bus.subscribe(name + ".ahrs", shoal.ins_t, auv.on_ahrs)
    bus.subscribe(name + ".compass", shoal.compass_t, auv.on_compass)
    bus.subscribe(name + ".pressure", shoal.pressure_t, auv.on_pressure)
    bus.subscribe(name + ".gps", shoal.gps_data_t, auv.on_gps)
    bus.subscribe(name + ".dvl", shoal.dvl_t, auv.on_dvl)
    bus.subscribe(name + ".modem", shoal.acoustic_received_t, auv.on_modem)

    timeout = iter(range(round(60 / PERIOD_S), -1, -1))

    def decide(utime):
        if auv.ekf is not None:
            bus.publish(name + ".python_estimate", auv.estimate())
        elif next(timeout, None) == 0:
            missing = "heading" if auv.yaw_rad is None else "GPS fix"
            print(f"{name}: no estimate after a minute, as there was no {missing}", file=sys.stderr)

    bus.decide = decide
    return auv, bus


def parse(arguments=None):
    parser = argparse.ArgumentParser(description="Estimates where an AUV is, by dead reckoning and acoustic ranges.")
    parser.add_argument("--name", default="auv", help="vehicle; auv")
    parser.add_argument("--sound-speed-mps", type=float, default=1500.0, help="converts travel times to ranges")
    parser.add_argument("--heading-noise-radprtHz", type=float, default=0.035, help="noise of the heading, rad in 1 s")
    return parser.parse_args(arguments)


if __name__ == "__main__":
    attach(parse())[1].run()
