// SPDX-License-Identifier: BSD-3-Clause
#include "devices/joint/joint_follower.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "devices/joint/joint_of_device.hpp"

namespace devices {

void JointFollower::Params::read(sim::ParamReader& in) {
  in.require("joint");
  in.read_reference("joint", joint, "joint", "joint that it moves");
  in.read("axis", axis, sim::between(0, 1), "axis of the joint: 1 is the second one of hinge2 and universal");
  in.require("follows");
  in.read_reference("follows", follows, "joint", "joint that it follows");
  in.read("follows_axis", follows_axis, sim::between(0, 1), "axis of the joint that it follows");
  in.read("multiplier", multiplier, sim::any_number(), "position of the joint over that of the one that it follows");
  in.read("offset", offset, sim::any_number(), "position where the one that it follows is at 0, rad or m");
  in.read("max_effort", max_effort, sim::above(0), "maximum effort, N m or N");
  in.read("max_velocity", max_velocity, sim::above(0), "maximum velocity, rad/s or m/s; unset: no limit");
}

JointFollower::JointFollower(const Params& params, const sim::DeviceContext& context)
    : params_(params),
      joint_(joint_with_axis(context, params.joint, params.axis)),
      followed_(joint_with_axis(context, params.follows, params.follows_axis)) {
  if (&joint_ == &followed_ && params.axis == params.follows_axis)
    refuse(context, "joint '" + params.joint + "' cannot follow itself");
}

void JointFollower::act(const sim::ActContext& context) {
  const double target = params_.multiplier * followed_.position(params_.follows_axis) + params_.offset;
  // A large error is removed no faster than half of the effort can brake: v^2 = 2 a error.
  const double error = target - joint_.position(params_.axis);
  const double effort = context.effectiveness * params_.max_effort;
  const double braking = 0.5 * effort * joint_.mobility(params_.axis);
  const double closing = std::min(std::abs(error) / context.step_s, std::sqrt(2 * braking * std::abs(error)));
  const double velocity = params_.multiplier * followed_.velocity(params_.follows_axis) + std::copysign(closing, error);
  const double limit = params_.max_velocity.value_or(std::numeric_limits<double>::max());
  joint_.set_motor(std::clamp(velocity, -limit, limit), effort, params_.axis);
}

SHOAL_ACTUATOR("joint_follower", JointFollower, void);

}  // namespace devices
