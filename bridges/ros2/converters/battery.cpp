// SPDX-License-Identifier: BSD-3-Clause
#include <limits>

#include "bridges/ros2/converter.hpp"
#include "bridges/ros2/converters/common_parts.hpp"
#include "shoal/battery_t.hpp"

namespace bridges::ros2 {
namespace {

/// The current of the standard type is negative when the battery discharges; what is not measured is NaN.
bool write_battery(const shoal::battery_t& message, std::string_view channel, CdrWriter& out) {
  constexpr float unmeasured = std::numeric_limits<float>::quiet_NaN();
  constexpr std::uint8_t unknown = 0, discharging = 2;
  put_header(out, message.utime, frame_of(channel));
  out.put(static_cast<float>(message.voltage_V));
  out.put(unmeasured);  // temperature
  out.put(static_cast<float>(-message.current_A));
  for (int i = 0; i < 3; ++i) out.put(unmeasured);  // charge and capacities in Ah
  out.put(static_cast<float>(message.charge));
  out.put(message.current_A > 0 ? discharging : unknown);
  out.put(unknown);  // health
  out.put(unknown);  // technology
  out.put(true);     // present
  out.put_count(0);  // voltages of cells
  out.put_count(0);  // temperatures of cells
  out.put(std::string_view());
  out.put(std::string_view());
  return true;
}

SHOAL_ROS2_CONVERTER(write_battery, "sensor_msgs/msg/BatteryState", "battery");

}  // namespace
}  // namespace bridges::ros2
