// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include "autonomy/cooperative/driver/estimate_files.hpp"
#include "autonomy/cooperative/driver/offline.hpp"

namespace navigation {

/// Writes the scores of several algorithms on one record as JSON, for studies and scripts:
///
///     {"world": ..., "frame_bytes": 128, "from_s": 600, "algorithms": [
///        {"name": "ci", "us_per_event": 0.7, "vehicles": {
///           "auv1": {"rms_m": ..., "nees_mean": ..., "inside_95_share": ..., "samples": ..., "bytes_per_h": ...}}}]}
///
/// Numbers have all digits; figures without samples are null.  `us_per_event` is the only one that differs between
/// equal runs.
class ScoreFile {
 public:
  ScoreFile(const NavRecord& record, std::size_t frame_bytes, double from_s)
      : record_(record), frame_bytes_(frame_bytes), from_s_(from_s) {}

  /// Adds the scores of an algorithm.
  void add(const OfflineRun& run);
  /// Adds an algorithm that cannot work here: an entry with `left_out` instead of its figures.
  void leave_out(const std::string& name, const std::string& why);
  /// Throws std::runtime_error when the file cannot be written.
  void write(const std::string& path) const;

 private:
  struct OfVehicle {
    NavScore score;
    double bytes_per_h = 0;
  };
  struct OfAlgorithm {
    std::string name, left_out;
    double us_per_event = 0;
    std::vector<OfVehicle> vehicles;
  };
  const NavRecord& record_;
  std::size_t frame_bytes_;
  double from_s_;
  std::vector<OfAlgorithm> algorithms_;
};

}  // namespace navigation
