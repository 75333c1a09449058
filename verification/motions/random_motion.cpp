// SPDX-License-Identifier: BSD-3-Clause
#include "verification/motions/random_motion.hpp"

#include <algorithm>
#include <cmath>
#include <string>

#include "devices/motion/servo_bank.hpp"
#include "motion/analysis/motion_check.hpp"

namespace verification {

namespace {

double drawn_between(double low, double high, sim::Random& random) {
  return low + (high - low) * random.uniform();
}

/// Returns the servos that no pose names.
std::vector<devices::ServoOfVehicle> free_servos(const std::vector<sim::MotionPose>& poses,
                                                 const sim::VehicleConfig& vehicle) {
  std::vector<devices::ServoOfVehicle> servos = devices::servos_of(vehicle);
  std::erase_if(servos, [&](const devices::ServoOfVehicle& servo) {
    return !std::isfinite(servo.low) || !std::isfinite(servo.high) ||
           std::any_of(poses.begin(), poses.end(), [&](const sim::MotionPose& pose) {
             return std::any_of(pose.joints.begin(), pose.joints.end(),
                                [&](const auto& joint) { return servo.is_called(joint.first); });
           });
  });
  return servos;
}

}  // namespace

sim::JointMotion random_motion(const std::vector<sim::MotionPose>& poses, const sim::VehicleConfig& vehicle,
                               const RandomMotionOptions& options, sim::Random& random) {
  const std::vector<devices::ServoOfVehicle> others = free_servos(poses, vehicle);
  sim::JointMotion motion;
  motion.name = "random";
  motion.vehicle = vehicle.vehicle;
  motion.ease = sim::Easing::smooth;
  double at_s = 0;
  for (int i = 0; i < options.keys; ++i) {
    sim::MotionKey& key = motion.keys.emplace_back();
    key.at_s = at_s;
    at_s += drawn_between(options.least_key_s, options.greatest_key_s, random);
    // The first key is a pose in which the vehicle stands, so that every fall is due to the motion.
    const double offset = i == 0 ? 0 : options.offset;
    for (const auto& [joint, value] : poses[random.integer_below(static_cast<std::uint32_t>(poses.size()))].joints)
      key.joints.emplace_back(joint, drawn_between(value - offset, value + offset, random));
    for (const devices::ServoOfVehicle& servo : others)
      key.joints.emplace_back(servo.device, drawn_between(servo.low, servo.high, random));
  }
  return motion::mended(motion, vehicle);
}

}  // namespace verification
