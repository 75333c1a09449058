# SPDX-License-Identifier: BSD-3-Clause
"""The filter of shoal-coop-auv in plain Python: position by dead reckoning and one-way ranges.

States: east, north (m), heading bias (rad), speed scale, range bias (m), drift of that (m/s).  The equations are in
docs/models/marine_ekf.md.
"""
import math
from collections import deque

N = 6


def diagonal(values):
    return [[values[i] if i == j else 0.0 for j in range(N)] for i in range(N)]


def times(a, b):
    return [[sum(a[i][k] * b[k][j] for k in range(N)) for j in range(N)] for i in range(N)]


def transposed(a):
    return [list(row) for row in zip(*a)]


def turned(v, angle):
    c, s = math.cos(angle), math.sin(angle)
    return c * v[0] - s * v[1], s * v[0] + c * v[1]


class MarineEkf:
    GATE = 10.83  # 99.9 % of chi-square with one degree
    MAX_REFUSALS = 5  # consecutive ones, before a state is considered wrong instead of the measurement
    BAD_CLOCK_MPS = 0.15  # 100 ppm, the worst error of common quartz clocks, times the speed of sound

    def __init__(self, time_s, position_m, position_std_m, states=4, heading_bias_std_rad=0.05, speed_scale_std=0.03,
                 range_bias_std_m=30.0, range_drift_std_mps=0.005, heading_noise=0.035, speed_noise=0.01):
        stds = [position_std_m, position_std_m, heading_bias_std_rad, speed_scale_std, range_bias_std_m,
                range_drift_std_mps]
        self.x = [position_m[0], position_m[1], 0.0, 0.0, 0.0, 0.0]
        self.P = diagonal([std ** 2 if i < states else 0.0 for i, std in enumerate(stds)])
        self.walks = [0.0, 0.0, 1e-4, 1e-5, 0.01, 1e-5]
        self.states = states
        self.heading_noise, self.speed_noise = heading_noise, speed_noise
        self.time_s = time_s
        self.motion = deque([(time_s, 0.0, 0.0)])  # measured, since the start
        self.refused_positions = 0
        self.trust = {}  # of a beacon: consecutive refusals, agreements in doubt, variance when the doubt started
        self.contradictions = deque(maxlen=2 * self.MAX_REFUSALS)  # beacon, time, innovation, its variance
        self.ranges_used = 0

    def predict(self, time_s, velocity_mps):
        """Predicts with a velocity over ground (east, north) as DVL and compass measure it."""
        dt = time_s - self.time_s
        if dt <= 0:
            return
        motion = velocity_mps[0] * dt, velocity_mps[1] * dt
        by_scale = turned(motion, self.x[2])
        moved = [(1 + self.x[3]) * m for m in by_scale]
        F = diagonal([1.0] * N)
        F[0][2], F[1][2] = -moved[1], moved[0]
        F[0][3], F[1][3] = by_scale
        F[4][5] = dt
        self.P = times(times(F, self.P), transposed(F))

        speed = math.hypot(*velocity_mps)
        along, across = self.speed_noise ** 2, self.speed_noise ** 2 + (speed * self.heading_noise) ** 2
        length = math.hypot(*moved)
        c, s = (moved[0] / length, moved[1] / length) if length > 0 else (1.0, 0.0)
        self.P[0][0] += (along * c * c + across * s * s) * dt
        self.P[1][1] += (along * s * s + across * c * c) * dt
        self.P[0][1] += (along - across) * c * s * dt
        self.P[1][0] = self.P[0][1]
        for i in range(2, self.states):
            self.P[i][i] += self.walks[i] ** 2 * dt

        self.x[0] += moved[0]
        self.x[1] += moved[1]
        self.x[4] += self.x[5] * dt
        self.time_s = time_s
        self.motion.append((time_s, self.motion[-1][1] + motion[0], self.motion[-1][2] + motion[1]))
        while self.motion[1][0] < time_s - 60:
            self.motion.popleft()

    def distance_since(self, time_s):
        """Returns the measured displacement from then to now; None when that is too long ago."""
        later = self.motion[-1]
        for mark in reversed(self.motion):
            if mark[0] <= time_s:
                part = (time_s - mark[0]) / (later[0] - mark[0]) if later[0] > mark[0] else 0.0
                return tuple(self.motion[-1][i] - mark[i] - part * (later[i] - mark[i]) for i in (1, 2))
            later = mark
        return None

    def update_range(self, time_s, range_m, std_m, beacon_m, beacon_covariance, own_z_m, beacon=0):
        """A slant range that arrived at time_s from a beacon at (east, north, up) with a covariance (ee, en, nn).

        What contradicts never makes the position less sure: the clock is wrong when two beacons or more contradict by
        the same amount, or by one that grows evenly, else it is the beacon, which is then in doubt until it agrees again
        for a while.
        """
        since = self.distance_since(time_s)
        if since is None:
            return False
        by_scale = turned(since, self.x[2])
        moved = [(1 + self.x[3]) * m for m in by_scale]
        d = self.x[0] - moved[0] - beacon_m[0], self.x[1] - moved[1] - beacon_m[1]
        distance = max(math.hypot(d[0], d[1], own_z_m - beacon_m[2]), 1.0)
        u = d[0] / distance, d[1] / distance
        age = self.time_s - time_s
        h = [u[0], u[1], u[0] * moved[1] - u[1] * moved[0], -u[0] * by_scale[0] - u[1] * by_scale[1], 1.0, -age]
        ee, en, nn = beacon_covariance
        sideways = self.P[0][0] + self.P[1][1] - sum(u[i] * u[j] * self.P[i][j] for i in (0, 1) for j in (0, 1))
        variance = (std_m ** 2 + u[0] ** 2 * ee + 2 * u[0] * u[1] * en + u[1] ** 2 * nn
                    + 3 * (sideways / (2 * distance)) ** 2)
        innovation = range_m - distance - self.x[4] + self.x[5] * age
        if not math.isfinite(innovation):
            return False
        opinion = self.opinion_of(beacon, innovation, self.variance_of(h) + variance)
        if opinion == "in doubt":
            return False
        if opinion == "contradicts":
            without_clock = self.variance_of(h[:4] + [0.0, 0.0]) + variance
            self.contradictions.append((beacon, time_s, innovation, without_clock))
            error = self.common_error()
            if error is None:
                return False
            self.open_clock(*error)
            innovation -= error[0]
        self.contradictions.clear()
        self.ranges_used += 1
        self.use(h, innovation, variance)
        return True

    def opinion_of(self, beacon, innovation, variance):
        refusals, agreements, doubted_at = self.trust.get(beacon, (0, 0, None))
        # A filter without other messages becomes uncertain, which does not make a contradicting beacon trustworthy.
        if not innovation ** 2 <= self.GATE * min(variance, doubted_at or variance):
            refusals += 1
            if refusals >= self.MAX_REFUSALS and not doubted_at:
                doubted_at = variance
            self.trust[beacon] = refusals, 0, doubted_at
            return "contradicts"
        if doubted_at and agreements + 1 < self.MAX_REFUSALS:
            self.trust[beacon] = 0, agreements + 1, doubted_at
            return "in doubt"
        self.trust.pop(beacon, None)
        return "agrees"

    def common_error(self):
        """Common excess of all contradictions now, the rate at which it grows, and the variance of the first; None
        when they are of one beacon, or do not agree.  A weighted straight line over the time before the last."""
        if self.states <= 4 or len(self.contradictions) < self.MAX_REFUSALS:
            return None
        if len({beacon for beacon, *_ in self.contradictions}) < 2:
            return None
        last = self.contradictions[-1][1]
        points = [(1 / variance, time_s - last, error) for _, time_s, error, variance in self.contradictions]
        w, wt, wtt = (sum(weight * t ** power for weight, t, _ in points) for power in (0, 1, 2))
        we, wte = (sum(weight * t ** power * error for weight, t, error in points) for power in (0, 1))
        now, rate, variance = we / w, 0.0, 1 / w
        spread = wtt - wt * wt / w  # its inverse is the variance of the rate
        slope = (wte - wt * we / w) / spread if spread > 0 else 0.0
        if self.states > 5 and slope ** 2 * spread > self.GATE:
            now, rate, variance = (we - slope * wt) / w, slope, 1 / w + (wt / w) ** 2 / spread
        if any((error - now - rate * t) ** 2 * weight > self.GATE for weight, t, error in points):
            return None
        return now, rate, variance

    def open_clock(self, error, rate, variance):
        """Corrects the lead of the own clock and its rate, both in range."""
        self.x[4] += error
        self.x[5] += rate
        drift_variance = max(self.P[5][5], rate ** 2)
        if self.ranges_used > 0:  # it was correct before: the clock drifts
            drift_variance = max(drift_variance, self.BAD_CLOCK_MPS ** 2)
        for i in range(N):
            self.P[i][4] = self.P[4][i] = self.P[i][5] = self.P[5][i] = 0.0
        self.P[4][4] = error ** 2 + variance
        if self.states > 5:
            self.P[5][5] = drift_variance
        self.trust.clear()

    def update_position(self, position_m, std_m):
        """Updates with a present GPS position: one coordinate after the other, as their errors are independent."""
        rows = [1.0, 0, 0, 0, 0, 0], [0, 1.0, 0, 0, 0, 0]
        innovations = [position_m[i] - self.x[i] for i in (0, 1)]
        fits = all(e ** 2 <= self.GATE * (self.variance_of(h) + std_m ** 2) for h, e in zip(rows, innovations))
        if not fits:
            self.refused_positions += 1
            if self.refused_positions < self.MAX_REFUSALS or not all(map(math.isfinite, innovations)):
                return False
            for i in (0, 1):  # overconfident and wrong: increase the variance
                self.P[i][i] += sum(e ** 2 for e in innovations)
        self.refused_positions = 0
        for i, h in enumerate(rows):
            self.use(h, position_m[i] - self.x[i], std_m ** 2)
        return True

    def variance_of(self, h):
        return sum(h[i] * h[j] * self.P[i][j] for i in range(N) for j in range(N))

    def use(self, h, innovation, variance):
        """Updates with a scalar measurement with the Jacobian h."""
        Ph = [sum(self.P[i][j] * h[j] for j in range(N)) for i in range(N)]
        k = [p / (sum(h[i] * Ph[i] for i in range(N)) + variance) for p in Ph]
        self.x = [self.x[i] + k[i] * innovation for i in range(N)]
        A = [[(1.0 if i == j else 0.0) - k[i] * h[j] for j in range(N)] for i in range(N)]
        self.P = times(times(A, self.P), transposed(A))  # Joseph form
        for i in range(N):
            for j in range(N):
                self.P[i][j] += k[i] * k[j] * variance
