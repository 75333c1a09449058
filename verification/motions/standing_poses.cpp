// SPDX-License-Identifier: BSD-3-Clause
#include "verification/motions/standing_poses.hpp"

#include <algorithm>
#include <numbers>
#include <stdexcept>

#include "motion/gait/leg.hpp"
#include "sim/random/random.hpp"

namespace verification {

namespace {

constexpr double degree = std::numbers::pi / 180;
constexpr double max_swing_rad = 60 * degree, max_flap_rad = 30 * degree, max_knee_rad = 100 * degree;
constexpr double pose_settle_s = 1;
constexpr int max_tried_per_pose = 100;

}  // namespace

StandingPoses standing_poses(const sim::WorldConfig& world, const std::string& vehicle, int count, std::uint64_t seed) {
  const sim::WorldConfig reduced = motion::world_for_walks(world);
  const auto instance = std::find_if(reduced.vehicles.begin(), reduced.vehicles.end(),
                                     [&](const sim::VehicleInstance& one) { return one.name == vehicle; });
  const std::vector<motion::Leg> legs = motion::legs_of(*instance->config);
  sim::Random random(seed, "standing_poses");
  const auto drawn = [&](const motion::LegJointLimits& limits, double low, double high) {
    return std::clamp(low + random.uniform() * (high - low), limits.low, limits.high);
  };
  StandingPoses result;
  while (result.poses.size() < static_cast<std::size_t>(count)) {
    if (result.tried >= max_tried_per_pose * count)
      throw std::runtime_error("vehicle '" + vehicle + "' stands in too few of its random poses");
    // Each trial has its own random numbers, so the first poses are the same for any `count`.
    random.begin_step(result.tried++);
    sim::JointValues pose;
    for (const motion::Leg& leg : legs) {
      pose.emplace_back(leg.name + "_swing", drawn(leg.swing_limits, -max_swing_rad, max_swing_rad));
      pose.emplace_back(leg.name + "_flap", drawn(leg.flap_limits, 0, max_flap_rad));
      pose.emplace_back(leg.name + "_knee", drawn(leg.knee_limits, 0, max_knee_rad));
    }
    const motion::ConnectWorld trial(reduced, vehicle, motion::held_pose("pose", vehicle, pose), pose_settle_s);
    if (trial.stands() && !trial.touches()) result.poses.push_back(pose);
  }
  return result;
}

}  // namespace verification
