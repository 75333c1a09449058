// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "sim/base/math.hpp"
#include "sim/model/physics_config.hpp"

struct dxBody;  // of ODE; only the sources of physics include its headers
struct dxJoint;
struct dxJointGroup;
struct dxWorld;

namespace sim {

class StateArchive;

struct JointDeleter {
  void operator()(dxJoint* joint) const;
};
using JointHandle = std::unique_ptr<dxJoint, JointDeleter>;

/// Joint between two bodies, or a body and the world, as an ODE joint.  Axis 0 is the first (or only) axis, axis 1 the
/// second of hinge2 and universal.  A ball with a motor has three: x, y and z of the vehicle frame when the joint was
/// created, fixed to the first body.
///
/// Sign convention: positions and velocities are those of the second body relative to the first, right-handed about (or
/// along) the axis: a wheel that is the second body, with axis +y, rolls forward at positive speed.  For a joint to the
/// world or to a fixed body they are those of the moving body.
///
/// What a step does with it is in SteppedJoint.
class Joint {
 public:
  virtual ~Joint();
  Joint(const Joint&) = delete;
  Joint& operator=(const Joint&) = delete;

  const std::string& name() const { return name_; }  ///< such as `rover1/left`
  JointType type() const { return type_; }
  /// Number of axes: 0 for fixed, and ball without a motor; 1 for hinge and slider; 2 for hinge2 and universal; 3 for
  /// ball with a motor.
  int axes() const { return axes_; }

  /// Angle since the joint was created, not wrapped (rad), or position of a slider (m).  The second axis of hinge2 is a
  /// free wheel: its angle is integrated from its rate.  For a ball: components of the rotation vector, with norm below
  /// 2 pi: of both that describe the rotation, the one nearer to that of the step before.
  double position(int axis = 0) const { return position_[axis]; }
  /// Rate of the position (rad/s, or m/s for a slider).
  double velocity(int axis = 0) const;
  /// Sets the velocity and the maximum torque (N m) or force (N) of the motor of an axis.
  void set_motor(double velocity, double max_force, int axis = 0);
  double motor_velocity(int axis = 0) const { return motor_velocity_[axis]; }
  double motor_max_force(int axis = 0) const { return motor_max_force_[axis]; }
  /// Adds a torque (N m) about an axis or a force (N) along it, for the next step.
  void add_effort(double effort, int axis = 0);
  /// Returns the velocity that an impulse of 1 N m s about an axis (1 N s along it) gives its two bodies, which only
  /// the anchor holds together, in 1/(kg m^2) or 1/kg.  Other joints and contacts of the bodies only reduce it.
  double mobility(int axis = 0) const;
  /// Sets the stops of an axis, limits of its position() (rad, or m for a slider); nullopt: no stop.  With low above
  /// high neither stop has an effect.  The second axis of hinge2 has no stops.
  void set_stops(std::optional<double> low, std::optional<double> high, int axis = 0);

  /// Switches the measurement of the load on, from the next step; until then the load reads zero.
  void measure_load();
  /// Force and torque that the joint applied to its second body in the last step, or to the only moving body.  They
  /// include the constraint, motor, stops, efforts and damping.  The torque is about the joint's anchor, which moves
  /// with that body.
  Vector3d force_W_N() const;
  Vector3d torque_W_Nm() const;
  /// Part of the load applied by motor, stops and add_effort about or along an axis, in the joint's sign.
  double effort(int axis = 0) const;

  /// Saves, hashes or restores the state.  To restore, the joint must have been created, and moved by move_group, like
  /// the saved one.
  void visit_state(StateArchive& archive);

 protected:
  /// Pose of an ODE body, to the last bit.
  struct OdePose {
    double p[3], q[4], R[12];
  };
  /// Creation data, from which the joint is created again: in another ODE world, or to the world at another place.
  struct Origin {
    JointConfig config;
    Pose X_WV;
    bool to_world;
    Pose X_WC;              // to the world: of the moving body
    OdePose first, second;  // of ODE's bodies; without a second one its pose is not used
  };
  /// Attaches the bodies at their present poses.  `second` null: the world.
  Joint(dxWorld* world, std::string name, const JointConfig& config, dxBody* first, dxBody* second, const Pose& X_WV);
  dxJoint* ode() const { return ode_.get(); }
  const Origin& origin() const { return *origin_; }
  /// Constraint rows with all motors and stops active; motors that leave a stop, and damping, add some.
  int max_rows() const;
  /// Creates the ODE joint again, as it was created and with its present settings.  The bodies keep their poses.
  void create_again(dxWorld* world, dxBody* first, dxBody* second);
  void move_world_side(const Pose& X_move_W);
  void make_again(const Pose& X_WV, const Pose& X_WC);
  /// Gives the damping of the axes to a joint of `group` for the next step.
  void start_damping(dxJointGroup* group);
  /// Gives the stops from which motors drive away to a joint of `group` for the next step.  Returns whether there are
  /// any; then end_leaving_stops() must follow the step.
  bool start_leaving_stops(dxJointGroup* group, double step_s);
  void end_leaving_stops();
  bool is_measured() const { return load_ != nullptr; }
  void note_before_step();
  void note_load();
  void update_position(double step_s);  ///< after each step; sums differences because ODE wraps at pi

 private:
  static constexpr int max_axes = 3;
  struct Load;  // sim/physics/joint_load.hpp
  /// Stops in ODE's sign and units, of the position that is not wrapped.
  struct OdeStops {
    double low = -std::numeric_limits<double>::infinity(), high = std::numeric_limits<double>::infinity();
    bool any() const {
      return low > -std::numeric_limits<double>::infinity() || high < std::numeric_limits<double>::infinity();
    }
  };
  void create(dxWorld* world, dxBody* first, dxBody* second);
  void create_ball_motor(dxWorld* world, dxBody* first, dxBody* second);
  Vector3d rotation_of_ball() const;
  void configure_axis(const JointAxisConfig& config, int axis);
  void place_stops(std::optional<double> low, std::optional<double> high, int axis);
  void put_stops(const OdeStops& stops, int axis);
  /// Gives ODE the stops of an axis where they are on its angle, which it wraps at pi.
  void give_stops_to_ode(int axis);
  void give_ode_stops(OdeStops stops, int axis);
  void visit_stops(StateArchive& archive, int axis);
  void visit_load(StateArchive& archive);
  void measure_no_load();
  void set_parameter(int parameter, double value, int axis);
  double wrapped_position(int axis) const;
  double get_parameter(int parameter, int axis) const;
  Vector3d axis_W(int axis) const;
  void request_load();
  void note_load_without_damping();
  double motor_at_stop(int axis) const;
  /// Returns whether the motor of an axis drives it away from a stop at which it is.
  bool leaves_stop(int axis) const;
  /// How far an axis is beyond the stop that it leaves.
  double depth_in_stop(int axis) const;
  dxJoint* create_slider_damper(dxJointGroup* group) const;
  Vector3d middle_of_bodies_W() const;
  dxJoint* create_slider_stop(dxJointGroup* group) const;

  std::string name_;
  JointType type_;
  JointHandle ode_;
  JointHandle ball_motor_;                    // ODE's angular motor
  Matrix3d R_F_axes_ = Matrix3d::Identity();  // the ball's axes in the frame of its first body (or the world)
  Matrix3d R_FS_ = Matrix3d::Identity();      // of its second body when the joint was created
  int axes_ = 0;
  double sign_ = 1;  // ODE measures the first body relative to the second
  double position_[max_axes] = {};
  double wrapped_[max_axes] = {};
  double motor_velocity_[max_axes] = {};
  double motor_max_force_[max_axes] = {};
  double damping_[max_axes] = {};
  OdeStops stops_[max_axes];  // none where they have no effect
  OdeStops configured_stops_[max_axes];
  bool leaves_stops_ = false;           // in this step
  bool damps_ = false;                  // in this step
  bool stops_were_set_ = false;         ///< set_stops() was called
  dxBody* loaded_ = nullptr;            // whose load is measured
  Vector3d p_CA_C_ = Vector3d::Zero();  // the anchor in ODE's frame of the loaded body
  std::unique_ptr<Load> load_;          // when it is measured
  std::unique_ptr<Origin> origin_;
};

}  // namespace sim
