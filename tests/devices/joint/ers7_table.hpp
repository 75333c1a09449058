// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cmath>
#include <numbers>
#include <string>
#include <vector>

/// The joints of the ERS-7 as Sony's sheet 115-01 has them, and their kinematics by homogeneous transforms: independent
/// of the vehicle file and of the physics.  Lengths in mm, angles in degrees; origin midway between the four J1 axes,
/// x forward, y left, z up, legs straight down.
namespace test::ers7 {

constexpr double degrees = 180 / std::numbers::pi;

struct Axis {
  const char* name;             ///< of the servo
  const char* moves;            ///< the body behind it; empty: only the next axis
  int parent;                   ///< row of the axis before it; -1: the torso
  std::array<double, 3> at_mm;  ///< a point of the axis, all joints at zero
  std::array<double, 3> along;  ///< unit vector, all joints at zero
  double low_stop, high_stop;   ///< hard stops
  double low, high;             ///< software limits
  double frame_deg;             ///< largest change in a frame of 8 ms; 0: not published
  const char* locator;          ///< CPC primitive locator
};

/// In the order of Sony's motion files.
constexpr std::array<Axis, 20> axes{{
    {"neck_tilt", "neck", -1, {67.5, 0, 19.5}, {0, -1, 0}, -80, 3, -75, 0, 1.46, "PRM:/r1/c1-Joint2:11"},
    {"head_pan", "", 0, {67.5, 0, 99.5}, {0, 0, 1}, -93, 93, -88, 88, 4.61, "PRM:/r1/c1/c2-Joint2:12"},
    {"head_nod", "head", 1, {67.5, 0, 99.5}, {0, -1, 0}, -20, 50, -15, 45, 2.65, "PRM:/r1/c1/c2/c3-Joint2:13"},
    {"mouth", "jaw", 2, {107.5, 0, 82}, {0, -1, 0}, -60, 0, -55, -3, 4.65, "PRM:/r1/c1/c2/c3/c4-Joint2:14"},
    {"ear_l", "ear_l", 2, {67.5, 42, 114}, {0, 0, -1}, 0, 15, 0, 10, 0, "PRM:/r1/c1/c2/c3/e5-Joint4:15"},
    {"ear_r", "ear_r", 2, {67.5, -42, 114}, {0, 0, 1}, 0, 15, 0, 10, 0, "PRM:/r1/c1/c2/c3/e6-Joint4:16"},
    {"lf_swing", "", -1, {65, 62.5, 0}, {0, -1, 0}, -120, 135, -115, 130, 2.23, "PRM:/r2/c1-Joint2:21"},
    {"lf_flap", "lf_upper", 6, {65, 62.5, 0}, {1, 0, 0}, -15, 93, -10, 88, 2.42, "PRM:/r2/c1/c2-Joint2:22"},
    {"lf_knee", "lf_lower", 7, {74, 62.5, -69.5}, {0, -1, 0}, -30, 127, -25, 122, 2.42, "PRM:/r2/c1/c2/c3-Joint2:23"},
    {"lh_swing", "", -1, {-65, 62.5, 0}, {0, 1, 0}, -135, 120, -130, 115, 2.23, "PRM:/r3/c1-Joint2:31"},
    {"lh_flap", "lh_upper", 9, {-65, 62.5, 0}, {1, 0, 0}, -15, 93, -10, 88, 2.42, "PRM:/r3/c1/c2-Joint2:32"},
    {"lh_knee", "lh_lower", 10, {-74, 62.5, -69.5}, {0, 1, 0}, -30, 127, -25, 122, 2.42, "PRM:/r3/c1/c2/c3-Joint2:33"},
    {"rf_swing", "", -1, {65, -62.5, 0}, {0, -1, 0}, -120, 135, -115, 130, 2.23, "PRM:/r4/c1-Joint2:41"},
    {"rf_flap", "rf_upper", 12, {65, -62.5, 0}, {-1, 0, 0}, -15, 93, -10, 88, 2.42, "PRM:/r4/c1/c2-Joint2:42"},
    {"rf_knee", "rf_lower", 13, {74, -62.5, -69.5}, {0, -1, 0}, -30, 127, -25, 122, 2.42, "PRM:/r4/c1/c2/c3-Joint2:43"},
    {"rh_swing", "", -1, {-65, -62.5, 0}, {0, 1, 0}, -135, 120, -130, 115, 2.23, "PRM:/r5/c1-Joint2:51"},
    {"rh_flap", "rh_upper", 15, {-65, -62.5, 0}, {-1, 0, 0}, -15, 93, -10, 88, 2.42, "PRM:/r5/c1/c2-Joint2:52"},
    {"rh_knee", "rh_lower", 16, {-74, -62.5, -69.5}, {0, 1, 0}, -30, 127, -25, 122, 2.42, "PRM:/r5/c1/c2/c3-Joint2:53"},
    {"tail_tilt", "", -1, {-102, 0, 33}, {0, 1, 0}, 0, 65, 5, 60, 6.95, "PRM:/r6/c1-Joint2:61"},
    {"tail_pan", "tail", 18, {-102, 0, 33}, {0, 0, -1}, -60, 60, -45, 45, 6.95, "PRM:/r6/c2-Joint2:62"},
}};

/// Homogeneous transform, row by row.
using Transform = std::array<std::array<double, 4>, 4>;

inline Transform product(const Transform& a, const Transform& b) {
  Transform c{};
  for (int i = 0; i < 4; ++i)
    for (int j = 0; j < 4; ++j)
      for (int k = 0; k < 4; ++k) c[i][j] += a[i][k] * b[k][j];
  return c;
}

/// Rotation about a line (Rodrigues).
inline Transform turn_about(const std::array<double, 3>& at_mm, const std::array<double, 3>& n, double angle_deg) {
  const double c = std::cos(angle_deg / degrees), s = std::sin(angle_deg / degrees);
  const double cross[3][3] = {{0, -n[2], n[1]}, {n[2], 0, -n[0]}, {-n[1], n[0], 0}};
  Transform out{};
  for (int i = 0; i < 3; ++i) {
    out[i][3] = at_mm[i];
    for (int j = 0; j < 3; ++j) {
      out[i][j] = (i == j ? c : 0) + (1 - c) * n[i] * n[j] + s * cross[i][j];
      out[i][3] -= out[i][j] * at_mm[j];
    }
  }
  out[3][3] = 1;
  return out;
}

/// Transform of each axis from its place at zero; the body behind an axis moves alike.
inline std::array<Transform, axes.size()> moved_by(const std::array<double, axes.size()>& angles_deg) {
  std::array<Transform, axes.size()> moved{};
  for (std::size_t i = 0; i < axes.size(); ++i) {
    moved[i] = turn_about(axes[i].at_mm, axes[i].along, angles_deg[i]);
    if (axes[i].parent >= 0) moved[i] = product(moved[static_cast<std::size_t>(axes[i].parent)], moved[i]);
  }
  return moved;
}

}  // namespace test::ers7
