// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "sim/base/math.hpp"

// Closed forms that take more than a line.

namespace cross_check {

/// Period of a physical pendulum: 4 K(sin(amplitude / 2)) / omega, with the angular frequency of small swings.
double pendulum_period_s(double omega_radps, double amplitude_rad);

/// Period of the angular velocity, in its own axes, of a body without torque (Landau & Lifshitz, Mechanics, section
/// 37). Moments of inertia in ascending order about x, y and z.
double tumbling_period_s(const sim::Vector3d& inertia_kgm2, const sim::Vector3d& w_radps);

/// Slow rate of steady precession of a heavy symmetric top (Goldstein, Classical Mechanics, section 5.7): the smaller
/// root of I1 cos(tilt) r^2 - I3 w3 r + torque = 0.  `across_kgm2` I1 about the pivot, `along_kgm2` I3, `spin_radps` w3
/// of the body along its axis, `torque_Nm` of the weight for a horizontal axis.
double precession_radps(double across_kgm2, double along_kgm2, double spin_radps, double tilt_rad, double torque_Nm);

}  // namespace cross_check
