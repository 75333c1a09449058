#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Makes the references `own_*.csv` of tests/fidelity/cases.yaml: vehicles by their published equations, integrated by
the classical Runge-Kutta method.

    make_references.py FOLDER [NAME ...]    writes FOLDER/NAME.csv, by default all
    make_references.py --check FOLDER       compares the files there with what it makes

It shares neither code nor files with Shoal: the equations are those of Fossen (Handbook of Marine Craft Hydrodynamics
and Motion Control, 2011, ch. 6 to 9), written for velocities over ground with the rigid body apart from the water; what
Shoal adds (emerging, foils, stalled flow) is written from docs/models/marine.md, marine_actuators.md and
coefficients.md.  Axes: north-east-down, forward-right-down; SI units.  The attitude is a matrix, so that no angle is
singular.
"""

import math
import os
import sys

RAD = math.pi / 180


# Vectors of three and matrices of three rows.

def cross(a, b):
    return (a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0])


def times(factor, a):
    return (factor * a[0], factor * a[1], factor * a[2])


def plus(*vectors):
    return (sum(v[0] for v in vectors), sum(v[1] for v in vectors), sum(v[2] for v in vectors))


def minus(a, b):
    return (a[0] - b[0], a[1] - b[1], a[2] - b[2])


def dot(a, b):
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]


def turn(R, v):
    """From body axes to north-east-down."""
    return (dot(R[0], v), dot(R[1], v), dot(R[2], v))


def turn_back(R, v):
    return tuple(R[0][i] * v[0] + R[1][i] * v[1] + R[2][i] * v[2] for i in range(3))


def matrix_of(phi, theta, psi):
    cf, sf, ct, st, cp, sp = (math.cos(phi), math.sin(phi), math.cos(theta), math.sin(theta), math.cos(psi),
                              math.sin(psi))
    return ((cp * ct, cp * st * sf - sp * cf, cp * st * cf + sp * sf),
            (sp * ct, sp * st * sf + cp * cf, sp * st * cf - cp * sf),
            (-st, ct * sf, ct * cf))


def inverse(matrix):
    """Gauss and Jordan with pivots."""
    n = len(matrix)
    rows = [list(row) + [float(i == j) for j in range(n)] for i, row in enumerate(matrix)]
    for i in range(n):
        best = max(range(i, n), key=lambda k: abs(rows[k][i]))
        rows[i], rows[best] = rows[best], rows[i]
        pivot = rows[i][i]
        rows[i] = [x / pivot for x in rows[i]]
        for k in range(n):
            if k != i and rows[k][i] != 0:
                f = rows[k][i]
                rows[k] = [x - f * y for x, y in zip(rows[k], rows[i])]
    return [row[n:] for row in rows]


def smooth(share):
    share = min(max(share, 0.0), 1.0)
    return share * share * (3 - 2 * share)


def emerging(depth, height):
    """Share under water of what is `height` high."""
    return smooth(0.5 + depth / height)


# The water around.

class Sea:
    """Steady current, wind, and one wave in deep water (Airy)."""

    def __init__(self, g=9.80665, density=1025.0, current=(0, 0, 0), wind=(0, 0, 0), wave=None):
        self.g, self.density, self.current, self.wind = g, density, current, wind
        self.wave = wave
        if wave:
            height, period, direction = wave  # m, s, rad from north to east
            self.a, self.omega = height / 2, 2 * math.pi / period
            self.k = self.omega ** 2 / g
            self.to = (math.cos(direction), math.sin(direction))

    def phase(self, x, y, t):
        return self.k * (self.to[0] * x + self.to[1] * y) - self.omega * t

    def surface(self, x, y, t):
        """Height over still water."""
        return self.a * math.cos(self.phase(x, y, t)) if self.wave else 0.0

    def motion(self, p, t):
        """Velocity and acceleration of the water."""
        if not self.wave:
            return self.current, (0, 0, 0)
        theta = self.phase(p[0], p[1], t)
        fade = math.exp(-self.k * max(0.0, p[2] + self.a * math.cos(theta)))
        v, c, s = self.a * self.omega * fade, math.cos(theta), math.sin(theta)
        along, up = v * c, v * s
        velocity = plus(self.current, (along * self.to[0], along * self.to[1], -up))
        along, up = v * self.omega * s, -v * self.omega * c
        return velocity, (along * self.to[0], along * self.to[1], -up)


# Vehicles.

def integral_of_strips(v, r, half):
    """Integrals over x of |v + x r| (v + x r), and of x times it, exactly."""
    def piece(a, b):
        sign = 1 if v + r * (a + b) / 2 >= 0 else -1
        d = [(b ** n - a ** n) / n for n in range(1, 5)]
        return (sign * (v * v * d[0] + 2 * v * r * d[1] + r * r * d[2]),
                sign * (v * v * d[1] + 2 * v * r * d[2] + r * r * d[3]))
    cuts = [-half, half]
    if r != 0 and -half < -v / r < half:
        cuts.insert(1, -v / r)
    pieces = [piece(a, b) for a, b in zip(cuts, cuts[1:])]
    return sum(p[0] for p in pieces), sum(p[1] for p in pieces)


def between(table, x):
    """Linear between pairs, constant beyond."""
    if x <= table[0][0]:
        return table[0][1]
    for (a, fa), (b, fb) in zip(table, table[1:]):
        if x <= b:
            return fa + (x - a) / (b - a) * (fb - fa)
    return table[-1][1]


class Craft:
    """Published coefficients of a vehicle.  `added`: 6 numbers or 6 rows; `terms`: (row, first, second, |first|?,
    coefficient) as forces."""

    munk = True  # False: as MSS remus100, no coupling of sway and heave with turning by added mass
    fade = 0.0   # linear surge damping falls by exp(-fade speed)

    def __init__(self, mass, inertia, added, linear=(0,) * 6, quadratic=(0,) * 6, terms=(), r_g=(0, 0, 0),
                 r_b=(0, 0, 0), about_origin=False, weight=None, buoyancy=None, volume=None, height=1.0, length=0.0,
                 waterline=None, cross_flow=None, lift=None, windage=None):
        self.mass, self.r_g, self.r_b = mass, r_g, r_b
        x, y, z = r_g
        steiner = [[y * y + z * z, -x * y, -x * z], [-x * y, x * x + z * z, -y * z], [-x * z, -y * z, x * x + y * y]]
        at_origin = [[(inertia[i] if i == j else 0.0) + (0 if about_origin else mass * steiner[i][j])
                      for j in range(3)] for i in range(3)]
        self.inertia = at_origin
        S = [[0, -z, y], [z, 0, -x], [-y, x, 0]]
        self.rigid = [[0.0] * 6 for _ in range(6)]
        for i in range(3):
            self.rigid[i][i] = mass
            for j in range(3):
                self.rigid[i][3 + j] = -mass * S[i][j]
                self.rigid[3 + i][j] = mass * S[i][j]
                self.rigid[3 + i][3 + j] = at_origin[i][j]
        self.added = [[(added[i] if i == j else 0.0) for j in range(6)] for i in range(6)] \
            if not hasattr(added[0], '__len__') else [list(row) for row in added]
        self.inverses = {}
        self.linear, self.quadratic, self.terms = linear, quadratic, terms
        self.weight, self.buoyancy, self.volume = weight, buoyancy, volume
        self.height, self.length = height, length
        self.waterline, self.cross_flow, self.lift, self.windage = waterline, cross_flow, lift, windage
        self.actuators = []

    def share(self, depth, down):
        if self.waterline:
            return 1.0
        return smooth(0.5 + (depth + dot(down, self.r_b)) / (self.height + abs(down[0]) * self.length))

    def inverse_mass(self, share):
        if share == 1:
            if 1 not in self.inverses:
                self.inverses[1] = inverse([[a + b for a, b in zip(p, q)] for p, q in zip(self.rigid, self.added)])
            return self.inverses[1]
        return inverse([[a + share * b for a, b in zip(p, q)] for p, q in zip(self.rigid, self.added)])

    def damping(self, nu, density):
        """Of the whole hull under water, at the velocity through it."""
        tau = [-(d + q * abs(v)) * v for d, q, v in zip(self.linear, self.quadratic, nu)]
        if self.fade:
            tau[0] += self.linear[0] * nu[0] * (1 - math.exp(-self.fade * math.sqrt(dot(nu[:3], nu[:3]))))
        for row, first, second, absolute, coefficient in self.terms:
            tau[row] += coefficient * (abs(nu[first]) if absolute else nu[first]) * nu[second]
        if self.cross_flow:
            length, height, table, reynolds = self.cross_flow
            C = between(table, math.hypot(nu[1], nu[2]) * reynolds) if len(table) > 1 else table[0][1]
            scale = -0.5 * density * height * C
            force, moment = integral_of_strips(nu[1], nu[5], length / 2)
            tau[1] += scale * force
            tau[5] += scale * moment
            force, moment = integral_of_strips(nu[2], -nu[4], length / 2)
            tau[2] += scale * force
            tau[4] -= scale * moment
        if self.lift:
            area, water, slope, drag0, induced = self.lift
            u, w = nu[0], nu[2]
            plane = math.hypot(u, w)
            if plane > 1e-12:
                q = 0.5 * (water or density) * dot(nu[:3], nu[:3]) * area
                alpha = math.atan2(w, abs(u))
                C = slope * alpha
                kept = 1 - smooth(abs(alpha) / (math.pi / 4) - 1)
                lift, drag = q * C * kept, q * (drag0 + induced * C * C)
                tau[0] += -drag * u / plane + (lift if u >= 0 else -lift) * w / plane
                tau[2] += -drag * w / plane - lift * abs(u) / plane
        return tau

    def rate(self, t, p, R, v, w, levels, sea):
        """d(nu)/dt."""
        down = R[2]
        v_sea, a_sea = sea.motion(p, t)
        v_c = turn_back(R, v_sea)
        v_r = minus(v, v_c)
        roll, pitch, depth = math.atan2(down[1], down[2]), math.asin(min(max(-down[0], -1), 1)), 0.0
        slope_roll = slope_pitch = 0.0
        if self.waterline and sea.wave:
            L, B = self.waterline['length'], self.waterline['beam']
            at = [sea.surface(p[0] + q[0], p[1] + q[1], t) for q in
                  (turn(R, (L / 2, 0, 0)), turn(R, (-L / 2, 0, 0)), turn(R, (0, -B / 2, 0)), turn(R, (0, B / 2, 0)))]
            slope_pitch, slope_roll = math.atan((at[0] - at[1]) / L), math.atan((at[2] - at[3]) / B)
            depth = p[2] + sum(at) / 4
        else:
            depth = p[2] + sea.surface(p[0], p[1], t)
        share = self.share(depth, down)
        nu_r = tuple(v_r) + tuple(w)
        tau = [share * f for f in self.damping(nu_r, sea.density)]

        def add(force, moment=(0, 0, 0)):
            for i in range(3):
                tau[i] += force[i]
                tau[3 + i] += moment[i]

        # Weight and buoyancy.
        weight = self.weight or self.mass * sea.g
        if self.waterline:
            line = self.waterline
            pitch, roll = pitch - slope_pitch, roll - slope_roll
            add((0, 0, -line['heave'] * depth - line['coupling'] * pitch),
                (-line['roll'] * roll, -line['pitch'] * pitch - line['coupling'] * depth, 0))
        else:
            full = self.buoyancy if self.buoyancy is not None else \
                self.volume * sea.density * sea.g if self.volume else weight
            add(times(weight, down), cross(self.r_g, times(weight, down)))
            up = times(-full * share, down)
            add(up, cross(self.r_b, up))
        # Wind (Fossen 2011, eq. 8.23 to 8.30).
        if self.windage:
            air = minus(turn_back(R, sea.wind), v)
            frontal, lateral, c_x, c_y, c_n, height, length = self.windage
            speed = math.hypot(air[0], air[1])
            gamma = -math.atan2(-air[1], -air[0])
            q = 0.5 * 1.225 * speed * speed
            Y = q * c_y * math.sin(gamma) * lateral
            add((-q * c_x * math.cos(gamma) * frontal, Y, 0),
                (Y * height, 0, q * c_n * math.sin(2 * gamma) * lateral * length))
        for actuator, level in zip(self.actuators, levels):
            force, moment = actuator.wrench(level, p, R, v_r, w, sea, t)
            add(force, moment)
        # The rigid body, over ground (Fossen 2011, ch. 3).
        f = times(self.mass, cross(w, plus(v, cross(w, self.r_g))))
        Iw = tuple(dot(row, w) for row in self.inertia)
        add(times(-1, f), times(-1, plus(cross(w, Iw), times(self.mass, cross(self.r_g, cross(w, v))))))
        # The water: Kirchhoff's equations, through the water.
        momentum = [share * sum(row[j] * nu_r[j] for j in range(6)) for row in self.added]
        a, b = tuple(momentum[:3]), tuple(momentum[3:])
        if self.munk:
            add(times(-1, cross(w, a)), times(-1, plus(cross(v_r, a), cross(w, b))))
        else:
            add((0, a[2] * w[0], -a[1] * w[0]), times(-1, cross(w, b)))
            tau[3] -= a[2] * v_r[1] - a[1] * v_r[2]
        # M_A d(v_r)/dt, where d(v_c)/dt in body axes is the acceleration of the water less w x v_c.
        a_c = minus(turn_back(R, a_sea), cross(w, v_c))
        for i in range(6):
            tau[i] += share * sum(self.added[i][j] * a_c[j] for j in range(3))
        if sea.wave:  # Froude and Krylov: the displaced water accelerates with the wave
            displaced = times(self.mass * share, turn_back(R, a_sea))
            add(displaced, cross(self.r_b, displaced))
        if not self.munk:
            # In the set without the coupling the water carries the rigid body too: relative velocities in all terms.
            g = times(self.mass, cross(w, v_c))
            add(g, times(self.mass, cross(self.r_g, cross(w, v_c))))
            rigid = [sum(self.rigid[i][j] * cross(w, v_c)[j] for j in range(3)) for i in range(6)]
            add(times(-1, rigid[:3]), times(-1, rigid[3:]))
        inv = self.inverse_mass(share)
        return [sum(row[j] * tau[j] for j in range(6)) for row in inv]


# Actuators.  Each has a level, which follows its command; positions and axes as in vehicle files: forward, left, up.

def frd(v):
    return (v[0], -v[1], -v[2])


class Actuator:
    """`lag`: time constant of the level.  `speed`: its largest rate, without lag.  Commands: from `low` to `high`."""

    def __init__(self, column, low, high, lag=0.0, speed=math.inf, dead=0.0):
        self.column, self.low, self.high, self.lag, self.speed, self.dead = column, low, high, lag, speed, dead

    def limited(self, command):
        return 0.0 if abs(command) < self.dead else min(max(command, self.low), self.high)

    def after(self, level, target, dt):
        if self.lag > 0:
            return target + (level - target) * math.exp(-dt / self.lag)
        return level + min(max(target - level, -self.speed * dt), self.speed * dt)


class Wrench(Actuator):
    """Six columns, force and torque, forward-right-down."""

    def __init__(self, columns):
        super().__init__(columns, -math.inf, math.inf)

    def limited(self, command):
        return command

    def after(self, level, target, dt):
        return target

    def wrench(self, level, p, R, v_r, w, sea, t):
        return tuple(level[:3]), tuple(level[3:])


class Thruster(Actuator):
    def __init__(self, column, at, axis, thrust, low, high, torque=None, disc=None, **more):
        super().__init__(column, low, high, **more)
        self.at, self.axis, self.thrust, self.torque, self.disc = frd(at), frd(axis), thrust, torque, disc

    def wrench(self, level, p, R, v_r, w, sea, t):
        inflow = dot(self.axis, plus(v_r, cross(w, self.at)))
        share = 1.0
        if self.disc:
            here = plus(p, turn(R, self.at))
            share = emerging(here[2] + sea.surface(here[0], here[1], t), self.disc)
        force = times(share * self.thrust(level, inflow, sea.density), self.axis)
        moment = cross(self.at, force)
        if self.torque:
            moment = plus(moment, times(share * self.torque(level, inflow, sea.density), self.axis))
        return force, moment


class BodyFin(Actuator):
    """Fin of MSS: lift by its own angle and the speed of the origin.  `y` is the second axis of the fin."""

    def __init__(self, column, at, y, area, slope, limit, span):
        super().__init__(column, -limit, limit)
        self.at, self.y, self.area, self.slope, self.span = frd(at), frd(y), area, slope, span

    def wrench(self, level, p, R, v_r, w, sea, t):
        across = dot(self.y, v_r)
        share = emerging(plus(p, turn(R, self.at))[2], self.span)
        lift = share * 0.5 * sea.density * (v_r[0] ** 2 + across ** 2) * self.area * self.slope * level
        force = plus((-lift * level, 0, 0), times(lift, self.y))
        return force, cross(self.at, force)


class CoefficientFin(Actuator):
    """Force and moment per angle and square of the forward speed."""

    def __init__(self, column, force, moment, limit, span):
        super().__init__(column, -limit, limit)
        self.force, self.moment, self.span = force, moment, span

    def wrench(self, level, p, R, v_r, w, sea, t):
        scale = level * v_r[0] ** 2 * emerging(p[2], self.span)
        return times(scale, self.force), times(scale, self.moment)


class Foil(Actuator):
    """Vertical fin in the flow where it is: lift, induced drag, and a plate across the flow when it stalls."""

    def __init__(self, column, at, area, aspect, drag0, limit, speed):
        super().__init__(column, -limit, limit, speed=speed)
        self.at, self.area, self.aspect, self.drag0 = frd(at), area, aspect, drag0
        self.slope = math.pi * aspect / (1 + math.sqrt(1 + aspect * aspect / 4))

    def wrench(self, level, p, R, v_r, w, sea, t):
        v = plus(v_r, cross(w, self.at))
        x, y = v[0], -v[1]  # forward and left
        speed = math.hypot(x, y)
        if speed < 1e-6:
            return (0, 0, 0), (0, 0, 0)
        x, y = x / speed, y / speed
        along, across = x * math.cos(level) + y * math.sin(level), x * math.sin(level) - y * math.cos(level)
        if along < 0:
            along, across = -along, -across
        a = math.atan2(across, along)
        C_L = self.slope * a
        C_D = self.drag0 + C_L ** 2 / (math.pi * 0.9 * self.aspect)
        stalled = smooth((abs(a) - 15 * RAD) / (10 * RAD))
        plate = 1.2 * across ** 2
        C_L += stalled * (math.copysign(plate * along, across) - C_L)
        C_D += stalled * (self.drag0 + plate * abs(across) - C_D)
        share = emerging(plus(p, turn(R, self.at))[2], math.sqrt(self.area * self.aspect))
        q = share * 0.5 * sea.density * speed ** 2 * self.area
        force = frd((q * (-C_D * x - C_L * y), q * (-C_D * y + C_L * x), 0))
        return force, cross(self.at, force)


class Engine(Actuator):
    """Buoyancy engine at the origin; its level is a volume."""

    def wrench(self, level, p, R, v_r, w, sea, t):
        height = 2 * (3 * max(self.high, -self.low) / (4 * math.pi)) ** (1 / 3)
        return times(-sea.density * sea.g * level * emerging(p[2], height), R[2]), (0, 0, 0)


class Battery(Actuator):
    """Mass that slides along x."""

    def __init__(self, column, mass, limit, speed):
        super().__init__(column, -limit, limit, speed=speed)
        self.mass = mass

    def wrench(self, level, p, R, v_r, w, sea, t):
        return (0, 0, 0), cross((level, 0, 0), times(self.mass * sea.g, R[2]))


# The sets.

DRAG = [  # of a cylinder by its Reynolds number (MSS remus100), times its factor for the length, which jumps at 2e5
    (10211, 0.79834665), (15544, 0.79570244), (24435, 0.79870362), (35720, 0.80027031), (60881, 0.80048846),
    (86175, 0.79921924), (118086, 0.80075949), (149262, 0.80085204), (200000, 0.80096991), (200000, 0.98590723),
    (214709, 0.98594929), (230940, 0.97730797), (271581, 0.9513433), (297098, 0.90451578), (325252, 0.82121893),
    (361943, 0.72752319), (409798, 0.57653595), (475302, 0.43251384), (524735, 0.33186111), (578922, 0.26593641),
    (638293, 0.23126533), (744046, 0.24175372), (853238, 0.26265726), (1068686, 0.31659639), (1393381, 0.38270009),
    (1831850, 0.43839678), (2258396, 0.47496375), (2899012, 0.51154699), (3663279, 0.52729178), (4937305, 0.55174299)]


def remus100():
    craft = Craft(31.900515, (0.11738256, 4.22073226, 4.22073226),
                  (0.86330184, 30.29360551, 30.29360551, 0.03524912, 3.59385625, 3.59385625),
                  linear=(1.63819086, 3.10970604, 3.10970604, 0.61082586, 11.2056326, 7.81458851), r_g=(0, 0, 0.02),
                  height=0.19, length=1.6, cross_flow=(1.6, 0.19, DRAG, 1.6e6),
                  lift=(0.2128, None, 0.26599679, 0.05703920, 6.25451004))
    craft.munk, craft.fade = False, 3.0
    D = 0.14

    def thrust(rpm, inflow, density):
        n = rpm / 60
        loss = 0.41737033 * max(0.944 * inflow, 0) / D if n > 0 else 0
        return 0.9 * density * D ** 4 * abs(n) * (0.4566 * n - loss)

    def torque(rpm, inflow, density):
        n = rpm / 60
        loss = 0.05850422 * max(0.944 * inflow, 0) / D if n > 0 else 0
        return 0.1 * density * D ** 5 * abs(n) * (0.07 * n - loss)

    span = math.sqrt(0.0133 * 2)
    craft.actuators = [Thruster('n_rpm', (-0.8, 0, 0), (1, 0, 0), thrust, -1525, 1525, torque, D),
                       BodyFin('delta_r', (-0.80768, 0, 0), (0, 1, 0), 0.0133, 0.5, 20 * RAD, span),
                       BodyFin('delta_s', (-0.80768, 0, 0), (0, 0, 1), 0.0133, 0.7, 20 * RAD, span)]
    return craft


def otter(windage=None):
    craft = Craft(55, (10.26432, 13.75, 13.75), (5.28152101, 82.5, 55, 2.052864, 11, 23.375),
                  linear=(77.55443248, 137.5, 546.48049, 50.02366, 218.18786, 39.325),
                  quadratic=(0, 0, 0, 0, 0, 393.25), r_g=(0.2, 0, -0.2),
                  cross_flow=(2, 0.13414634, [(0, 0.84703524)], 1e6),
                  waterline={'length': 2, 'beam': 1.08, 'heave': 7541.4375, 'coupling': 1508.2875, 'roll': 1077.3296,
                             'pitch': 2853.4339}, windage=windage)

    def thrust(n, inflow, density):
        return (0.01108 if n > 0 else 0.006445) * abs(n) * n

    craft.actuators = [Thruster(column, (-0.8, y, 0), (1, 0, 0), thrust, -101.7367, 103.9309)
                       for column, y in (('n_left', 0.395), ('n_right', -0.395))]
    return craft


def prestero():
    X, Y, Z, K, M, N = range(6)
    u, v, w, p, q, r = range(6)
    added = [[0.0] * 6 for _ in range(6)]
    for row, column, derivative in ((X, u, -0.93), (Y, v, -35.5), (Y, r, 1.93), (Z, w, -35.5), (Z, q, -1.93),
                                    (K, p, -0.0704), (M, w, -1.93), (M, q, -4.88), (N, v, 1.93), (N, r, -4.88)):
        added[row][column] = -derivative
    terms = [(row, a, a, True, c) for row, a, c in
             ((X, u, -1.62), (Y, v, -1310), (Y, r, 0.632), (Z, w, -131), (Z, q, -0.632), (K, p, -0.13), (M, w, 3.18),
              (M, q, -188), (N, v, -3.18), (N, r, -94))]
    terms += [(row, u, b, False, c) for row, b, c in
              ((Y, v, -28.6), (Y, r, 6.15), (Z, w, -28.6), (Z, q, -6.15), (M, w, -10.57), (M, q, -3.93), (N, v, 10.57),
               (N, r, -3.93))]
    craft = Craft(30.4791029561672, (0.177, 3.45, 3.45), added, terms=terms, r_g=(0, 0, 0.0196), about_origin=True,
                  weight=299, buoyancy=306, height=0.191, length=1.33)
    limit, span = 13.6 * RAD, math.sqrt(0.0066 * 2)
    craft.actuators = [CoefficientFin('delta_r', (0, 9.64, 0), (0, 0, -6.15), limit, span),
                       CoefficientFin('delta_s', (0, 0, -9.64), (0, -6.15, 0), limit, span),
                       Wrench(('tau_X', 'tau_Y', 'tau_Z', 'tau_K', 'tau_M', 'tau_N'))]
    return craft


T200 = [(-1, -39.91), (-0.75, -26.58), (-0.5, -14.12), (-0.25, -4.71), (-0.07, 0), (0.07, 0), (0.25, 5.88),
        (0.5, 17.85), (0.75, 33.54), (1, 51.48)]
WRENCH = ('tau_X', 'tau_Y', 'tau_Z', 'tau_K', 'tau_M', 'tau_N')


def bluerov2_heavy():
    craft = Craft(13.5, (0.26, 0.23, 0.37), (6.36, 7.12, 18.68, 0.189, 0.135, 0.222), linear=(13.7, 0, 33.0, 0, 0.8, 0),
                  quadratic=(141, 217, 190, 1.19, 0.47, 1.5), r_b=(0, 0, -0.01), volume=0.0134, height=0.25)

    def thruster(column, at, axis):
        return Thruster(column, at, axis, lambda level, inflow, density: between(T200, level), -1, 1, disc=0.1, lag=0.1,
                        dead=0.07)

    def flat(degrees):
        return (math.cos(degrees * RAD), math.sin(degrees * RAD), 0)

    craft.actuators = [Wrench(WRENCH)]
    for column, at, axis in (('front_right', (0.156, -0.111, -0.085), flat(45)),
                             ('front_left', (0.156, 0.111, -0.085), flat(-45)),
                             ('back_right', (-0.156, -0.111, -0.085), flat(135)),
                             ('back_left', (-0.156, 0.111, -0.085), flat(-135)),
                             ('up_front_right', (0.12, -0.218, 0), (0, 0, 1)),
                             ('up_front_left', (0.12, 0.218, 0), (0, 0, 1)),
                             ('up_back_right', (-0.12, -0.218, 0), (0, 0, 1)),
                             ('up_back_left', (-0.12, 0.218, 0), (0, 0, 1))):
        craft.actuators.append(thruster(column, at, axis))
    return craft


def bluerov2():
    craft = Craft(11.5, (0.16, 0.16, 0.16), (5.5, 12.7, 14.57, 0.12, 0.12, 0.12),
                  linear=(4.03, 6.22, 5.18, 0.07, 0.07, 0.07), quadratic=(18.18, 21.66, 36.99, 1.55, 1.55, 1.55),
                  r_g=(0, 0, 0.02), about_origin=True, weight=112.8, buoyancy=114.8, height=0.254)
    craft.actuators = [Wrench(WRENCH)]
    return craft


def drifter():
    # Its file has z up.
    return Craft(12, (1.5, 1.5, 0.6), (200, 200, 10, 20, 20, 10), linear=(2, 2, 20, 10, 10, 5),
                 quadratic=(615, 615, 60, 80, 80, 40), r_g=(0, 0, 0.6),
                 waterline={'length': 1.0, 'beam': 1.0, 'heave': 503, 'coupling': 0, 'roll': 60, 'pitch': 60})


def glider():
    Y, M, N = 1, 4, 5
    craft = Craft(50, (4, 12, 11), (5, 60, 70, 0, 0, 0), linear=(0, 0, 0, 20, 60, 20),
                  terms=((Y, 0, 1, False, -90), (M, 0, 2, False, -100), (N, 0, 1, False, 80)), r_g=(0, 0, 0.009),
                  height=0.22, length=1.5, lift=(1, 2, 132.5, 2.15, 0.0014240))
    craft.actuators = [Engine('volume', -2.5e-4, 2.5e-4, speed=2e-5), Battery('battery', 9, 0.05, 0.002),
                       Foil('rudder', (-0.75, 0, 0.16), 0.02, 2, 0, 35 * RAD, 20 * RAD)]
    return craft


# Integration.

def angles_of(R):
    return math.atan2(R[2][1], R[2][2]), math.asin(min(max(-R[2][0], -1), 1)), math.atan2(R[1][0], R[0][0])


def integrate(craft, sea, start, inputs, duration, row_s, step_s):
    """Rows of time, state and inputs.  `start`: 12 numbers; `inputs`: function of time to a dict of columns."""
    p, R, v, w = tuple(start[:3]), matrix_of(*start[3:6]), tuple(start[6:9]), tuple(start[9:12])
    levels = [(0,) * 6 if isinstance(actuator, Wrench) else 0.0 for actuator in craft.actuators]
    rows, steps = [], int(round(row_s / step_s))
    psi_before, turns = start[5], 0

    def derivative(t, y, now):
        at, M, v, w = y
        nu_dot = craft.rate(t, at, M, v, w, now, sea)
        M_dot = tuple(cross(row, w) for row in M)  # rows of R S(w)
        return turn(M, v), M_dot, tuple(nu_dot[:3]), tuple(nu_dot[3:])

    def moved(y, h, d):
        return (plus(y[0], times(h, d[0])), tuple(plus(a, times(h, b)) for a, b in zip(y[1], d[1])),
                plus(y[2], times(h, d[2])), plus(y[3], times(h, d[3])))

    for k in range(int(round(duration / row_s)) + 1):
        t = k * row_s
        given = inputs(t)
        phi, theta, psi = angles_of(R)
        turns += round((psi_before - psi - 2 * math.pi * turns) / (2 * math.pi))
        psi += 2 * math.pi * turns
        psi_before = psi
        rows.append([t, *p, phi, theta, psi, *v, *w, *given.values()])
        targets = []
        for actuator in craft.actuators:
            if isinstance(actuator.column, tuple):
                targets.append(tuple(given.get(column, 0.0) for column in actuator.column))
            else:
                targets.append(actuator.limited(given.get(actuator.column, 0.0)))
        for i in range(steps):
            t = k * row_s + i * step_s
            now, half, then = ([a.after(level, target, dt) for a, level, target in
                                zip(craft.actuators, levels, targets)] for dt in (0.0, step_s / 2, step_s))
            y = (p, R, v, w)
            k1 = derivative(t, y, now)
            k2 = derivative(t + step_s / 2, moved(y, step_s / 2, k1), half)
            k3 = derivative(t + step_s / 2, moved(y, step_s / 2, k2), half)
            k4 = derivative(t + step_s, moved(y, step_s, k3), then)
            for factor, d in ((1, k1), (2, k2), (2, k3), (1, k4)):
                y = moved(y, factor * step_s / 6, d)
            p, R, v, w = y
            levels = then
    return rows


# The runs: start, inputs and water of each.

def steps_of(*pairs):
    """Value by time: the last whose time has come."""
    def at(t):
        value = pairs[0][1]
        for since, this in pairs:
            if t >= since - 1e-9:
                value = this
        return value
    return at


def columns(**functions):
    return lambda t: {name: f(t) if callable(f) else f for name, f in functions.items()}


def wrench(X=0.0, Y=0.0, Z=0.0, K=0.0, M=0.0, N=0.0):
    return columns(tau_X=X, tau_Y=Y, tau_Z=Z, tau_K=K, tau_M=M, tau_N=N)


def together(*inputs):
    return lambda t: {name: value for part in inputs for name, value in part(t).items()}


def start_at(x=0.0, y=0.0, z=0.0, phi=0.0, theta=0.0, psi=0.0, u=0.0, v=0.0, w=0.0, p=0.0, q=0.0, r=0.0):
    return (x, y, z, phi * RAD, theta * RAD, psi * RAD, u, v, w, p, q, r)


def sequence(start, row, values):
    return steps_of((0, 0.0), *((start + i * row, value) for i, value in enumerate(values)))


# Levels that cross each part of the table of a T200 to both sides, and wait on the edge of its dead band.
SWEEP = (1, 0.068, -1, -0.068, 0.9, 0.3, 0.6, 0.15, -0.2, -0.9, -0.4, -0.65, 0.072, 0)


def thruster_inputs():
    """The four level thrusters in a sequence, and the four upright in another; no group turns the vehicle much."""
    level, upright = sequence(0.5, 0.3, SWEEP), sequence(0.8, 0.35, SWEEP)
    later = sequence(0.6, 0.3, SWEEP)
    return together(wrench(), columns(front_right=level, front_left=level, back_right=later, back_left=later,
                                      up_front_right=upright, up_front_left=upright, up_back_right=upright,
                                      up_back_left=upright))


REMUS_SEA = dict(g=9.82178486, density=1026)
WAVE = (0.08, 1.6, 50 * RAD)

RUNS = {
    # name: vehicle, water, start, inputs, duration s, row s, step s
    'own_remus100_limits': lambda: (
        remus100(), Sea(current=(0.2, -0.15, 0.05), **REMUS_SEA), start_at(z=20, u=1, psi=20),
        columns(n_rpm=steps_of((0, 1700), (40, 900)),
                delta_r=steps_of((0, 0), (4, 25 * RAD), (18, -25 * RAD), (32, 0)),
                delta_s=steps_of((0, 0), (10, 0.1), (24, 25 * RAD), (26, -25 * RAD), (28, 0))), 50, 0.2, 0.01),
    'own_remus100_sideways': lambda: (
        remus100(), Sea(**REMUS_SEA), start_at(z=20, v=3.4, w=0.1, u=1.5), columns(n_rpm=1000, delta_r=0, delta_s=0),
        5.2, 0.05, 0.0025),
    'own_remus100_drift': lambda: (
        remus100(), Sea(**REMUS_SEA), start_at(z=20, v=0.09, w=-0.08, u=0.3), columns(n_rpm=100, delta_r=0, delta_s=0),
        56, 0.2, 0.02),
    'own_remus100_surface': lambda: (
        remus100(), Sea(**REMUS_SEA), start_at(z=0.12, u=1.2, theta=-10),
        columns(n_rpm=1400, delta_r=0.02, delta_s=steps_of((0, 0), (3, -0.2), (5, 0))), 10, 0.05, 0.005),
    'own_otter_astern': lambda: (
        otter(), Sea(g=9.81), start_at(u=0.5, psi=10),
        columns(n_left=steps_of((0, 120), (10, 120), (20, -120), (40, 30)),
                n_right=steps_of((0, 120), (10, 80), (20, -120), (30, -60), (40, 30))), 50, 0.2, 0.02),
    'own_otter_waves': lambda: (
        otter(), Sea(g=9.81, wave=WAVE), start_at(psi=5), columns(n_left=40, n_right=35), 12, 0.1, 0.01),
    'own_otter_autopilot_wind': lambda: (
        otter((0.2, 0.45, 0.7, 0.8, 0.05, 0.15, 2)), Sea(g=9.81, wind=(-4, 6, 0), current=(0.1, 0.2, 0)),
        start_at(u=1, v=0.3, z=0.04, phi=5, theta=3, r=0.2, psi=30),
        columns(n_left=steps_of((0, 120), (10, 60), (20, -120), (35, 30)),
                n_right=steps_of((0, 120), (10, 80), (20, -120), (30, -60), (35, 20))), 45, 0.2, 0.02),
    'own_otter_autopilot_waves': lambda: (
        otter((0.2, 0.45, 0.7, 0.8, 0.05, 0.15, 2)), Sea(g=9.81, wind=(-4, 6, 0), wave=WAVE), start_at(psi=5),
        columns(n_left=40, n_right=35), 12, 0.1, 0.01),
    'own_prestero_limits': lambda: (
        prestero(), Sea(g=9.81), start_at(z=4, u=1.5, psi=5),
        together(columns(delta_r=steps_of((0, 0), (3, 20 * RAD), (9, -20 * RAD), (14, 0)),
                         delta_s=steps_of((0, 0), (5, -20 * RAD), (7, 20 * RAD), (9, 0))),
                 wrench(X=8, Y=steps_of((0, 2), (10, 0)), Z=1, K=-0.3)), 20, 0.1, 0.01),
    'own_prestero_surface': lambda: (
        prestero(), Sea(g=9.81), start_at(z=0.35, u=0.6, theta=4, phi=5),
        together(columns(delta_r=0.02, delta_s=0.02), wrench(X=3.86, K=-0.3)), 12, 0.05, 0.005),
    'own_bluerov2h_thrusters': lambda: (
        bluerov2_heavy(), Sea(g=9.82, density=1000), start_at(z=8, phi=5, theta=-4, psi=30), thruster_inputs(),
        7, 0.05, 0.0025),
    'own_bluerov2h_surface': lambda: (
        bluerov2_heavy(), Sea(g=9.82, density=1000), start_at(z=0.5, phi=5, theta=-4),
        wrench(X=10, Z=steps_of((0, -12), (5, -2))),
        10, 0.05, 0.005),
    'own_bluerov2_surface': lambda: (
        bluerov2(), Sea(g=9.81, density=1000), start_at(z=0.5, phi=5, theta=-4),
        wrench(X=steps_of((0, 5), (6, 0)), Y=4, Z=-3, N=0.3), 10, 0.05, 0.005),
    'own_drifter_decay': lambda: (
        drifter(), Sea(g=9.81, current=(0.3, -0.2, 0)), start_at(z=0.05, phi=8, theta=-6, psi=25, p=0.2, q=-0.1, r=0.5),
        lambda t: {}, 30, 0.1, 0.01),
    'own_drifter_waves': lambda: (
        drifter(), Sea(g=9.81, wave=WAVE), start_at(psi=5), lambda t: {}, 12, 0.1, 0.01),
    'own_glider_dive': lambda: (
        glider(), Sea(g=9.81, current=(0.05, 0.1, 0)), start_at(z=2, u=0.2, psi=10, phi=3),
        columns(volume=steps_of((0, -3e-4), (50, 3e-4)), battery=steps_of((0, 0.06), (35, -0.06)),
                rudder=steps_of((0, 0), (10, 0.1), (20, -40 * RAD), (40, 0.3), (55, 40 * RAD))), 90, 0.5, 0.02),
    'own_glider_surface': lambda: (
        glider(), Sea(g=9.81), start_at(z=0.5, u=0.3, theta=15, phi=2),
        columns(volume=2e-4, battery=-0.01, rudder=0.2), 28, 0.1, 0.01),
}


def text_of(name):
    craft, sea, start, inputs, duration, row_s, step_s = RUNS[name]()
    rows = integrate(craft, sea, start, inputs, duration, row_s, step_s)
    heads = ['t', 'x', 'y', 'z', 'phi', 'theta', 'psi', 'u', 'v', 'w', 'p', 'q', 'r', *inputs(0.0)]
    return '\n'.join([','.join(heads), *(','.join(f'{value + 0.0:.10g}' for value in row) for row in rows), ''])


def difference(made, kept):
    """Largest difference of two files; infinity when they have other columns or rows."""
    made, kept = made.splitlines(), kept.splitlines()
    if len(made) != len(kept) or made[0] != kept[0]:
        return math.inf
    return max(abs(float(a) - float(b)) for one, other in zip(made[1:], kept[1:])
               for a, b in zip(one.split(','), other.split(',')))


def check(folder):
    """Compares the files with what the script makes; rounding differs between C libraries."""
    wrong = 0
    for name in RUNS:
        with open(os.path.join(folder, name + '.csv'), encoding='ascii') as kept:
            apart = difference(text_of(name), kept.read())
        print(f'{name}: {apart:.2g}')
        wrong += not apart < 1e-7
    return f'{wrong} files differ' if wrong else 0


def main(folder, names):
    for name in names or RUNS:
        with open(os.path.join(folder, name + '.csv'), 'w', encoding='ascii') as out:
            out.write(text_of(name))


if __name__ == '__main__':
    if len(sys.argv) == 3 and sys.argv[1] == '--check':
        sys.exit(check(sys.argv[2]))
    if len(sys.argv) < 2 or not set(sys.argv[2:]) <= set(RUNS):
        sys.exit(__doc__)
    main(sys.argv[1], sys.argv[2:])
