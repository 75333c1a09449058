# SPDX-License-Identifier: BSD-3-Clause
"""The estimator `naive` in Python, a template for your own:

    shoal-nav --log run.lcm --algorithm naive,python:examples/navigation/naive.Naive

An extended Kalman filter that treats received estimates as independent.  Without relative measurements, on_bearing().
docs/guides/own_estimator.md has the calls.
"""

import numpy as np
from shoal_nav import pack, unpack


class Naive:
    def start(self, s):
        e = s.errors
        self.e, self.of_team, self.c, self.gate = e, s.team_errors, s.sound_speed, s.gate
        self.start_t, self.t, self.v = s.time, s.time, np.zeros(2)
        # East and north (m), constant and slow heading error (rad), scale error of the speed, clock error (s) and drift.
        std = [s.position_std, s.position_std, e["heading_bias_rad"], e["slow_heading_rad"], e["speed_scale"],
               e["clock_s"], e["clock_drift"]]
        self.x, self.P = np.concatenate([s.position, np.zeros(5)]), np.diag(std) ** 2

    def predict(self, t, v, q):
        e, dt = self.e, t - self.t
        kept = np.exp(-dt / e["slow_heading_time_s"])
        F = np.eye(7)
        F[:2, 2] = F[:2, 3] = dt * np.array([-v[1], v[0]])
        F[:2, 4], F[3, 3], F[5, 6] = -dt * v, kept, dt
        self.x = F @ self.x + np.concatenate([dt * v, np.zeros(5)])
        self.P = F @ self.P @ F.T
        self.P[:2, :2] += q * dt
        grow = [e["heading_walk_radprts"] ** 2 * dt, e["slow_heading_rad"] ** 2 * (1 - kept**2), 0,
                e["clock_walk_srts"] ** 2 * dt, 0]
        self.P[2:, 2:] += np.diag(grow)
        self.t, self.v = t, v

    def fix(self, t, p, std):
        # Its slow error is the same in many fixes, which are of no use once the position is better known.
        if self.P[0, 0] > self.e["slow_fix_m"] ** 2:
            self.update(np.eye(2, 7), p - self.x[:2], (std**2 + self.e["slow_fix_m"] ** 2) * np.eye(2))

    def on_range(self, m):
        if len(m.payload) < 12:
            return
        y, B = unpack(m.payload)  # what the sender said of itself
        d = self.x[:2] - y
        h = max(np.hypot(np.linalg.norm(d), m.own_z - m.z), 0.1)
        u = d[None] / h
        clock, dt = self.of_team[m.sender], m.toa - self.start_t  # of the sender, which only it could estimate
        clock_var = clock["clock_s"] ** 2 + (clock["clock_drift"] * dt) ** 2 + clock["clock_walk_srts"] ** 2 * dt
        R = m.std**2 + self.c**2 * clock_var + u @ B @ u.T
        H = np.hstack([u, [[0, 0, 0, self.c, 0]]])
        self.update(H, np.array([m.range - h - self.c * self.x[5]]), R, self.gate)

    def make_payload(self, t, max_bytes):
        return pack(self.x[:2], self.P[:2, :2])

    def now(self, t):
        return self.x[:2] + self.v * (t - self.t), self.P[:2, :2]

    def update(self, H, r, R, gate=0):
        S = H @ self.P @ H.T + R
        if gate > 0 and r @ np.linalg.solve(S, r) > gate:
            return
        K = self.P @ H.T @ np.linalg.inv(S)
        J = np.eye(7) - K @ H
        self.x = self.x + K @ r
        self.P = J @ self.P @ J.T + K @ R @ K.T
