# SPDX-License-Identifier: BSD-3-Clause
# %% [markdown]
# # Reading a record
# A run with its programs, recorded into an LCM event log; its messages as tables (DataFrame where pandas is installed)
# and as objects.  Makes `read_record.png`.  SECONDS: simulated time of the run.

# %%
import collections
import os

import matplotlib.pyplot as plt
import numpy as np

import shoal

SECONDS = float(os.environ.get('SECONDS', '120'))
run = shoal.run('coop_land', duration_s=SECONDS, bus='lcm', launch=True, record='coop_land.lcm', overwrite=True)
print(run, run.metrics)

# %% [markdown]
# What is in it: channels and numbers of messages.  `coop_land.mcap` would be read in the same way.

# %%
counts = collections.Counter(event.channel for event in shoal.read('coop_land.lcm'))
for channel, count in sorted(counts.items()):
    print(f'{channel:30} {count}')

# %% [markdown]
# The messages of a channel as columns, and those of two others as objects.

# %%
gps = shoal.table('coop_land.lcm', 'rover1.gps')
print(list(gps)[:10])
estimates = np.array([event.message.pos for event in shoal.read('coop_land.lcm', 'rover3.estimate')])
received = sum(event.channel == 'rover3.modem' for event in shoal.read('coop_land.lcm', 'rover3.modem'))
print(f'{len(estimates)} estimates, {received} packets received')

# %%
figure, axes = plt.subplots(figsize=(6, 6), layout='constrained')
axes.plot(gps['xyz_pos_0'], gps['xyz_pos_1'], '.', markersize=2, label='GPS of rover1')
axes.plot(estimates[:, 0], estimates[:, 1], label='estimate of rover3')
axes.set_aspect('equal', adjustable='datalim')
axes.set_xlabel('x east in m')
axes.set_ylabel('y north in m')
axes.legend()
figure.savefig('read_record.png')
