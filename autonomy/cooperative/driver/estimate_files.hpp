// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include "autonomy/cooperative/driver/offline.hpp"

namespace navigation {

/// Agreement of the estimates of a vehicle with the truth, horizontally.
struct NavScore {
  double rms_m = 0;
  double nees = 0;       ///< mean; 2 when consistent
  double inside_95 = 0;  ///< share inside the 95 % ellipse
  int samples = 0;
};
/// Scores the estimates from a time on.
NavScore score_of(const std::vector<OfflineRun::Published>& estimates, const std::vector<NavRecord::Truth>& truth,
                  std::int64_t epoch_utime, std::int64_t from_us);

/// Writes the estimates of a run below a folder, which is made:
///
///     ALGORITHM.lcm             event log with NAME.estimate
///     ALGORITHM/NAME.csv        time_s, utime, x_m, y_m, z_m, vx_mps, vy_mps, yaw_rad, cov_xx_m2, cov_xy_m2, cov_yy_m2
///     ALGORITHM/NAME.tum        t x y z qx qy qz qw: for evo and other tools
///     ALGORITHM/RobotN_Estimate.dat   t x y theta, N from 1: as RobotN_Groundtruth.dat of MR.CLAM
///
/// Times in the files are seconds since the start, except `utime`.  Throws std::runtime_error when a file cannot be
/// written.
void write_estimates(const std::string& folder, const NavRecord& record, const OfflineRun& run);

}  // namespace navigation
