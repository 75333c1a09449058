# SPDX-License-Identifier: BSD-3-Clause
"""Drives rover1 towards what is ahead, in lockstep with `shoal run`, and stops one meter before it."""
import sys

import shoal

ahead_m = 0.0


def on_lidar(scan):
    global ahead_m
    ahead_m = scan.ranges[scan.nranges // 2]


with shoal.Client("pilot") as client:
    client.subscribe("rover1.lidar", on_lidar)
    client.join(0.1)  # a tick every 0.1 s of simulated time
    for utime in client.ticks():  # all reports up to this time have been handled
        command = shoal.messages.twist_command_t(utime=utime)
        command.forward_mps = 0.5 if ahead_m > 1.0 else 0.0
        client.publish("rover1.drive.cmd", command)
print(f"the run is over, {ahead_m:.2f} m before the wall", file=sys.stderr)
