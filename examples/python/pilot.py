# SPDX-License-Identifier: BSD-3-Clause
"""Drives rover1 towards what is ahead, in lockstep with `shoal run`, and stops one metre before it."""
import sys

import shoal
from lockstep_client import LockstepClient

ahead_m = 0.0


def on_lidar(scan):
    global ahead_m
    ahead_m = scan.ranges[scan.nranges // 2]


def decide(utime):
    """Called at each tick, when all reports up to that time have been handled."""
    command = shoal.twist_command_t()
    command.utime = utime
    command.forward_mps = 0.5 if ahead_m > 1.0 else 0.0
    client.publish("rover1.drive.cmd", command)


client = LockstepClient("pilot", 0.1)  # a tick every 0.1 s of simulated time
client.subscribe("rover1.lidar", shoal.planar_lidar_t, on_lidar)
client.decide = decide
client.run()
print(f"the run is over, {ahead_m:.2f} m before the wall", file=sys.stderr)
