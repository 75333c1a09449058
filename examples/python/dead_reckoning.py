# SPDX-License-Identifier: BSD-3-Clause
# %% [markdown]
# # Monte Carlo of dead reckoning
# The same drive in many worlds with different seeds: how the error of wheel odometry grows.  Makes
# `dead_reckoning.png`.  RUNS, SECONDS: number of worlds, simulated time.

# %%
import os

import matplotlib.pyplot as plt
import numpy as np

import shoal

RUNS, SECONDS = int(os.environ.get('RUNS', '100')), float(os.environ.get('SECONDS', '60'))
world = {'shoal': 1, 'name': 'plain', 'vehicles': [{'name': 'rover1', 'file': 'rover.yaml'}],
         'objects': [{'name': 'ground', 'fixed': True, 'parts': [{'shape': 'plane'}]}]}
envs = shoal.vector.VectorEnv(
    world, RUNS, steps=50, actions=['rover1.drive.cmd:twist_command_t:forward_mps,turn_radps'],
    observations=['@rover1', 'rover1.odometry:x_m', 'rover1.odometry:y_m'])

# %% [markdown]
# All worlds get the same commands: a square of 5 m, again and again.

# %%
envs.reset(seed=1)
truth, reckoned = [], []
for step in range(int(SECONDS / envs.step_s)):
    turns = step % 28 >= 20  # 10 s straight on, 4 s of 0.39 rad/s
    observations, *_ = envs.step(np.tile([0.0 if turns else 0.5, np.pi / 8 if turns else 0.0], (RUNS, 1)))
    truth.append(observations[:, :2])
    reckoned.append(observations[:, -2:])
truth, reckoned = np.array(truth), np.array(reckoned)
errors = reckoned - truth  # (steps, runs, 2)
times = envs.step_s * np.arange(1, len(truth) + 1)
distance = np.linalg.norm(errors, axis=2)
print(f'after {times[-1]:g} s: rms error {np.sqrt(np.mean(distance[-1] ** 2)):.3f} m, '
      f'mean of the error {errors[-1].mean(axis=0).round(3)} m, spread {errors[-1].std(axis=0).round(3)} m')

# %% [markdown]
# The calibration errors of the wheels are the same in all runs and give the mean; the noise gives the spread.

# %%
figure, axes = plt.subplots(1, 2, figsize=(10, 4.5), layout='constrained')
axes[0].plot(truth[:, 0, 0], truth[:, 0, 1], 'k', label='truth of run 1')
axes[0].plot(reckoned[:, 0, 0], reckoned[:, 0, 1], label='odometry of run 1')
axes[0].plot(reckoned[-1, :, 0], reckoned[-1, :, 1], '.', markersize=3, label='ends of all runs by odometry')
axes[0].set_aspect('equal', adjustable='datalim')
axes[0].set_xlabel('x east in m')
axes[0].set_ylabel('y north in m')
axes[0].legend()
low, median, high = np.percentile(distance, [5, 50, 95], axis=1)
axes[1].fill_between(times, low, high, alpha=0.3, label='5 to 95 % of the runs')
axes[1].plot(times, median, label='median')
axes[1].set_xlabel('time in s')
axes[1].set_ylabel('error in m')
axes[1].legend(loc='upper left')  # errors grow to the right
figure.savefig('dead_reckoning.png')
