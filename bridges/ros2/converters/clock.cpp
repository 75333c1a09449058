// SPDX-License-Identifier: BSD-3-Clause
#include "bridges/ros2/converter.hpp"
#include "bridges/ros2/converters/common_parts.hpp"
#include "shoal/utime_t.hpp"

namespace bridges::ros2 {
namespace {

/// Simulated time.  Other channels may have this type.
bool write_clock(const shoal::utime_t& message, std::string_view channel, CdrWriter& out) {
  if (channel != "sim.clock") return false;
  put_time(out, message.utime);
  return true;
}

SHOAL_ROS2_CONVERTER(write_clock, "rosgraph_msgs/msg/Clock", "/clock");

}  // namespace
}  // namespace bridges::ros2
