// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "sim/base/math.hpp"
#include "sim/model/physics_config.hpp"

struct dxBody;  // ODE's, whose headers only the sources of physics read
struct dxJoint;
struct dxWorld;

namespace sim {

class StateArchive;

struct JointDeleter {
  void operator()(dxJoint* joint) const;
};
using JointHandle = std::unique_ptr<dxJoint, JointDeleter>;

/// One ODE joint.  Axis 0 is the first (or only) axis, axis 1 the second of hinge2 and universal.  A ball with a motor
/// has three: x, y and z of the vehicle's frame when the joint was created, fixed to the first body.
///
/// Signs: a joint counts how its second body moves relative to its first, right-handed about (or along) the axis: a
/// wheel that is the second body, with axis +y, rolls forward at positive speed.  A joint to the world or to a fixed
/// body counts how the moving body moves.
class Joint {
 public:
  ~Joint();
  Joint(const Joint&) = delete;
  Joint& operator=(const Joint&) = delete;

  const std::string& name() const { return name_; }  ///< such as `rover1/left`
  JointType type() const { return type_; }
  /// 0 fixed, and ball without a motor; 1 hinge and slider; 2 hinge2 and universal; 3 ball with a motor.
  int axes() const { return axes_; }

  /// Angle since the joint was made, not wrapped (rad), or position of a slider (m).  Hinge2's second axis is a
  /// free wheel: its angle is summed from its rate.  Of a ball: components of the rotation vector, of up to pi.
  double position(int axis = 0) const { return position_[axis]; }
  double velocity(int axis = 0) const;
  void set_motor(double velocity, double max_force, int axis = 0);
  double motor_velocity(int axis = 0) const { return motor_velocity_[axis]; }
  double motor_max_force(int axis = 0) const { return motor_max_force_[axis]; }
  /// Torque (N m) or force (N) about or along an axis, for the next step.
  void add_effort(double effort, int axis = 0);
  /// Where the axis stops, in the joint's own sign (rad, or m of a slider); nullopt: nowhere.  Low above high: neither
  /// stop works.  Hinge2's second axis has no stops.
  void set_stops(std::optional<double> low, std::optional<double> high, int axis = 0);

  /// From the next step on ODE is asked for the load; before, it reads zero.
  void measure_load();
  /// What the joint applied in the last step on its second body; where only one body moves, on that one.  All that
  /// goes through the joint: constraint, motor, stops and efforts.  The torque is about the joint's anchor, which the
  /// body takes along.
  Vector3d force_W_N() const;
  Vector3d torque_W_Nm() const;
  /// Of that, what motor, stops and add_effort applied about or along an axis, in the joint's sign.
  double effort(int axis = 0) const;

  /// Restoring needs a joint that was made, and moved by move_group, as the one that was saved.
  void visit_state(StateArchive& archive);

 private:
  friend class PhysicsWorld;
  static constexpr int max_axes = 3;
  struct Load;  // sim/physics/joint_load.hpp
  /// Of a joint to the world: how it was made, so that it can be made again elsewhere.
  struct WorldSide {
    JointConfig config;
    Pose X_WV;
    Pose X_WC;  // of the body that moves, when the joint was made
  };
  /// As ODE counts and signs them.
  struct OdeStops {
    double low = -std::numeric_limits<double>::infinity(), high = std::numeric_limits<double>::infinity();
  };
  /// Attaches at the poses the bodies have now.  `second` null: the world.
  Joint(dxWorld* world, std::string name, const JointConfig& config, dxBody* first, dxBody* second, const Pose& X_WV);
  void create(dxWorld* world, const JointConfig& config, const Pose& X_WV, dxBody* first, dxBody* second);
  void create_ball_motor(dxWorld* world, const Pose& X_WV, dxBody* first, dxBody* second);
  Vector3d rotation_of_ball() const;
  void configure_axis(const JointAxisConfig& config, int axis);
  void place_stops(std::optional<double> low, std::optional<double> high, int axis);
  void put_stops(const OdeStops& stops, int axis);
  OdeStops stops_of(int axis) const;  ///< stops without effect are reported as none
  double stop_never_reached() const;
  void visit_stops(StateArchive& archive, int axis);
  void visit_load(StateArchive& archive);
  void measure_no_load();
  void set_parameter(int parameter, double value, int axis);
  int max_rows() const;  ///< constraint rows, with motors and stops all at work
  double wrapped_position(int axis) const;
  double get_parameter(int parameter, int axis) const;
  Vector3d axis_W(int axis) const;
  void request_load();
  void note_before_step();
  void note_load();
  double motor_at_stop(int axis) const;
  void move_world_side(const Pose& X_move_W);
  void make_again(const Pose& X_WV, const Pose& X_WC);
  void update_position(double step_s);  ///< after each step; integrates differences, for ODE wraps at pi

  std::string name_;
  JointType type_;
  JointHandle ode_;
  JointHandle ball_motor_;                    // ODE's angular motor
  Matrix3d R_F_axes_ = Matrix3d::Identity();  // the ball's axes in the frame of its first body (or the world)
  Matrix3d R_FS_ = Matrix3d::Identity();      // of its second body, when the joint was made
  int axes_ = 0;
  double sign_ = 1;  // ODE counts the first body relative to the second
  double position_[max_axes] = {};
  double wrapped_[max_axes] = {};
  double motor_velocity_[max_axes] = {};
  double motor_max_force_[max_axes] = {};
  std::array<OdeStops, max_axes> configured_stops_;
  bool stops_were_set_ = false;                     ///< at run time
  dxBody* loaded_ = nullptr;                        // whose load is measured
  Vector3d p_CA_C_ = Vector3d::Zero();              // the anchor in ODE's frame of the loaded body
  std::unique_ptr<Load> load_;                      // when it is measured
  std::vector<Joint*>* measured_joints_ = nullptr;  // of the world
  std::unique_ptr<WorldSide> world_side_;
};

}  // namespace sim
