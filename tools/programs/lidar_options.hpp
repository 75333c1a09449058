// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "autonomy/mapping/lidar_odometry.hpp"
#include "tools/command_line/declared_options.hpp"

namespace autonomy {

/// Options of how a lidar is mounted.  Their defaults are the values before declare().
struct LidarOptions {
  LidarMount mount;
  double yaw_deg = 0;

  void declare(command_line::DeclaredOptions& options);
  LidarMount mounted() const;
};

}  // namespace autonomy
