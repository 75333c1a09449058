// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "sim/base/math.hpp"
#include "viewer/log/log_index.hpp"
#include "viewer/log/log_poses.hpp"

namespace viewer {

/// First difference between two logs.
struct LogDifference {
  std::int64_t time_us = 0;
  std::optional<std::int64_t> step;  ///< unset: the difference is one of poses
  std::string by;                    ///< `sim.hash` or `poses`
};

/// Returns the first difference at equal times: of the hashes of the state where both logs have them, else of the poses
/// of bodies with equal names.  None: equal over the common time span.  Throws BusError.
std::optional<LogDifference> first_difference(const std::string& path_a, const LogIndex& a, const std::string& path_b,
                                              const LogIndex& b);

/// Distances of each vehicle between two logs over time: of the frames of vehicles with the same name.  They are
/// computed incrementally, so that the page stays responsive.
class LogDistances {
 public:
  /// Maximum number of times and of vehicles; those that the scene has first.
  static constexpr std::size_t max_times = 1000, max_vehicles = 30;

  /// `scene`: JSON of the scene of the first log, with the vehicles.  The indices must outlive this.  Throws BusError.
  LogDistances(const std::string& path_a, const LogIndex& a, const std::string& path_b, const LogIndex& b,
               const std::string& scene);

  /// Computes until a wall time; returns true when all is done.
  bool compute(std::chrono::steady_clock::time_point deadline);
  /// Returns the text `distances`: null where a log has no pose of the vehicle at this time.
  std::string text(const std::optional<LogDifference>& difference) const;

 private:
  struct Vehicle {
    std::string name, body;
    sim::Vector3d p_BV;  ///< origin of the vehicle in its base body
    std::vector<double> distance_m;
  };

  void read_vehicles(const std::string& scene);
  void add_time(std::int64_t time_us);

  LogPoses a_, b_;
  std::int64_t start_us_, end_us_;
  std::size_t times_ = 0;
  std::size_t done_ = 0;
  std::size_t left_out_ = 0;
  std::vector<std::int64_t> t_us_;
  std::vector<Vehicle> vehicles_;
};

}  // namespace viewer
