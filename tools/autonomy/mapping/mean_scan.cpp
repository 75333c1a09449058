// SPDX-License-Identifier: BSD-3-Clause
#include "tools/autonomy/mapping/mean_scan.hpp"

namespace autonomy {

namespace {

Eigen::ArrayXd ranges_of(const shoal::planar_lidar_t& scan) {
  return Eigen::Map<const Eigen::ArrayXf>(scan.ranges.data(), static_cast<Eigen::Index>(scan.ranges.size()))
      .cast<double>();
}

}  // namespace

void MeanScan::add(const shoal::planar_lidar_t& scan) {
  if (!first_) {
    first_ = scan;
    off_m_ = off_m2_ = Eigen::ArrayXd::Zero(static_cast<Eigen::Index>(scan.ranges.size()));
  }
  if (scan.ranges.size() != first_->ranges.size() || scan.rad0 != first_->rad0 || scan.radstep != first_->radstep)
    return;
  const Eigen::ArrayXd off_m = ranges_of(scan) - ranges_of(*first_);
  off_m_ += off_m;
  off_m2_ += off_m.square();
  ++count_;
}

std::optional<shoal::planar_lidar_t> MeanScan::scan() const {
  constexpr double max_std_m = 0.05;
  if (!first_) return std::nullopt;
  shoal::planar_lidar_t scan = *first_;
  const Eigen::ArrayXd mean_m = off_m_ / count_, variance_m2 = off_m2_ / count_ - mean_m.square();
  for (std::size_t i = 0; i < scan.ranges.size(); ++i) {
    const auto beam = static_cast<Eigen::Index>(i);
    scan.ranges[i] = variance_m2[beam] > max_std_m * max_std_m
                         ? 0
                         : static_cast<float>(static_cast<double>(scan.ranges[i]) + mean_m[beam]);
  }
  return scan;
}

}  // namespace autonomy
