// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <numbers>
#include <optional>
#include <string>
#include <vector>

#include "sim/base/math.hpp"
#include "tests/sim/physics/gravity.hpp"

/// The same experiment in Shoal and in another engine.
namespace cross_check {

using sim::Matrix3d;
using sim::Pose;
using sim::Vector3d;

/// Homogeneous solid, centered in its frame C; a cylinder lies along its z axis.
struct Solid {
  enum class Shape { box, sphere, cylinder };
  Shape shape = Shape::box;
  Vector3d size_m = Vector3d::Ones();  ///< of a box
  double radius_m = 0, length_m = 0;   ///< of a sphere or cylinder
  double mass_kg = 1;

  /// Moments of inertia about the axes of C, kg m^2.
  Vector3d inertia_kgm2() const;
};

Solid box(const Vector3d& size_m, double mass_kg);
Solid sphere(double radius_m, double mass_kg);
Solid cylinder(double radius_m, double length_m, double mass_kg);

/// Joint of a body to the world or to a body before it, with a spring and a damper about the axis of a hinge.
struct Pivot {
  enum class Kind { hinge, ball };
  Kind kind = Kind::hinge;
  int parent = -1;  ///< index of a body; -1: the world
  Vector3d anchor_W = Vector3d::Zero();
  Vector3d axis_W = Vector3d::UnitY();  ///< of a hinge, at the start
  double stiffness_Nmprad = 0, damping_Nmsprad = 0;
  double rest_rad = 0;  ///< angle of the spring at rest, from that at the start
};

/// Body with its state at the start.  Bodies with a pivot do not collide.
struct BodyModel {
  Solid solid;
  Pose X_WC = Pose::Identity();
  Vector3d v_WC_W = Vector3d::Zero();  ///< of a body without a pivot
  Vector3d w_W = Vector3d::Zero();
  std::optional<Pivot> pivot;
};

struct Ground {
  double slope_rad = 0;  ///< falls towards +x, through the origin
  double friction = 0.8;
  double restitution = 0;
  Matrix3d R_WG() const { return Eigen::AngleAxisd(slope_rad, Vector3d::UnitY()).toRotationMatrix(); }
};

struct Model {
  std::vector<BodyModel> bodies;
  std::optional<Ground> ground;
  double gravity_mps2 = test::g;
};

/// State of a body: its frame C is at the center of mass.
struct BodyState {
  Matrix3d R_WC = Matrix3d::Identity();
  Vector3d p_WC = Vector3d::Zero(), v_WC_W = Vector3d::Zero(), w_W = Vector3d::Zero();
};

}  // namespace cross_check
