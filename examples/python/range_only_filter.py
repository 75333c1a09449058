# SPDX-License-Identifier: BSD-3-Clause
# %% [markdown]
# # Range-only filter
# A rover measures its distance to two beacons at known places, and has wheel odometry.  An extended Kalman filter
# estimates position and yaw from both, and is compared with the truth.  Makes `range_only_filter.png`.  SECONDS:
# simulated time.

# %%
import os

import matplotlib.pyplot as plt
import numpy as np

import shoal

SECONDS = float(os.environ.get('SECONDS', '120'))
BEACONS = {'west': [-6.0, 4.0, 1.0], 'east': [8.0, -3.0, 1.0]}
RANGE_STD_M, HEIGHT_M = 0.1, 0.4
with open('rover_ranging.yaml', 'w', encoding='utf-8') as file:
    file.write(f"""include: rover.yaml
shoal: 1
vehicle: rover_ranging
devices:
  - name: ranging
    type: range_beacon
    position_m: [0, 0, {HEIGHT_M}]
    rate_hz: 2
    beacons:
      - {{name: west, position_m: {BEACONS['west']}}}
      - {{name: east, position_m: {BEACONS['east']}}}
    range_noise: {{gaussian_std: {RANGE_STD_M}}}
""")
world = shoal.World({'shoal': 1, 'name': 'ranging', 'vehicles': [{'name': 'rover1', 'file': 'rover_ranging.yaml'}],
                     'objects': [{'name': 'ground', 'fixed': True, 'parts': [{'shape': 'plane'}]}]}, seed=2)

# %% [markdown]
# The filter: state x, y, yaw.  Odometry gives the motion between two reports, with an error that grows with it.


# %%
class Filter:
    """Extended Kalman filter (Thrun, Burgard, Fox, Probabilistic Robotics, 2005, table 3.3)."""

    def __init__(self):
        self.x = np.array([0.5, -0.5, 0.1])  # it does not know where it starts
        self.P = np.diag([1.0, 1.0, 0.2]) ** 2

    def predict(self, forward_m, turn_rad):
        """Moves by an arc.  The variances of its errors grow with the distance and with the turn."""
        yaw = self.x[2] + turn_rad / 2
        self.x += [forward_m * np.cos(yaw), forward_m * np.sin(yaw), turn_rad]
        F = np.array([[1, 0, -forward_m * np.sin(yaw)], [0, 1, forward_m * np.cos(yaw)], [0, 0, 1]])
        along, turning = 0.0002 * forward_m, 0.0001 * forward_m + 0.0004 * abs(turn_rad)
        G = np.array([[np.cos(yaw), 0], [np.sin(yaw), 0], [0, 1]])
        self.P = F @ self.P @ F.T + G @ np.diag([along, turning]) @ G.T

    def update(self, beacon, range_m):
        """Takes the distance to a beacon into account."""
        away = np.array([*self.x[:2], HEIGHT_M]) - beacon
        expected = np.linalg.norm(away)
        H = np.array([[away[0] / expected, away[1] / expected, 0]])
        S = H @ self.P @ H.T + RANGE_STD_M ** 2
        K = self.P @ H.T / S
        self.x = self.x + (K * (range_m - expected))[:, 0]
        self.P = (np.eye(3) - K @ H) @ self.P


# %%
ekf, before = Filter(), None
odometry, ranging = world.subscribe('rover1.odometry'), world.subscribe('rover1.ranging')
rows = []
while world.time_s < SECONDS:
    world.publish('rover1.drive.cmd', shoal.messages.twist_command_t(
        utime=world.utime, forward_mps=0.6, turn_radps=0.25 * np.sin(0.1 * world.time_s) + 0.05))
    world.run_until(world.time_s + 0.05)
    for report in odometry:
        if before is not None:
            ekf.predict(np.hypot(report.x_m - before.x_m, report.y_m - before.y_m), report.theta_rad - before.theta_rad)
        before = report
    for report in ranging:
        for name, range_m in zip(report.beacon, report.range_m):
            ekf.update(BEACONS[name], range_m)
    true_m = world.state('rover1')['position_m'][:2]
    error = ekf.x[:2] - true_m
    rows.append([world.time_s, *true_m, *ekf.x[:2], *np.sqrt(np.diag(ekf.P)[:2]), error @ np.linalg.solve(
        ekf.P[:2, :2], error)])
rows = np.array(rows)
errors = rows[:, 3:5] - rows[:, 1:3]
late = rows[:, 0] > SECONDS / 4
print(f'rms error {np.sqrt((errors[late] ** 2).sum(axis=1).mean()):.3f} m, mean NEES {rows[late, 7].mean():.2f} (2 is ideal)')

# %%
figure, axes = plt.subplots(1, 2, figsize=(11, 5), layout='constrained')
axes[0].plot(rows[:, 1], rows[:, 2], 'k', label='truth')
axes[0].plot(rows[:, 3], rows[:, 4], label='estimate')
for name, place in BEACONS.items():
    axes[0].plot(*place[:2], '^', label=f'beacon {name}')
axes[0].set_aspect('equal', adjustable='datalim')
axes[0].set_xlabel('x east in m')
axes[0].set_ylabel('y north in m')
axes[0].legend()
for index, name in enumerate('xy'):
    line, = axes[1].plot(rows[:, 0], errors[:, index], label=f'error of {name}')
    for sign in (-2, 2):
        axes[1].plot(rows[:, 0], sign * rows[:, 5 + index], '--', color=line.get_color(), linewidth=0.8)
axes[1].set_ylim(-1, 1)
axes[1].set_xlabel('time in s')
axes[1].set_ylabel('error in m (dashed: twice its own sigma)')
axes[1].legend()
figure.savefig('range_only_filter.png')
