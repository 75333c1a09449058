#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Rays by numerical integration, for the test of sim::Eigenrays: prints reference_rays.csv.

Each of 2000 rays starts at a random depth and angle in one of five profiles and is integrated over a random range by
Dormand and Prince's RK45 with the range as the variable, in the continuous profile and not in layers:

    dz/dr = tan a    da/dr = -c'(z) / c    dt/dr = 1 / (c cos a)         (a: angle below the horizontal)

so the ray from the start to its end is known without a search.  `spread` is |dz/dlaunch| / range, by two neighboring
rays: small near a caustic.
"""
import math
import random

ROWS = {
    'isothermal': [(0, 10.0, 35.0), (250, 10.0, 35.0)],
    'thermocline': [(0, 18.0, 35.0), (20, 18.0, 35.0), (40, 8.0, 35.0), (200, 8.0, 35.0)],
    'duct': [(0, 14.0, 35.0), (60, 14.0, 35.0), (90, 9.0, 35.0), (200, 7.0, 35.0)],
    'measured': [(0, 19.3, 34.1), (2, 19.25, 34.1), (4, 19.1, 34.15), (7, 18.2, 34.3), (9, 17.9, 34.3), (12, 16.0, 34.5),
                 (14, 13.1, 34.7), (17, 12.4, 34.75), (21, 11.2, 34.8), (28, 10.4, 34.85), (40, 9.6, 34.9),
                 (55, 9.1, 34.95), (80, 8.9, 35.0), (120, 8.6, 35.0)],
}
WATER_M = {'isothermal': 250, 'thermocline': 200, 'duct': 200, 'munk': 5000, 'measured': 120}
RANGE_M = {'isothermal': 3000, 'thermocline': 3000, 'duct': 3000, 'munk': 30000, 'measured': 3000}
RAYS = 400


def mackenzie(t, s, d):
    return (1448.96 + 4.591 * t - 5.304e-2 * t * t + 2.374e-4 * t ** 3 + 1.340 * (s - 35) + 1.630e-2 * d
            + 1.675e-7 * d * d - 1.025e-2 * t * (s - 35) - 7.139e-13 * t * d ** 3)


def speed(profile, z):
    """Speed of sound and its derivative by the depth."""
    if profile == 'munk':
        eta = 2 * (z - 1300) / 1300
        return (1500 * (1 + 0.00737 * (eta - 1 + math.exp(-eta))), 1500 * 0.00737 * (1 - math.exp(-eta)) * 2 / 1300)
    rows = ROWS[profile]
    i = 0
    while i + 2 < len(rows) and z >= rows[i + 1][0]:
        i += 1
    (z0, t0, s0), (z1, t1, s1) = rows[i], rows[i + 1]
    gt, gs = (t1 - t0) / (z1 - z0), (s1 - s0) / (z1 - z0)
    t, s = t0 + gt * (z - z0), s0 + gs * (z - z0)
    by_t = 4.591 - 2 * 5.304e-2 * t + 3 * 2.374e-4 * t * t - 1.025e-2 * (s - 35) - 7.139e-13 * z ** 3
    by_s = 1.340 - 1.025e-2 * t
    by_d = 1.630e-2 + 2 * 1.675e-7 * z - 3 * 7.139e-13 * t * z * z
    return mackenzie(t, s, z), by_t * gt + by_s * gs + by_d


A = [[], [1 / 5], [3 / 40, 9 / 40], [44 / 45, -56 / 15, 32 / 9],
     [19372 / 6561, -25360 / 2187, 64448 / 6561, -212 / 729],
     [9017 / 3168, -355 / 33, 46732 / 5247, 49 / 176, -5103 / 18656], [35 / 384, 0, 500 / 1113, 125 / 192, -2187 / 6784, 11 / 84]]
E = [71 / 57600, 0, -71 / 16695, 71 / 1920, -17253 / 339200, 22 / 525, -1 / 40]


def derivative(profile, z, a):
    c, g = speed(profile, z)
    return math.tan(a), -g / c, 1 / (c * math.cos(a))


def step(profile, y, h):
    k = []
    for row in A:
        z, a = (y[j] + h * sum(w * each[j] for w, each in zip(row, k)) for j in (0, 1))
        k.append(derivative(profile, z, a))
    new = tuple(y[j] + h * sum(w * each[j] for w, each in zip(A[6], k)) for j in range(3))
    errors = [abs(h * sum(w * each[j] for w, each in zip(E, k))) for j in range(3)]
    return new, max(errors[0] / 1e-8, errors[1] / 1e-12, errors[2] / 1e-13)


def knots(profile):
    return [] if profile == 'munk' else [row[0] for row in ROWS[profile]][1:-1]


def integrate(profile, z, a, length_m):
    """Returns depth, angle, time and numbers of bounces at the end.  Ends steps at kinks, surface and bottom."""
    y, r, h, bounces = (z, a, 0.0), 0.0, 1.0, [0, 0]
    edges = [0.0] + [float(k) for k in knots(profile)] + [float(WATER_M[profile])]
    while r < length_m:
        h = min(h, length_m - r)
        new, error = step(profile, y, h)
        if error > 1:
            h *= max(0.2, 0.9 * error ** -0.2)
            continue
        crossed = [e for e in edges if (y[0] - e) * (new[0] - e) < 0 and abs(y[0] - e) > 1e-9]
        if crossed:
            # Bisect the step to end at the nearest edge.
            edge = min(crossed, key=lambda e: abs(e - y[0]))
            low, high = 0.0, h
            for _ in range(60):
                middle = (low + high) / 2
                there, _ = step(profile, y, middle)
                if (y[0] - edge) * (there[0] - edge) > 0:
                    low = middle
                else:
                    high = middle
            new, _ = step(profile, y, high)
            r += high
            z1, a1, t1 = edge, new[1], new[2]
            if edge == edges[0] or edge == edges[-1]:
                a1 = -a1
                bounces[edge != edges[0]] += 1
            else:
                z1 = edge + math.copysign(1e-10, new[1])
            y = (z1, a1, t1)
            h = 0.1
            continue
        r += h
        y = new
        h *= min(4.0, 0.9 * max(error, 1e-10) ** -0.2)
    return y[0], y[1], y[2], bounces


def main():
    print('profile,source_m,receiver_m,range_m,launch_deg,arrival_deg,time_s,surface,bottom,spread')
    for profile in ['isothermal', 'thermocline', 'duct', 'munk', 'measured']:
        draw = random.Random(profile)
        done = 0
        while done < RAYS:
            z = draw.uniform(0.01, 0.95) * WATER_M[profile]
            a = math.radians(draw.uniform(-20, 20)) * draw.random()
            length_m = draw.uniform(0.02, 1) * RANGE_M[profile]
            end, angle, time_s, bounces = integrate(profile, z, a, length_m)
            if sum(bounces) > 3:
                continue
            d = 1e-6
            up, down = (integrate(profile, z, a + e, length_m)[0] for e in (-d, d))
            done += 1
            print(f'{profile},{z:.9f},{end:.9f},{length_m:.9f},{math.degrees(-a):.9f},{math.degrees(-angle):.9f},'
                  f'{time_s:.12f},{bounces[0]},{bounces[1]},{abs(down - up) / (2 * d) / length_m:.3e}')


if __name__ == '__main__':
    main()
