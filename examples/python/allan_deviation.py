# SPDX-License-Identifier: BSD-3-Clause
# %% [markdown]
# # Sensor calibration: Allan deviation
# Two inertial units at rest; the Allan deviation of their rates shows white noise (slope -1/2) and bias instability (the
# minimum).  Makes `allan_deviation.png`.  SECONDS: simulated time at rest; the longer, the further to the right.

# %%
import os

import matplotlib.pyplot as plt
import numpy as np

import shoal

SECONDS = float(os.environ.get('SECONDS', '1800'))
world = shoal.World('imu_bench', seed=1)
units = {name: world.subscribe(f'bench.{name}', capacity=10_000) for name in ('adis16470', 'stim300')}
rates = {name: [] for name in units}
while world.time_s < SECONDS:
    world.run_until(world.time_s + 60)
    for name, unit in units.items():
        rates[name] += [report.angular_velocity_radps[2] for report in unit]

# %% [markdown]
# The overlapping Allan deviation of a rate from its integral (IEEE Std 952-1997, annex C).

# %%
PERIOD_S = 0.01


def allan_deviation(rate, period_s):
    """Returns averaging times in s and deviations in the unit of the rate."""
    angle = np.concatenate([[0], np.cumsum(rate)]) * period_s
    counts = np.unique(np.logspace(0, np.log10(len(rate) // 9), 40).astype(int))
    deviations = [np.sqrt(np.mean((angle[2 * n:] - 2 * angle[n:-n] + angle[:-2 * n]) ** 2) / 2) / (n * period_s)
                  for n in counts]
    return counts * period_s, np.array(deviations)


figure, axes = plt.subplots(figsize=(7, 5), layout='constrained')
for name, values in rates.items():
    tau_s, deviation = allan_deviation(np.array(values), PERIOD_S)
    degph = np.degrees(deviation) * 3600
    line, = axes.loglog(tau_s, degph, label=name)
    # The angular random walk is the deviation at 1 s, as the white noise is.
    walk = degph[np.argmin(abs(tau_s - 1))]
    axes.loglog(tau_s, walk / np.sqrt(tau_s), ':', color=line.get_color())
    print(f'{name}: angular random walk {walk / 60:.3f} deg/sqrt(h), minimum {degph.min():.2f} deg/h')
axes.set_xlabel('averaging time in s')
axes.set_ylabel('Allan deviation in deg/h (dotted: white noise only)')
axes.grid(which='both', color='0.9')
axes.legend()
figure.savefig('allan_deviation.png')
