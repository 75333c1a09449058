// SPDX-License-Identifier: BSD-3-Clause
#include "motion/analysis/free_keys.hpp"

#include <algorithm>
#include <cmath>
#include <map>

#include "devices/motion/servo_bank.hpp"
#include "motion/analysis/motion_check.hpp"

namespace motion {

namespace {

constexpr double least_time_factor = 0.4, greatest_time_factor = 2.5;
constexpr double value_room = 0.5;  // rad, or half of a slider's range in m at most
constexpr double seam_tolerance = 1e-3;
constexpr std::size_t max_numbers = 400;

}  // namespace

FreeKeys::FreeKeys(sim::JointMotion motion, const sim::VehicleConfig& vehicle)
    : motion_(std::move(motion)), vehicle_(vehicle) {
  const auto refuse = [&](const std::string& why) {
    throw sim::ConfigError({"motion '" + motion_.name + "': its keys cannot be searched: " + why});
  };
  if (!motion_.loop) refuse("it must have 'loop: true'");
  if (motion_.keys.size() < 2 || !motion_.frames.empty()) refuse("it must have two keys or more, and no frames");
  // Poses become values of the keys.
  for (sim::MotionKey& key : motion_.keys) {
    key.joints = motion_.values_of(key);
    key.pose.clear();
  }
  motion_.poses.clear();
  for (std::size_t k = 1; k < motion_.keys.size(); ++k) {
    const double time_s = motion_.keys[k].at_s - motion_.keys[k - 1].at_s;
    numbers_.push_back({"key" + std::to_string(k + 1) + ".after_s", least_time_factor * time_s, time_s,
                        greatest_time_factor * time_s});
  }
  add_values();
  if (numbers_.size() > max_numbers)
    refuse("they are " + std::to_string(numbers_.size()) + " numbers, more than " + std::to_string(max_numbers));
}

void FreeKeys::add_values() {
  const std::vector<devices::ServoOfVehicle> servos = devices::servos_of(vehicle_);
  std::map<std::string, Value> first;
  std::map<std::string, std::size_t> last_key;
  for (std::size_t k = 0; k < motion_.keys.size(); ++k)
    for (const auto& [joint, value] : motion_.keys[k].joints) last_key[joint] = k;
  for (std::size_t k = 0; k < motion_.keys.size(); ++k)
    for (std::size_t j = 0; j < motion_.keys[k].joints.size(); ++j) {
      const std::string& joint = motion_.keys[k].joints[j].first;
      if (motion_.is_light(joint)) continue;
      const double value = motion_.keys[k].joints[j].second;
      const auto servo = std::find_if(servos.begin(), servos.end(),
                                      [&](const devices::ServoOfVehicle& one) { return one.is_called(joint); });
      if (servo == servos.end())
        throw sim::ConfigError({"motion '" + motion_.name + "' names joint '" + joint +
                                "', which is not a servo of vehicle '" + vehicle_.vehicle + "'"});
      const auto [at_first, is_first] = first.try_emplace(joint, Value{k, j});
      const Value& one = at_first->second;
      // The last key of a loop repeats the first. It follows that one instead of being searched, else the loop would
      // jump.
      if (!is_first && last_key[joint] == k &&
          std::abs(motion_.keys[one.key].joints[one.joint].second - value) < seam_tolerance) {
        equal_.emplace_back(one, Value{k, j});
        continue;
      }
      const double low = std::max(servo->low, value - value_room), high = std::min(servo->high, value + value_room);
      numbers_.push_back({"key" + std::to_string(k + 1) + "." + joint, low, std::clamp(value, low, high), high});
      values_.push_back({k, j});
    }
}

sim::JointMotion FreeKeys::motion(std::span<const double> values) const {
  sim::JointMotion motion = motion_;
  const std::size_t times = motion.keys.size() - 1;
  // Whole frames, so that the end is one.
  for (std::size_t k = 0; k < times; ++k) {
    const double frames = std::max(1.0, std::round(values[k] / motion.frame_s));
    motion.keys[k + 1].at_s = motion.keys[k].at_s + frames * motion.frame_s;
  }
  const auto value_of = [&](const Value& place) -> double& {
    return motion.keys[place.key].joints[place.joint].second;
  };
  for (std::size_t i = 0; i < values_.size(); ++i) value_of(values_[i]) = values[times + i];
  for (const auto& [from, to] : equal_) value_of(to) = value_of(from);
  return mended(motion, vehicle_);
}

}  // namespace motion
