// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace navigation {

using Vector2 = Eigen::Vector2d;
using Matrix2 = Eigen::Matrix2d;
/// Time in microseconds, by the clock of a vehicle.
using Time = std::int64_t;

inline double seconds(Time time_us) {
  return static_cast<double>(time_us) * 1e-6;
}

/// Errors of a vehicle's devices that last: standard deviations at the start, from its vehicle file.  White errors come
/// with the measurements.  0: the error does not exist.
struct DeviceErrors {
  double heading_bias_rad = 0;      ///< constant part of the heading error
  double heading_walk_radprts = 0;  ///< random walk of the heading error, after 1 s
  double slow_heading_rad = 0;      ///< Gauss-Markov part of the heading error
  double slow_heading_time_s = 1;   ///< its correlation time
  double speed_scale = 0;           ///< constant ratio of the speed error to the speed
  double clock_s = 0;               ///< lead of the clock
  double clock_drift = 0;           ///< gain of the clock, a fraction
  double clock_walk_srts = 0;       ///< random walk of the clock, after 1 s
  double slow_fix_m = 0;            ///< Gauss-Markov part of each coordinate of a satellite fix
  double slow_fix_time_s = 1;       ///< its correlation time
};

/// Vehicle of the team.
struct Member {
  std::string name;
  DeviceErrors errors;
};

/// Returns the index of the vehicle with this name; std::nullopt if it is not among them.
template <class Vehicle>
std::optional<int> index_of_vehicle(const std::vector<Vehicle>& vehicles, const std::string& name) {
  for (std::size_t i = 0; i < vehicles.size(); ++i)
    if (vehicles[i].name == name) return static_cast<int>(i);
  return std::nullopt;
}

/// Returns vehicles as the members of a team.
template <class Vehicle>
std::vector<Member> members_of(const std::vector<Vehicle>& vehicles) {
  std::vector<Member> members;
  for (const Vehicle& vehicle : vehicles) members.push_back({vehicle.name, vehicle.errors});
  return members;
}

/// Initial knowledge of an estimator.
struct Setup {
  std::vector<Member> team;  ///< all vehicles that navigate together, in the order of the world file
  int own = 0;               ///< index of the own vehicle in `team`
  Time time = 0;             ///< of the start, by the own clock
  Vector2 position_W = Vector2::Zero();
  double position_std_m = 1;       ///< of each coordinate
  double sound_speed_mps = 1500;   ///< mean over the paths
  std::size_t payload_bytes = 24;  ///< limit of what make_payload() returns
  double gate = 0;                 ///< largest squared innovation over its variance of a used range; 0: no limit
  std::uint64_t seed = 1;          ///< of estimators that draw random numbers

  const DeviceErrors& errors() const { return team[static_cast<std::size_t>(own)].errors; }
};

}  // namespace navigation
