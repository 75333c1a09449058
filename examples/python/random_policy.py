# SPDX-License-Identifier: BSD-3-Clause
# %% [markdown]
# # A loop for reinforcement learning
# Many worlds at once with the interface of Gymnasium (which need not be installed), and a policy that acts at random.
# The task: drive to a point.  Makes `random_policy.png`.  WORLDS, STEPS: how many worlds, how many steps of each.

# %%
import os
import time

import matplotlib.pyplot as plt
import numpy as np

import shoal

WORLDS, STEPS = int(os.environ.get('WORLDS', '32')), int(os.environ.get('STEPS', '600'))
GOAL_M = np.array([2.0, 2.0])
rover = {'name': 'rover1', 'file': 'rover.yaml'}
world = {'shoal': 1, 'name': 'field', 'vehicles': [rover],
         'objects': [{'name': 'ground', 'fixed': True, 'parts': [{'shape': 'plane'}]}]}


def distance_m(observations):
    """Distance to the goal; the first two values of an observation are x and y."""
    return np.linalg.norm(observations[:, :2] - GOAL_M, axis=1)


envs = shoal.vector.VectorEnv(
    world, WORLDS, steps=10,
    actions=['rover1.drive.cmd:twist_command_t:forward_mps,turn_radps'], action_low=[0, -1.5], action_high=[1, 1.5],
    observations=['@rover1', 'rover1.odometry:forward_mps'],
    reward=lambda before, actions, after: distance_m(before) - distance_m(after),
    terminated=lambda after: distance_m(after) < 0.5,
    max_episode_s=20)

# %% [markdown]
# A policy sees the observations and returns the actions of all worlds.  This one draws them; each stays for a second.

# %%
observations, _ = envs.reset(seed=1)
random = np.random.default_rng(1)
actions, returns, sums, tracks = None, [], np.zeros(WORLDS), []
start = time.monotonic()
for step in range(STEPS):
    if step % 10 == 0:
        actions = random.uniform(envs.action_space.low, envs.action_space.high)
    observations, rewards, terminated, truncated, _ = envs.step(actions)
    sums += rewards
    ended = terminated | truncated
    returns += list(sums[ended])
    sums[ended] = 0
    tracks.append(np.where(ended[:, None], np.nan, observations[:, :2]))
rate = STEPS * WORLDS * 10 / (time.monotonic() - start)
print(f'{len(returns)} episodes, mean return {np.mean(returns or [np.nan]):.2f} m, {rate:.0f} steps of worlds per second')

# %%
figure, axes = plt.subplots(1, 2, figsize=(10, 4.5), layout='constrained')
tracks = np.array(tracks)
for track in tracks[:200].swapaxes(0, 1)[:12]:
    axes[0].plot(track[:, 0], track[:, 1], linewidth=0.8)
axes[0].plot(*GOAL_M, 'k*', markersize=12, label='goal')
axes[0].set_aspect('equal', adjustable='datalim')
axes[0].set_xlabel('x east in m')
axes[0].set_ylabel('y north in m')
axes[0].legend()
axes[1].hist(returns, bins=20)
axes[1].set_xlabel('return of an episode in m')
axes[1].set_ylabel('episodes')
axes[1].yaxis.get_major_locator().set_params(integer=True)
figure.savefig('random_policy.png')
