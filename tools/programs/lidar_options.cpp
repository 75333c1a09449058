// SPDX-License-Identifier: BSD-3-Clause
#include "tools/programs/lidar_options.hpp"

namespace autonomy {

void LidarOptions::declare(command_line::DeclaredOptions& options) {
  options
      .tuple(
          "lidar_m", {"x", "y"}, sim::any_place(),
          [this](const auto& numbers) {
            mount.pose.p_W = {numbers[0], numbers[1]};
          },
          "position of the lidar on the vehicle, forward and left")
      .by_default({0, 0});
  options.number("lidar_yaw_deg", yaw_deg, -360, 360,
                 "heading of the lidar on the vehicle, counter-clockwise from forward");
  options.number("lidar_range_m", mount.range_m, 0.1, 1000, "a beam of at least this length is taken as a miss");
  options.number("use_range_m", mount.use_range_m, 0.1, 1000, "beams are truncated to this length");
}

LidarMount LidarOptions::mounted() const {
  LidarMount mounted = mount;
  mounted.pose.yaw_rad = sim::degrees_to_radians(yaw_deg);
  return mounted;
}

}  // namespace autonomy
