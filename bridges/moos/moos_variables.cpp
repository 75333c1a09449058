// SPDX-License-Identifier: BSD-3-Clause
#include "bridges/moos/moos_variables.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <optional>
#include <utility>

#include "shoal/message_codec.hpp"
#include "shoal/modem_send_t.hpp"
#include "shoal/thrust_rudder_elevator_command_t.hpp"
#include "sim/base/number.hpp"

namespace bridges {

namespace {

/// Names of the fields, in their order.
constexpr const char* nav_names[] = {"NAV_X",       "NAV_Y",     "NAV_LAT",      "NAV_LONG",  "NAV_SPEED",
                                     "NAV_HEADING", "NAV_DEPTH", "NAV_ALTITUDE", "NAV_PITCH", "NAV_ROLL"};
static_assert(std::size(nav_names) == static_cast<std::size_t>(NavField::roll) + 1);

constexpr std::string_view node_message_start = "src_node=";

/// Number of a variable that may have been posted as text.
std::optional<double> number_in(const MoosMessage& message) {
  const std::optional<double> number =
      message.value_type == 'D' ? std::optional(message.number) : sim::read_number(message.text);
  return number && std::isfinite(*number) ? number : std::nullopt;
}

/// Value of `key=value,key=value`; empty when there is none.
std::string value_in(std::string_view text, std::string_view key) {
  while (!text.empty()) {
    const std::string_view item = text.substr(0, text.find(','));
    if (item.starts_with(key) && item.substr(key.size()).starts_with('='))
      return std::string(item.substr(key.size() + 1));
    text.remove_prefix(std::min(item.size() + 1, text.size()));
  }
  return {};
}

std::string hex_of(std::span<const std::uint8_t> bytes) {
  std::string text;
  for (const std::uint8_t byte : bytes) text += fmt::format("{:02X}", byte);
  return text;
}

std::optional<std::string> bytes_of_hex(std::string_view hex) {
  if (hex.size() % 2 != 0) return std::nullopt;
  std::string bytes;
  for (std::size_t i = 0; i < hex.size(); i += 2) {
    unsigned value = 0;
    const auto [end, error] = std::from_chars(hex.data() + i, hex.data() + i + 2, value, 16);
    if (error != std::errc{} || end != hex.data() + i + 2) return std::nullopt;
    bytes += static_cast<char>(value);
  }
  return bytes;
}

}  // namespace

std::vector<MoosValue> nav_values(const VehicleNavigation& navigation, VehicleNavigation::Fields fields) {
  std::vector<MoosValue> values;
  for (const NavField field : fields) {
    if (!navigation.has(field)) continue;
    // MOOS has its attitudes in radians, except the heading.
    const bool is_tilt = field == NavField::pitch || field == NavField::roll;
    const double value = navigation[field];
    values.push_back({nav_names[static_cast<std::size_t>(field)], is_tilt ? sim::degrees_to_radians(value) : value});
  }
  return values;
}

std::vector<MoosValue> node_report(const MoosNode& node, const VehicleNavigation& navigation, double moos_time_s) {
  using enum NavField;
  if (!navigation.has(x) || !navigation.has(heading)) return {};
  const auto known = [&](NavField field) { return navigation.has(field) ? navigation[field] : 0; };
  std::string text = fmt::format("NAME={},TYPE={},TIME={:.3f},X={:.3f},Y={:.3f},", node.name, node.type, moos_time_s,
                                 navigation[x], navigation[y]);
  if (navigation.has(latitude))
    text += fmt::format("LAT={:.8f},LON={:.8f},", navigation[latitude], navigation[longitude]);
  text += fmt::format("SPD={:.3f},HDG={:.2f},DEP={:.3f},LENGTH={:.2f},MODE=SHOAL", known(speed), navigation[heading],
                      known(depth), node.length_m);
  return {{"NODE_REPORT_LOCAL", std::move(text)}};
}

MoosValue laser_value(const shoal::planar_lidar_t& scan) {
  std::string text = fmt::format("Time={:.6f},MinAngle={:.4f},AngularResolution={:.4f},Range=[{}]{{",
                                 1e-6 * static_cast<double>(scan.utime), sim::radians_to_degrees(scan.rad0),
                                 sim::radians_to_degrees(scan.radstep), scan.ranges.size());
  for (std::size_t i = 0; i < scan.ranges.size(); ++i)
    text += fmt::format("{}{:.3f}", i > 0 ? "," : "", scan.ranges[i]);
  return {"LASERRANGE", text + "}"};
}

MoosValue odometry_value(const shoal::odometry_t& odometry) {
  return {"ODOMETRY", fmt::format("Time={:.6f},X={:.4f},Y={:.4f},O={:.5f}", 1e-6 * static_cast<double>(odometry.utime),
                                  odometry.x_m, odometry.y_m, odometry.theta_rad)};
}

MoosValue modem_value(const shoal::modem_received_t& received) {
  std::string bytes(received.data.begin(), received.data.end());
  if (bytes.starts_with(node_message_start)) return {"NODE_MESSAGE", std::move(bytes)};
  return {"SHOAL_MODEM_RECEIVED",
          fmt::format("src={},dest={},hex={}", received.source, received.destination, hex_of(received.data))};
}

std::vector<std::string> MoosCommands::variables() const {
  std::vector<std::string> names;
  if (options_.control == Control::helm) names = {"DESIRED_HEADING", "DESIRED_SPEED", "DESIRED_DEPTH"};
  if (options_.control == Control::actuators) names = {"DESIRED_RUDDER", "DESIRED_THRUST", "DESIRED_ELEVATOR"};
  if (!options_.modem.empty()) names.insert(names.end(), {"NODE_MESSAGE_LOCAL", "SHOAL_MODEM_SEND"});
  return names;
}

void MoosCommands::take(const MoosMessage& message) {
  if (message.key == "NODE_MESSAGE_LOCAL" || message.key == "SHOAL_MODEM_SEND")
    take_modem_message(message);
  else if (message.key.starts_with("DESIRED_") && !take_set_point(message))
    ++refused_;
}

bool MoosCommands::take_set_point(const MoosMessage& message) {
  const std::pair<const char*, double*> points[] = {
      {"DESIRED_HEADING", &helm_.heading_deg}, {"DESIRED_SPEED", &helm_.speed_mps},
      {"DESIRED_DEPTH", &helm_.depth_m},       {"DESIRED_RUDDER", &rudder_percent_},
      {"DESIRED_THRUST", &thrust_percent_},    {"DESIRED_ELEVATOR", &elevator_percent_}};
  const auto number = number_in(message);
  if (!number) return false;
  for (const auto& [name, value] : points)
    if (message.key == name) {
      *value = *number;
      changed_ = true;
    }
  return true;
}

void MoosCommands::take_modem_message(const MoosMessage& message) {
  std::optional<std::string> bytes;
  std::string destination;
  if (message.key == "NODE_MESSAGE_LOCAL") {
    if (message.text.starts_with(node_message_start)) bytes = message.text;
    destination = value_in(message.text, "dest_node");
    if (destination == "all") destination.clear();
  } else {
    destination = value_in(message.text, "dest");
    bytes = bytes_of_hex(value_in(message.text, "hex"));
  }
  if (options_.modem.empty() || !bytes || bytes->empty() || modem_messages_.size() >= max_modem_messages)
    ++refused_;
  else
    modem_messages_.push_back({std::move(destination), std::move(*bytes)});
}

std::vector<ChannelPayload> MoosCommands::actuator_commands(std::int64_t utime) const {
  // The rudder of MOOS is positive to starboard, that of Shoal counter-clockwise; both elevators are positive
  // downwards.
  const double rudder = std::clamp(rudder_percent_, -100.0, 100.0);
  if (!options_.thrusters.port.empty())
    return thruster_commands(options_.thrusters, thrust_percent_ + rudder, thrust_percent_ - rudder, utime);
  shoal::thrust_rudder_elevator_command_t command{};
  command.utime = utime;
  command.thrust = std::clamp(thrust_percent_, -100.0, 100.0) / 100;
  command.rudder = -rudder / 100;
  command.elevator = std::clamp(elevator_percent_, -100.0, 100.0) / 100;
  return {{options_.drive, shoal::encode(command)}};
}

std::vector<ChannelPayload> MoosCommands::take_commands(std::int64_t utime) {
  std::vector<ChannelPayload> commands;
  if (std::exchange(changed_, false)) {
    if (options_.control == Control::helm) commands.push_back(helm_command(options_.autopilot, helm_, utime));
    if (options_.control == Control::actuators) commands = actuator_commands(utime);
  }
  for (const ModemMessage& message : std::exchange(modem_messages_, {})) {
    shoal::modem_send_t send{};
    send.utime = utime;
    send.destination = message.destination;
    send.data.assign(message.bytes.begin(), message.bytes.end());
    send.size = static_cast<std::int32_t>(send.data.size());
    commands.push_back({options_.modem, shoal::encode(send)});
  }
  return commands;
}

}  // namespace bridges
