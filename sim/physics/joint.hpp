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
///
/// Signs: a joint counts how its second body moves relative to its first, right-handed about (or along) the axis: a
/// wheel that is the second body, with axis +y, rolls forward at positive speed.  A joint to the world or to a fixed
/// body counts how the moving body moves.
class Joint {
 public:
  const std::string& name() const { return name_; }  ///< such as `rover1/left`
  const std::string& type() const { return type_; }
  int axes() const { return axes_; }  ///< 0 fixed and ball, 1 hinge and slider, 2 hinge2 and universal

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
  /// Attaches at the poses the bodies have now.  `second` null: the world.
  Joint(dWorldID world, std::string name, const JointConfig& config, dBodyID first, dBodyID second, const Pose& X_WV);
  void create(dWorldID world, const JointConfig& config, const Pose& X_WV, dBodyID first, dBodyID second);
  void configure_axis(const JointAxisConfig& config, int axis);
  void set_parameter(int parameter, double value, int axis);
  int max_rows() const;  ///< constraint rows, with motors and stops all at work
  double wrapped_position(int axis) const;
  void update_position(double step_s);  ///< after each step; integrates differences, for ODE wraps at pi

  std::string name_;
  std::string type_;
  JointHandle ode_;
  dJointType kind_ = dJointTypeHinge;
  int axes_ = 0;
  double sign_ = 1;  // ODE counts the first body relative to the second
  double position_[2] = {0, 0};
  double wrapped_[2] = {0, 0};
  double motor_velocity_[2] = {0, 0};
  double motor_max_force_[2] = {0, 0};
};

}  // namespace sim
