# SPDX-License-Identifier: BSD-3-Clause
# %% [markdown]
# # First run
# A world in this process: a rover drives towards a wall, while its lidar looks at it.  Makes `first_run.png`.

# %%
import matplotlib.pyplot as plt
import numpy as np

import shoal

world = shoal.World('minimal')  # a shipped world; or the path of a file, or a dict
print(world, world.devices('rover1'))

# %% [markdown]
# Send a command, and step the world.  The rover keeps the last command.

# %%
times, positions = [], []
while world.time_s < 12:
    ahead_m = world.last('rover1.lidar').ranges[90] if world.last('rover1.lidar') else 5
    world.publish('rover1.drive.cmd', shoal.messages.twist_command_t(
        utime=world.utime, forward_mps=0.5 if ahead_m > 1 else 0, turn_radps=0.03))
    world.run_until(world.time_s + 0.1)
    times.append(world.time_s)
    positions.append(world.state('rover1')['position_m'])
positions = np.array(positions)
print(f'after {world.time_s:g} s at {positions[-1].round(2)} m, state hash {world.state_hash():016x}')

# %% [markdown]
# The last scan, as points in world axes, and the track of the rover.

# %%
scan = world.last('rover1.lidar')
w, x, y, z = world.state('rover1')['orientation']
yaw_rad = np.arctan2(2 * (w * z + x * y), 1 - 2 * (y * y + z * z))
angles = yaw_rad + scan.rad0 + scan.radstep * np.arange(scan.nranges)
hits = scan.ranges < 19
figure, axes = plt.subplots(figsize=(7, 4), layout='constrained')
axes.plot(positions[:, 0], positions[:, 1], label='track')
axes.plot(positions[-1, 0] + (scan.ranges * np.cos(angles))[hits], positions[-1, 1] + (scan.ranges * np.sin(angles))[hits],
          '.', label='last scan')
axes.set_aspect('equal', adjustable='datalim')
axes.set_xlabel('x east in m')
axes.set_ylabel('y north in m')
axes.legend()
figure.savefig('first_run.png')
