# SPDX-License-Identifier: BSD-3-Clause
# %% [markdown]
# # A sweep on a cluster
# How much the loss of messages costs a rover that localizes itself by its neighbors: a campaign over the loss
# probability, with several seeds at each point.  Its runs are jobs of Slurm where there is one, otherwise processes of
# this machine; the results are the same.  Makes `slurm_sweep.png`.  RUNS, SECONDS: seeds at each point, simulated time.

# %%
import os
import shutil
import sqlite3
import subprocess

import matplotlib.pyplot as plt
import numpy as np

RUNS, SECONDS = int(os.environ.get('RUNS', '20')), float(os.environ.get('SECONDS', '200'))
with open('loss_sweep.yaml', 'w', encoding='utf-8') as file:
    file.write(f"""shoal: 1
study: loss_sweep
world: coop_land
launch: true
duration_s: {SECONDS:g}
seeds: 1-{RUNS}
factors:
  - name: loss
    paths: [vehicles.rover1.devices.modem.loss_probability, vehicles.rover2.devices.modem.loss_probability]
    values: [0, 0.5, 0.9, 1]
figures: [cooperative.rms_m, odometry_only.rms_m]
""")

# %% [markdown]
# Plan, run, collect.  The same commands again continue what was interrupted; a run with a result is not repeated.

# %%
HAS_SLURM = shutil.which('sinfo') and subprocess.run('sinfo', capture_output=True, check=False).returncode == 0
ENGINE = 'slurm' if HAS_SLURM else 'local'


def study(*arguments):
    subprocess.run(['shoal', 'study', *arguments], check=True)


study('plan', 'loss_sweep.yaml', '--output', 'loss_sweep')
study('run', 'loss_sweep', '--engine', ENGINE, '--jobs', '2', *(['--chunk', '10'] if ENGINE == 'slurm' else []))
study('collect', 'loss_sweep')

# %% [markdown]
# The database has a row for each figure of each run.

# %%
with sqlite3.connect('loss_sweep/study.sqlite') as database:
    rows = database.execute("""SELECT factors.value, figures.name, figures.value FROM figures
        JOIN runs USING (run) JOIN factors USING (point) WHERE factors.name = 'loss'""").fetchall()
losses = sorted({float(loss) for loss, _, _ in rows})
figure, axes = plt.subplots(figsize=(6, 4.5), layout='constrained')
for name, label in [('cooperative.rms_m', 'with the messages that arrive'), ('odometry_only.rms_m', 'odometry alone')]:
    errors = [np.array([value for loss, of, value in rows if of == name and float(loss) == at]) for at in losses]
    medians = [np.median(at) for at in errors]
    spread = np.abs(np.array([np.percentile(at, [10, 90]) for at in errors]).T - medians)
    axes.errorbar(losses, medians, spread, marker='o', capsize=3, label=label)
    print(f'{name}: median ' + ', '.join(f'{median:.2f} m at {loss:g}' for loss, median in zip(losses, medians)))
axes.set_yscale('log')
axes.yaxis.set_major_formatter('{x:g}')
axes.yaxis.set_minor_formatter('{x:g}')
axes.set_xlabel('probability that a message is lost')
axes.set_ylabel('rms error in m, median and 10 to 90 %')
axes.legend(loc='lower center', bbox_to_anchor=(0.5, 1), ncols=2)  # above, where it hides nothing
figure.savefig('slurm_sweep.png')
