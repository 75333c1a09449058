// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "sim/base/math.hpp"
#include "sim/base/step_memory.hpp"
#include "sim/physics/motion.hpp"

struct dxBody;  // ODE's, whose headers only the sources of physics read
struct dxGeom;

namespace sim {

class StateArchive;
struct SceneMoves;

struct BodyDeleter {
  void operator()(dxBody* body) const;
};
using BodyHandle = std::unique_ptr<dxBody, BodyDeleter>;

/// Where a body is and how it moves.
struct BodyMotion {
  Matrix3d R_WB = Matrix3d::Identity();
  Vector3d p_WB = Vector3d::Zero(), v_WB_W = Vector3d::Zero(), w_WB_W = Vector3d::Zero();
};

/// One ODE body, free or kinematic, or a fixed one without.  ODE's frame sits at the centre of mass; this class speaks
/// of the body frame B that the vehicle file defines.
class Body : public VisitedInSteps {
 public:
  const std::string& name() const { return name_; }  ///< such as `rover1/chassis`
  int number() const { return number_; }
  int group() const { return group_; }
  bool fixed() const { return ode_ == nullptr; }  ///< has no ODE body
  bool kinematic() const { return motion_ == Motion::kinematic; }

  // Mass, centre of mass and inertia are zero for a body that is not free.
  double mass_kg() const { return mass_kg_; }
  const Vector3d& p_BC() const { return p_BC_; }                ///< centre of mass in B
  const Matrix3d& inertia_C_B() const { return inertia_C_B_; }  ///< about the centre of mass, axes of B, kg m^2

  Pose X_WB() const;
  /// Velocity of the origin of B.  A kinematic body keeps that of the last step until the next one.
  Vector3d v_WB_W() const;
  Vector3d w_WB_W() const;
  /// All of this at once, which is cheaper.
  BodyMotion motion() const;
  /// Velocity of a point of the body given in B.
  Vector3d velocity_at_W(const Vector3d& p_B) const;

  /// Forces act during the next step, and have no effect on a body that is not free.  Not finite: PhysicsFault.
  void add_force_W(const Vector3d& force_N, const Vector3d& at_W);
  void add_torque_W(const Vector3d& torque_Nm);
  /// What was added for the next step: the force, and the torque about the centre of mass.
  Vector3d applied_force_W() const;
  Vector3d applied_torque_W() const;
  /// Takes the place of all that was added for the next step.  Not finite: PhysicsFault.
  void set_applied_W(const Vector3d& force_N, const Vector3d& torque_Nm);
  /// Puts the body frame at a pose.  A fixed or kinematic body takes its parts along; what it touches sees no
  /// velocity.  A free body alone: PhysicsWorld::move_group takes the whole vehicle.
  void set_pose(const Pose& X_WB);
  /// Moves a kinematic body so that the next step, of `step_s`, ends with its frame at this pose: at one velocity, and
  /// turning the shorter way.  What it touches sees that velocity, which has the bound of every body: for a jump there
  /// is set_pose.  Without a call it stands still in a step.
  void move_to(const Pose& X_WB_at_end, double step_s);
  /// The same for callers that have the velocities of the step: linear of the origin of B, and angular.
  void move_to(const Pose& X_WB_at_end, const Vector3d& v_WB_W, const Vector3d& w_WB_W);
  /// Of a free body; others do not take it.
  void set_velocity_W(const Vector3d& v_WB_W, const Vector3d& w_WB_W);

  /// Off: the caller adds weight and the torque -w x I w itself (a model of added mass needs both off).
  void set_gravity(bool on);
  void set_gyroscopic(bool on) { gyroscopic_ = on; }

  void visit_state(StateArchive& archive);

 private:
  friend class PhysicsWorld;
  struct FixedGeom {
    dxGeom* geom;
    Pose X_BG;
    bool plane;
  };
  Body() = default;
  bool free() const { return motion_ == Motion::free; }
  void place_fixed_geoms();
  void place_ode_body(const Pose& X_WB);
  void start_kinematic_step();
  void end_kinematic_step();
  void add_gyroscopic_torque(double step_s);

  // What each step needs, side by side.
  BodyHandle ode_;
  // Into the ODE body, which does not move in memory.
  const double* p_WC_ = nullptr;
  const double* v_WC_W_ = nullptr;
  const double* w_WB_W_ = nullptr;
  const double* R_WB_ = nullptr;
  bool gyroscopic_ = true;
  Motion motion_ = Motion::free;
  bool move_is_due_ = false;  // move_to was called for the next step
  int number_ = -1;
  int group_ = -1;
  Matrix3d inertia_C_B_ = Matrix3d::Zero();

  std::string name_;
  double mass_kg_ = 0;
  Vector3d p_BC_ = Vector3d::Zero();
  Pose seat_X_WB_ = Pose::Identity();  // where a fixed body is, and where a kinematic one is after the next step
  std::vector<FixedGeom> fixed_geoms_;
  SceneMoves* moves_ = nullptr;  // of the world: the scene looks again when something was moved
};

}  // namespace sim
