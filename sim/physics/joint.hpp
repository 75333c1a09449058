#pragma once

#include <ode/ode.h>

#include <memory>
#include <string>

#include "sim/physics/physics_config.hpp"
#include "sim/state_hash.hpp"

namespace sim {

struct JointDeleter {
  void operator()(dJointID joint) const { dJointDestroy(joint); }
};
using JointHandle = std::unique_ptr<dxJoint, JointDeleter>;

/// One ODE joint.  Axis 0 is the first (or only) axis, axis 1 the second of hinge2 and universal.
class Joint {
 public:
  const std::string& name() const { return name_; }  ///< such as `rover1/left`
  const std::string& type() const { return type_; }
  int axes() const;  ///< 0 fixed and ball, 1 hinge and slider, 2 hinge2 and universal

  /// Angle since the joint was made, not wrapped (rad), or position of a slider (m).  Hinge2's second axis is a
  /// free wheel: its angle is summed from its rate.
  double position(int axis = 0) const { return position_[axis]; }
  double velocity(int axis = 0) const;
  void set_motor(double velocity, double max_force, int axis = 0);
  double motor_velocity(int axis = 0) const { return motor_velocity_[axis]; }
  double motor_max_force(int axis = 0) const { return motor_max_force_[axis]; }
  /// Torque (N m) or force (N) about or along an axis, for the next step.
  void add_effort(double effort, int axis = 0);

  void hash_state(StateHash& hash) const;

 private:
  friend class PhysicsWorld;
  Joint() = default;
  double wrapped_position(int axis) const;
  void update_position(double step_s);  ///< after each step; integrates differences, for ODE wraps at pi

  std::string name_;
  std::string type_;
  JointHandle ode_;
  double position_[2] = {0, 0};
  double wrapped_[2] = {0, 0};
  double motor_velocity_[2] = {0, 0};
  double motor_max_force_[2] = {0, 0};
};

}  // namespace sim
