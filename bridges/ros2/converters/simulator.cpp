// SPDX-License-Identifier: BSD-3-Clause
#include "bridges/ros2/converter.hpp"
#include "bridges/ros2/converters/common_parts.hpp"
#include "shoal/sim_audit_t.hpp"
#include "shoal/sim_event_t.hpp"
#include "shoal/sim_vehicle_t.hpp"
#include "shoal/utime_t.hpp"

namespace bridges::ros2 {
namespace {

constexpr std::uint8_t log_info = 20, log_warn = 30;

/// Appends rcl_interfaces/Log; the source of the text is not a place in a program.
void put_log(CdrWriter& out, std::int64_t utime, std::uint8_t level, std::string_view name, std::string_view text) {
  put_time(out, utime);
  out.put(level);
  out.put(name);
  out.put(text);
  out.put(std::string_view());
  out.put(std::string_view());
  out.put(std::uint32_t{0});
}

bool write_audit(const shoal::sim_audit_t& message, std::string_view, CdrWriter& out) {
  put_log(out, message.utime, log_warn, message.client, message.kind + ": " + message.text);
  return true;
}

bool write_vehicle_log(const shoal::sim_vehicle_t& message, std::string_view, CdrWriter& out) {
  put_log(out, message.utime, log_info, message.vehicle, message.present != 0 ? "added" : "removed");
  return true;
}

bool write_event(const shoal::sim_event_t& message, std::string_view, CdrWriter& out) {
  put_log(out, message.utime, message.kind == "fault" ? log_warn : log_info, message.who,
          message.text.empty() ? message.kind : message.kind + ": " + message.text);
  return true;
}

SHOAL_ROS2_CONVERTER(write_event, "rcl_interfaces/msg/Log", "/rosout");
SHOAL_ROS2_CONVERTER(write_audit, "rcl_interfaces/msg/Log", "/rosout");
SHOAL_ROS2_CONVERTER(write_vehicle_log, "rcl_interfaces/msg/Log", "/rosout");

/// Simulated time.  Other channels may have this type.
bool write_clock(const shoal::utime_t& message, std::string_view channel, CdrWriter& out) {
  if (channel != "sim.clock") return false;
  put_time(out, message.utime);
  return true;
}

SHOAL_ROS2_CONVERTER(write_clock, "rosgraph_msgs/msg/Clock", "/clock");

}  // namespace
}  // namespace bridges::ros2
