// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <optional>

#include "shoal/planar_lidar_t.hpp"

namespace autonomy {

/// Mean of the scans of a lidar at rest, whose errors average out.  A value.
class MeanScan {
 public:
  /// A scan with other beams than the first one has no effect.
  void add(const shoal::planar_lidar_t& scan);
  void clear() { *this = {}; }
  /// Returns the first scan with the mean ranges; none without a scan.  A beam whose ranges vary by more than the noise
  /// of a lidar, such as one that grazes an edge, has range 0.
  std::optional<shoal::planar_lidar_t> scan() const;

 private:
  std::optional<shoal::planar_lidar_t> first_;
  int count_ = 0;
  Eigen::ArrayXd off_m_, off_m2_;  ///< sums of the differences to the first scan, and of their squares
};

}  // namespace autonomy
