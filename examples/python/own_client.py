# SPDX-License-Identifier: BSD-3-Clause
# %% [markdown]
# # Own client
# A program that takes part in a run over LCM, in lockstep: the world waits at each tick for its decision.  It drives a
# rover towards a wall and stops 1 m before it.  Makes `own_client.png`.
#
# The run is started here, in another thread.  It may as well be `shoal run minimal --duration 15 --await pilot` in a
# terminal, on this machine or another one; the result is the same, bit for bit.

# %%
import threading

import matplotlib.pyplot as plt

import shoal

runs = []
simulator = threading.Thread(target=lambda: runs.append(
    shoal.run('minimal', duration_s=15, bus='lcm', wait_for=['pilot'])))
simulator.start()

# %% [markdown]
# Subscribe, join, and decide at each tick, when all messages up to its time were handled.

# %%
ahead_m, commands = [], []


def on_lidar(scan):
    """Called for each scan of the rover."""
    ahead_m.append((scan.utime, scan.ranges[scan.nranges // 2]))


with shoal.Client('pilot') as client:
    client.subscribe('rover1.lidar', on_lidar, shoal.messages.planar_lidar_t)
    client.join(0.1)  # a tick every 0.1 s of simulated time
    for utime in client.ticks():
        command = shoal.messages.twist_command_t(utime=utime)
        command.forward_mps = 0.5 if ahead_m and ahead_m[-1][1] > 1 else 0
        client.publish('rover1.drive.cmd', command)
        commands.append((utime, command.forward_mps))
    print(f'end: {client.end}, {client.counts}')
simulator.join()
print(f'{runs[0]}, run hash {runs[0].run_hash}')

# %%
figure, axes = plt.subplots(2, figsize=(7, 5), sharex=True, layout='constrained')
start = commands[0][0]
axes[0].plot([(utime - start) / 1e6 for utime, _ in ahead_m], [meters for _, meters in ahead_m])
axes[0].axhline(1, color='0.7', label='where it is to stop')
axes[0].legend()
axes[0].set_ylabel('distance ahead in m')
axes[1].step([(utime - start) / 1e6 for utime, _ in commands], [speed for _, speed in commands], where='post')
axes[1].set_ylabel('commanded speed in m/s')
axes[1].set_xlabel('time in s')
figure.savefig('own_client.png')
