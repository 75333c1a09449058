// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cmath>
#include <cstdint>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>

#include "bridges/ros2/converter.hpp"
#include "sim/base/math.hpp"

namespace bridges::ros2 {

// Values of the scene: anything is possible, for it comes from another process.

using Json = nlohmann::json;

inline const Json* at(const Json& parent, const char* key) {
  if (!parent.is_object()) return nullptr;
  const auto value = parent.find(key);
  return value == parent.end() ? nullptr : &*value;
}

inline std::string text_at(const Json& parent, const char* key) {
  const Json* value = at(parent, key);
  return value != nullptr && value->is_string() ? value->get<std::string>() : "";
}

inline double number_at(const Json& parent, const char* key) {
  const Json* value = at(parent, key);
  return value != nullptr && value->is_number() ? value->get<double>() : 0;
}

inline std::int32_t integer_at(const Json& parent, const char* key) {
  const double value = number_at(parent, key);
  return std::abs(value) < 1e9 ? static_cast<std::int32_t>(value) : 0;
}

inline const Json& list_at(const Json& parent, const char* key) {
  static const Json none = Json::array();
  const Json* value = at(parent, key);
  return value != nullptr && value->is_array() ? *value : none;
}

/// Returns `count` numbers; none when there are fewer.
template <std::size_t count>
std::optional<std::array<double, count>> numbers_at(const Json& parent, const char* key) {
  const Json& list = list_at(parent, key);
  std::array<double, count> numbers{};
  if (list.size() < count) return std::nullopt;
  for (std::size_t i = 0; i < count; ++i) {
    if (!list[i].is_number()) return std::nullopt;
    numbers[i] = list[i].get<double>();
  }
  return numbers;
}

inline sim::Pose pose_of(const std::array<double, 7>& numbers) {
  const sim::Quaterniond q(numbers[3], numbers[4], numbers[5], numbers[6]);
  sim::Pose pose = sim::Pose::Identity();
  pose.translation() = sim::Vector3d(numbers[0], numbers[1], numbers[2]);
  if (q.norm() > 0.5) pose.linear() = q.normalized().toRotationMatrix();
  return pose;
}

inline sim::Pose pose_at(const Json& parent, const char* key) {
  const auto numbers = numbers_at<7>(parent, key);
  return numbers ? pose_of(*numbers) : sim::Pose::Identity();
}

/// Returns x, y, z, qw, qx, qy, qz.
inline std::array<double, 7> numbers_of(const sim::Pose& pose) {
  const sim::Quaterniond q(pose.linear());
  const sim::Vector3d p = pose.translation();
  return {p.x(), p.y(), p.z(), q.w(), q.x(), q.y(), q.z()};
}

/// Reads the devices of a scene; its bodies must be known.
void read_devices(const Json& scene, ConverterContext& context);

}  // namespace bridges::ros2
