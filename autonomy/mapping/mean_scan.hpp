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
  /// Returns the first scan with the mean ranges; none without a scan.  Ranges that differ from the first by more than
  /// 0.2 m do not count.  A beam with many of them, as one that grazes an edge, has range 0.
  std::optional<shoal::planar_lidar_t> scan() const;

 private:
  std::optional<shoal::planar_lidar_t> first_;
  int count_ = 0;
  Eigen::ArrayXd off_m_;   ///< sum of the differences to the first scan that count
  Eigen::ArrayXi counts_;  ///< their number
};

}  // namespace autonomy
