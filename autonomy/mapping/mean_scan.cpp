// SPDX-License-Identifier: BSD-3-Clause
#include "autonomy/mapping/mean_scan.hpp"

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
    off_m_ = Eigen::ArrayXd::Zero(static_cast<Eigen::Index>(scan.ranges.size()));
    counts_ = Eigen::ArrayXi::Zero(off_m_.size());
  }
  if (scan.ranges.size() != first_->ranges.size() || scan.rad0 != first_->rad0 || scan.radstep != first_->radstep)
    return;
  constexpr double max_off_m = 0.2;
  const Eigen::ArrayXd off_m = ranges_of(scan) - ranges_of(*first_);
  // A beam at an edge jumps between two surfaces; only readings near the first one are averaged.
  const auto counts = off_m.abs() <= max_off_m;
  off_m_ += counts.select(off_m, 0);
  counts_ += counts.cast<int>();
  ++count_;
}

std::optional<shoal::planar_lidar_t> MeanScan::scan() const {
  constexpr double min_share = 0.9;
  if (!first_) return std::nullopt;
  shoal::planar_lidar_t scan = *first_;
  for (std::size_t i = 0; i < scan.ranges.size(); ++i) {
    const auto beam = static_cast<Eigen::Index>(i);
    // A beam that saw something else too often is dropped (range 0).
    scan.ranges[i] = counts_[beam] < min_share * count_
                         ? 0
                         : static_cast<float>(static_cast<double>(scan.ranges[i]) + off_m_[beam] / counts_[beam]);
  }
  return scan;
}

}  // namespace autonomy
