// SPDX-License-Identifier: BSD-3-Clause
#include "motion/analysis/motion_tracking.hpp"

#include <spdlog/fmt/fmt.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "devices/joint/joint_servo.hpp"
#include "sim/vehicle/mounted_device.hpp"

namespace motion {

namespace {

constexpr double deg_per_rad = 180 / std::numbers::pi;

}  // namespace

double tilt_rad(const sim::Vehicle& vehicle) {
  return std::acos(std::clamp(vehicle.X_WV().linear()(2, 2), -1.0, 1.0));
}

bool first_body_touches(const sim::World& world, const sim::Vehicle& vehicle) {
  const sim::Body& base = *vehicle.bodies().front().second;
  const auto parts = world.physics().parts();
  for (const sim::ContactReport& contact : world.physics().contacts()) {
    const sim::PartInfo& a = parts[static_cast<std::size_t>(contact.parts[0])];
    const sim::PartInfo& b = parts[static_cast<std::size_t>(contact.parts[1])];
    // Parts of the own vehicle may touch each other.
    if ((a.body == base.number() && b.group != vehicle.group()) ||
        (b.body == base.number() && a.group != vehicle.group()))
      return true;
  }
  return false;
}

void MotionTracking::add(MotionStage& stage) {
  const sim::Vehicle& vehicle = stage.vehicle();
  std::size_t number = 0;
  for (const sim::MountedDevice* device : vehicle.devices()) {
    const auto* servo = dynamic_cast<const devices::JointServo*>(device->actuator());
    if (servo == nullptr) continue;
    if (number == servos_.size()) servos_.push_back({device->config().name, servo->alias()});
    Servo& sums = servos_[number++];
    // Without the play of the gear: the joint itself, not the motor.
    const double error = std::abs(servo->set_point().position - servo->joint_position());
    sums.greatest = std::max(sums.greatest, error);
    sums.sum2 += error * error;
  }
  ++steps_;
  tilt_rad_ = std::max(tilt_rad_, tilt_rad(vehicle));
}

bool MotionTracking::has_fallen() const {
  return tilt_rad_ > fallen_rad;
}

double MotionTracking::greatest_error_rad() const {
  double greatest = 0;
  for (const Servo& servo : servos_) greatest = std::max(greatest, servo.greatest);
  return greatest;
}

std::string MotionTracking::text(const sim::JointMotion& motion) const {
  constexpr double shown_rad = 0.0005 / deg_per_rad;  // the table has three decimals of a degree
  const std::vector<sim::MotionTrack> tracks = motion.tracks();
  const auto is_moved = [&](const Servo& servo) {
    return std::any_of(tracks.begin(), tracks.end(), [&](const sim::MotionTrack& track) {
      return track.joint == servo.name || (!servo.alias.empty() && track.joint == servo.alias);
    });
  };
  std::string moved, others;
  int resting = 0;
  for (const Servo& servo : servos_) {
    const bool is_in_motion = is_moved(servo);
    if (!is_in_motion && servo.greatest < shown_rad) {
      ++resting;
      continue;
    }
    const double rms = std::sqrt(servo.sum2 / static_cast<double>(std::max<std::int64_t>(steps_, 1)));
    (is_in_motion ? moved : others) +=
        fmt::format("{:<24} {:>12.3f} {:>12.3f}\n", servo.name, servo.greatest * deg_per_rad, rms * deg_per_rad);
  }
  std::string text = fmt::format("{:<24} {:>12} {:>12}\n", "servo", "greatest deg", "rms deg") + moved + others;
  if (resting > 0) text += fmt::format("{} other servo{}: 0.000\n", resting, resting == 1 ? "" : "s");
  return text + fmt::format("greatest tilt {:.2f} deg{}\n", tilt_rad_ * deg_per_rad,
                            has_fallen() ? ": the vehicle has fallen" : "");
}

}  // namespace motion
