// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdio>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "sim/base/math.hpp"

namespace experiment {

/// Estimates of a position that another program wrote, in the world frame.
struct EstimateFile {
  struct Row {
    double time_s = 0;
    sim::Vector3d position_m = sim::Vector3d::Zero();
    std::optional<sim::Matrix3d> covariance_m2;
  };
  std::vector<Row> rows;    ///< by increasing time
  bool has_height = false;  ///< z is in the file; else it is 0
};

/// Reads a text of one of these forms, with `#` comments:
///
/// - TUM: `t x y z qx qy qz qw`, separated by blanks; the orientation is checked and not used;
/// - CSV with the names of its columns in the first line: t, x, y, and optionally z and the covariance, xx, xy, yy, and
///   with z also xz, yz, zz; or those of shoal-nav: time_s, x_m, y_m, cov_xx_m2, ...; further columns are not read;
/// - CSV without names: t, x, y or t, x, y, z.
///
/// Times in s, positions in m.  `file`: name for errors.  Throws sim::ConfigError.
EstimateFile parse_estimates(std::string_view text, const std::string& file);

/// Writer of a trajectory in the form of the TUM RGB-D benchmark, `t x y z qx qy qz qw`, which evo reads.
class TumFile {
 public:
  /// Throws std::runtime_error with path and reason.
  explicit TumFile(const std::string& path);
  void add(double time_s, const sim::Vector3d& p_W, const sim::Quaterniond& q_WB);
  /// Throws std::runtime_error when the file could not be written.
  void close();

 private:
  struct Closer {
    void operator()(std::FILE* file) const { std::fclose(file); }
  };
  std::string path_;
  std::unique_ptr<std::FILE, Closer> file_;
};

}  // namespace experiment
