// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cmath>
#include <cstdint>
#include <limits>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "sim/base/math.hpp"
#include "sim/base/step_memory.hpp"
#include "sim/collision/motion.hpp"

struct dxBody;  // of ODE; only the sources of physics include its headers
struct dxGeom;

namespace sim {

class StateArchive;
struct SceneMoves;

struct BodyDeleter {
  void operator()(dxBody* body) const;
};
using BodyHandle = std::unique_ptr<dxBody, BodyDeleter>;

/// Pose and velocities of a body frame B in the world.
struct BodyMotion {
  Matrix3d R_WB = Matrix3d::Identity();
  Vector3d p_WB = Vector3d::Zero(), v_WB_W = Vector3d::Zero(), w_WB_W = Vector3d::Zero();
};

/// Rigid body: an ODE body, free or kinematic, or a fixed body without one.  ODE's frame has its origin at the center
/// of mass; this class uses the body frame B that the vehicle file defines.  What a step does with it is in
/// SteppedBody.
class Body : public VisitedInSteps {
 public:
  virtual ~Body() = default;
  Body(const Body&) = delete;
  Body& operator=(const Body&) = delete;

  const std::string& name() const { return name_; }  ///< such as `rover1/chassis`
  int number() const { return number_; }
  int group() const { return group_; }
  bool fixed() const { return ode_ == nullptr; }  ///< has no ODE body
  bool kinematic() const { return motion_ == Motion::kinematic; }

  // Mass, center of mass and inertia are zero for a body that is not free.
  double mass_kg() const { return mass_kg_; }
  const Vector3d& p_BC() const { return p_BC_; }                ///< center of mass in B
  const Matrix3d& inertia_C_B() const { return inertia_C_B_; }  ///< about the center of mass, axes of B, kg m^2

  /// Pose of the body frame.
  Pose X_WB() const;
  /// Position of the origin of B.
  Vector3d p_WB() const;
  /// Velocity of the origin of B.  A kinematic body keeps the velocity of the last step until the next step.
  Vector3d v_WB_W() const;
  /// Angular velocity.
  Vector3d w_WB_W() const;
  /// Pose and velocities together; cheaper than the separate calls.
  BodyMotion motion() const;
  /// Motion at which forces on this body act in the next step.  A body that is alone, or whose velocities were set, is
  /// half a step further, by its velocities and the accelerations of the last step: forces of there give a step of
  /// second order.  Another one is where it is.
  BodyMotion motion_for_forces(double step_s) const;
  /// Whether a free body had neither joints nor contacts in the last step; then its next step is of second order, see
  /// free_step.hpp.
  bool alone() const { return last_step_ == LastStep::alone; }
  /// Velocity of a point fixed in the body, given in B.
  Vector3d velocity_at_W(const Vector3d& p_B) const;

  /// Add a force at a point, or a torque, for the next step.  No effect on a body that is not free.  Throw PhysicsFault
  /// when a number is not finite.
  void add_force_W(const Vector3d& force_N, const Vector3d& at_W);
  void add_torque_W(const Vector3d& torque_Nm);
  /// Adds a force whose point is given from the center of mass.
  void add_force_at_W(const Vector3d& force_N, const Vector3d& p_CP_W);
  /// Sum of what was added for the next step: force, and torque about the center of mass.  Without the forces of
  /// set_velocity_at_end().
  Vector3d applied_force_W() const;
  Vector3d applied_torque_W() const;
  /// Replaces the force and torque added for the next step.  Throws PhysicsFault when a number is not finite.
  void set_applied_W(const Vector3d& force_N, const Vector3d& torque_Nm);
  /// Replaces the force and torque added for the next step by those that give the body these velocities at its end: of
  /// the center of mass relative to what moves with `carried_W`, and angular, both in axes of the body at its end. What
  /// is added afterwards acts on top of them.  The gyroscopic torque and gravity must be off.  Throws PhysicsFault when
  /// a number is not finite.
  void set_velocity_at_end(const Vector3d& v_C_B, const Vector3d& carried_W, const Vector3d& w_B, double step_s);
  /// Makes the next step one of ODE, for forces that are integrated for it; motion_for_forces() is then motion().
  void take_first_order_step(double step_s) {
    first_order_now_ = true;
    leave_to_ode(step_s);
  }
  /// The same for all steps.
  void use_first_order() { first_order_ = true; }
  /// Sets the pose of the body frame.  The parts of a fixed or kinematic body move with it; bodies in contact with it
  /// see no velocity.  For a free body, only this body moves: PhysicsWorld::move_group moves the whole vehicle.
  void set_pose(const Pose& X_WB);
  /// Moves a kinematic body so that the next step, of `step_s`, ends with its frame at this pose, at constant velocity
  /// and along the shorter rotation.  Bodies in contact see that velocity, which is limited as for every body; use
  /// set_pose for a jump.  A body without a call does not move in the step.
  void move_to(const Pose& X_WB_at_end, double step_s);
  /// The same, with the velocities of the step given: linear of the origin of B, and angular.
  void move_to(const Pose& X_WB_at_end, const Vector3d& v_WB_W, const Vector3d& w_WB_W);
  /// Sets the velocities of a free body; no effect on other bodies.
  void set_velocity_W(const Vector3d& v_WB_W, const Vector3d& w_WB_W);

  /// Switch gravity or the gyroscopic torque on or off.  When off, the caller adds the weight or the torque -w x I w
  /// itself (a model of added mass needs both off).
  void set_gravity(bool on);
  void set_gyroscopic(bool on) { gyroscopic_ = on; }

  /// Saves, hashes or restores the state of the body.
  void visit_state(StateArchive& archive);

 protected:
  struct FixedGeom {
    dxGeom* geom;
    Pose X_BG;
    bool plane;
  };
  /// Without ODE's body yet; see SteppedBody.
  Body(std::string name, int number, int group, Motion motion, SceneMoves& moves)
      : motion_(motion), number_(number), group_(group), name_(std::move(name)), moves_(&moves) {}
  bool free() const { return motion_ == Motion::free; }
  void place_fixed_geoms();
  void place_ode_body(const Pose& X_WB);
  void write_rotation(const Quaterniond& q_WB);
  void start_kinematic_step();
  void end_kinematic_step();
  void end_kinematic_step_alone();
  void add_gyroscopic_torque(double step_s);
  void step_alone(double step_s, double gravity_mps2);
  void leave_to_ode(double step_s);
  void apply_plan();

  // Members used in each step, adjacent in memory.
  BodyHandle ode_;
  // Pointers into the ODE body, whose address is stable.
  double* p_WC_ = nullptr;
  double* q_WB_ = nullptr;  // w, x, y, z
  double* R_WB_ = nullptr;  // rows of 4
  double* v_WC_W_ = nullptr;
  double* w_WB_W_ = nullptr;
  double* force_N_ = nullptr;  // added for the next step; on top of a plan, see set_velocity_at_end()
  double* torque_Nm_ = nullptr;
  bool gyroscopic_ = true;
  Motion motion_ = Motion::free;
  bool move_is_due_ = false;  // move_to was called for the next step
  bool turn_is_due_ = false;  // and has another attitude than before
  bool first_order_ = false;  // see use_first_order()
  bool gravity_ = true;
  bool first_order_now_ = false;  // see take_first_order_step()
  bool planned_ = false;          // set_velocity_at_end() was called for the next step
  bool plan_applied_ = false;     // and apply_plan()
  enum class LastStep : std::uint8_t { none, alone, ode };
  LastStep last_step_ = LastStep::none;  // none: the velocities were set since
  int number_ = -1;
  int group_ = -1;
  double plan_step_s_ = 0;
  double mass_kg_ = 0;
  Vector3d p_BC_ = Vector3d::Zero();
  Matrix3d inertia_C_B_ = Matrix3d::Zero();
  // Accelerations of the last step, if the body was alone: of the center of mass, and angular in axes of B.
  Vector3d a_WC_W_ = Vector3d::Zero(), alpha_B_ = Vector3d::Zero();
  Vector3d v_C_B_at_end_, carried_W_, w_B_at_end_;  // of set_velocity_at_end()
  // While each coordinate of the center of mass is within this distance of a place, the body is in the box that
  // FarGroups has for it; infinite: it has none.
  Vector3d box_center_W_ = Vector3d::Zero();
  double leeway_m_ = std::numeric_limits<double>::infinity();
  double leap_m2ps2_ = std::numeric_limits<double>::infinity();  // of may_leap()

  Pose seat_X_WB_ = Pose::Identity();            // of a fixed body now; of a kinematic body after the next step
  Vector3d planned_force_W_, planned_torque_W_;  // of apply_plan()
  std::string name_;
  std::vector<FixedGeom> fixed_geoms_;
  SceneMoves* moves_ = nullptr;  // of the world: counts moves, so that the scene is updated
};

}  // namespace sim
