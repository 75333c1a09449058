// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <limits>
#include <span>
#include <string>
#include <string_view>

#include "bridges/ros2/cdr.hpp"
#include "bridges/ros2/converter.hpp"
#include "bridges/ros2/ros2_names.hpp"

namespace bridges::ros2 {

inline constexpr const char* world_frame = "world";
/// Endings of frames in that of a device: of a camera, x right, y down, z ahead (REP 103); of a sonar, x along its
/// beam.
inline constexpr const char* optical_ending = "_optical";
inline constexpr const char* beam_ending = "_beam";
inline constexpr std::array<double, 9> unknown_3x3{};

inline std::string optical_frame_of(std::string_view channel) {
  return frame_of(channel) + optical_ending;
}

/// Frame of the vehicle of a channel: `rover1` of `rover1.odometry`.
inline std::string vehicle_frame(std::string_view channel, const ConverterContext& context) {
  if (const std::string& known = context.device_of(channel).vehicle; !known.empty()) return known;
  const std::string frame = frame_of(channel);
  return frame.substr(0, frame.rfind('/'));
}

/// Frame in which the wheel odometry of a vehicle is; REP 105.
inline std::string odometry_frame(std::string_view vehicle) {
  return std::string(vehicle) + "/odom";
}

/// Frame of a body: `rover1/body/base`, so that no device has the same.
inline std::string body_frame(std::string_view owner, std::string_view body) {
  return owner.empty() ? "body/" + std::string(body) : std::string(owner) + "/body/" + std::string(body);
}

/// Appends builtin_interfaces/Time, which ends on 2038-01-19; beyond its range the nearest time.
inline void put_time(CdrWriter& out, std::int64_t utime) {
  constexpr std::int64_t us_per_s = 1'000'000;
  utime = std::clamp(utime, std::numeric_limits<std::int32_t>::min() * us_per_s,
                     std::numeric_limits<std::int32_t>::max() * us_per_s);
  const std::int64_t us = utime % us_per_s;  // negative before the epoch
  const std::int64_t borrowed = us < 0 ? 1 : 0;
  out.put(static_cast<std::int32_t>(utime / us_per_s - borrowed));
  out.put(static_cast<std::uint32_t>((us + borrowed * us_per_s) * 1000));
}

/// Appends std_msgs/Header.
inline void put_header(CdrWriter& out, std::int64_t utime, std::string_view frame) {
  put_time(out, utime);
  out.put(frame);
}

/// Appends an array of fixed size, such as geometry_msgs/Vector3 and covariances.
template <std::size_t size>
void put_numbers(CdrWriter& out, const double (&values)[size]) {
  out.put_array(std::span<const double>(values));
}

/// Appends geometry_msgs/Quaternion, with w last, of w, x, y, z.
inline void put_quaternion(CdrWriter& out, std::span<const double, 4> wxyz) {
  for (const std::size_t i : {1u, 2u, 3u, 0u}) out.put(wxyz[i]);
}

/// Appends a matrix of 6 x 6 with the covariance of the position; that of the rotation is zero.
inline void put_position_covariance(CdrWriter& out, std::span<const double, 9> covariance) {
  for (std::size_t row = 0; row < 6; ++row)
    for (std::size_t column = 0; column < 6; ++column)
      out.put(row < 3 && column < 3 ? covariance[3 * row + column] : 0.0);
}

/// Appends a matrix of 6 x 6 zeros: unknown.
inline void put_unknown_6x6(CdrWriter& out) {
  put_position_covariance(out, unknown_3x3);
}

}  // namespace bridges::ros2
