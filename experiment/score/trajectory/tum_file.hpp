// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdio>
#include <memory>
#include <string>

#include "sim/base/math.hpp"

namespace experiment {

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
