// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <ode/ode.h>

#include <cmath>
#include <limits>
#include <string>
#include <utility>

#include "sim/collision/collider.hpp"
#include "sim/model/physics_config.hpp"
#include "sim/ode/ode_math.hpp"
#include "sim/physics/body.hpp"

namespace sim {

/// Body as the classes of the step see it.  A free or kinematic body is an ODE body, whose numbers this class reads and
/// writes where they are, because ODE's setters would round them; a step without ODE writes them as ODE does.
///
/// A step moves a body in one of three ways: step_alone() if nothing touches it; ODE's solver, prepared by
/// leave_to_ode() and, with contacts, apply_plan(); or, if it is kinematic, between start_kinematic_step() and one of
/// the functions that end it.  Its parts are not marked as moved by the ways without ODE: mark_parts_as_moved().
class SteppedBody final : public Body {
 public:
  SteppedBody(std::string name, int number, int group, Motion motion, SceneMoves& moves)
      : Body(std::move(name), number, group, motion, moves) {}

  // Creation.
  /// Creates the ODE body in a world.
  void create(dWorldID world);
  /// Creates it in another world, in the same state, and returns the old one with its parts and joints.
  BodyHandle create_again(dWorldID world);
  /// Sets the mass given in the configuration, or that of the parts.  Throws ConfigError for one that ODE cannot step.
  void set_mass(const BodyConfig& config, const dMass& of_parts);
  /// Attaches the geom of a part, whose pose in the body is given.
  void add_geom(dGeomID geom, const PartConfig& part, const Pose& X_BG);
  CollisionBody for_collider() const;

  // Numbers of ODE, which are pointed to for as long as the ODE body exists.
  dBodyID ode() const { return ode_.get(); }
  const double* p_WC() const { return p_WC_; }
  const double* v_WC_W() const { return v_WC_W_; }
  const double* w_WB_W_of_ode() const { return w_WB_W_; }

  // Of a step.
  Motion motion_kind() const { return motion_; }
  using Body::add_gyroscopic_torque;
  using Body::apply_plan;
  using Body::end_kinematic_step;
  using Body::end_kinematic_step_alone;
  using Body::free;
  using Body::leave_to_ode;
  using Body::start_kinematic_step;
  using Body::step_alone;
  bool gyroscopic() const { return gyroscopic_; }
  bool planned() const { return planned_; }
  /// Whether forces are integrated for a step of ODE.
  bool takes_first_order_step() const { return first_order_ || first_order_now_; }
  void end_first_order_step() { first_order_now_ = false; }
  bool has_parts() const { return dBodyGetFirstGeom(ode_.get()) != nullptr; }
  void mark_parts_as_moved() const { dBodySetPosition(ode_.get(), p_WC_[0], p_WC_[1], p_WC_[2]); }

  // The box that FarGroups has for the body.
  /// Makes a box around the present position, and returns that position.
  Vector3d start_box(double leeway_m) {
    leeway_m_ = leeway_m;
    return box_center_W_ = to_eigen(p_WC_);
  }
  void forget_box() { leeway_m_ = std::numeric_limits<double>::infinity(); }
  bool left_its_box() const {
    // NaN has left.
    return !(std::abs(p_WC_[0] - box_center_W_[0]) <= leeway_m_ && std::abs(p_WC_[1] - box_center_W_[1]) <= leeway_m_ &&
             std::abs(p_WC_[2] - box_center_W_[2]) <= leeway_m_);
  }

  // The speed from which on Leaps looks at the body.
  void set_leap_speed(double squared_m2ps2) { leap_m2ps2_ = squared_m2ps2; }
  bool may_leap() const {
    return v_WC_W_[0] * v_WC_W_[0] + v_WC_W_[1] * v_WC_W_[1] + v_WC_W_[2] * v_WC_W_[2] > leap_m2ps2_;
  }
};

}  // namespace sim
