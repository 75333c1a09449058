# SPDX-License-Identifier: BSD-3-Clause
"""The estimator `naive` in Python, a template for your own:

    shoal-nav --log run.lcm --algorithm naive,python:examples/navigation/naive.Naive

It estimates the position only, without the lasting errors of devices.  docs/guides/compare_estimators.md has the calls.
"""

import numpy as np
from shoal_nav import pack, unpack


class Naive:
    def start(self, s):
        self.t, self.x, self.v = s.time, s.position.copy(), np.zeros(2)
        self.P = s.position_std**2 * np.eye(2)

    def moved(self, t, v, q):
        dt = t - self.t
        self.x += v * dt
        self.P += q * dt
        self.t, self.v = t, v

    def fix(self, t, p, std):
        self.update(np.eye(2), p - self.x, std**2 * np.eye(2))

    def heard(self, m):
        if len(m.payload) < 12:
            return
        y, B = unpack(m.payload)  # what the sender said of itself
        d = self.x - y
        h = np.hypot(np.linalg.norm(d), m.own_z - m.z)
        u = d[None] / h
        self.update(u, np.array([m.range - h]), m.std**2 + u @ B @ u.T)

    def say(self, t, max_bytes):
        return pack(self.x, self.P)

    def now(self, t):
        return self.x + self.v * (t - self.t), self.P

    def update(self, H, r, R):
        K = self.P @ H.T @ np.linalg.inv(H @ self.P @ H.T + R)
        J = np.eye(2) - K @ H
        self.x = self.x + K @ r
        self.P = J @ self.P @ J.T + K @ R @ K.T
