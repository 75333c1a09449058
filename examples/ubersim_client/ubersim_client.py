# SPDX-License-Identifier: BSD-3-Clause
"""UberSim's test client: adds its robot, which stands on two wheels, to a run in lockstep, balances it, and leaves.

    shoal run empty.yaml --await cmu &
    python3 ubersim_client.py

docs/guides/spawn_vehicles.md has the world.  ubersim_client.cpp is the same program in C++.
"""
import argparse
import math
import os
import sys

import shoal
import ubersim_robot

PERIOD_S = 0.01


def parse():
    parser = argparse.ArgumentParser(description='Adds a robot on two wheels to a run, balances it, and leaves.')
    parser.add_argument('file', nargs='?', default=os.path.join(os.path.dirname(__file__), 'segway.xml'))
    parser.add_argument('--name', help='of the robot and the client; <Name> by default')
    parser.add_argument('--position', nargs=2, type=float, default=[0, 0], metavar='M', help='east and north of <Offset>')
    parser.add_argument('--seconds', type=float, default=12, help='after which it leaves')
    parser.add_argument('--tilt', type=float, default=0, metavar='DEG', help='beyond its balance, from 2 to 5 s; to the other side to 8 s')
    parser.add_argument('--width', type=int, default=320, help='of its images, in pixels')
    return parser.parse_args()


class Balance:
    """UberSim's law: tilt, its rate, position and speed give the velocity of both wheels."""

    def __init__(self, robot):
        self.robot, self.tilt_rad, self.x_m, self.v_mps = robot, None, 0.0, 0.0

    def velocity_radps(self, tilt_rad, added_rad):
        rate = 0.0 if self.tilt_rad is None else (tilt_rad - self.tilt_rad) / PERIOD_S
        error = tilt_rad - self.robot.tilt_rad - added_rad
        self.tilt_rad = tilt_rad
        self.x_m += self.v_mps * PERIOD_S
        self.v_mps += 0.05 * (18 * error + 4.5 * rate + 0.4 * self.x_m + 1.0 * self.v_mps)
        return self.v_mps / self.robot.radius_m


def run(args, robot):
    tilts, images = [], []
    balance = Balance(robot)
    name = robot.entry['name']
    with shoal.Client(name) as client:
        client.join(PERIOD_S)
        channels = client.spawn(robot.entry)  # the world waits
        for device in channels.values():
            if device.type == 'inclinometer':
                client.subscribe(device.reports, lambda tilt: tilts.append(tilt.pitch_rad))
            if device.type == 'camera':
                client.subscribe(device.reports, lambda image: images.append((image.width, image.height)))
        motors = [device.commands for device in channels.values() if device.type == 'joint_drive']
        start = None
        for utime in client.ticks():
            start = start or utime
            elapsed_s = (utime - start) / 1e6
            if elapsed_s >= args.seconds:
                client.leave()
                break
            if not tilts:
                continue
            added_deg = args.tilt if 2 <= elapsed_s < 5 else -args.tilt if 5 <= elapsed_s < 8 else 0
            command = shoal.messages.joint_settings_t(
                utime=utime, axis=1, velocity=balance.velocity_radps(tilts[-1], math.radians(added_deg)),
                max_force=ubersim_robot.FORCE_NM, low_stop=math.nan, high_stop=math.nan)
            for motor in motors:
                client.publish(motor, command)
        end = client.end
    if not tilts or not images:
        sys.exit(f'{name}: the run was over before it had a report of an inclinometer and a camera')
    print(f'{name}: tilt {math.degrees(tilts[-1]):.2f} deg, balanced at {math.degrees(robot.tilt_rad):.2f} deg, '
          f'{balance.x_m:.2f} m from its start, {len(images)} images of {images[0][0]}x{images[0][1]}, end: {end}')


def main():
    args = parse()
    try:
        robot = ubersim_robot.read(args.file, args.width)
    except (OSError, ubersim_robot.Refused) as error:
        sys.exit(f'{args.file}: {getattr(error, "strerror", None) or error}')
    robot.entry['name'] = args.name or robot.entry['name']
    for i in range(2):
        robot.entry['position_m'][i] += args.position[i]
    try:
        run(args, robot)
    except shoal.Error as error:
        sys.exit(f'ubersim_client: {error}')


if __name__ == '__main__':
    main()
