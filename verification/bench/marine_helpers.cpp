// SPDX-License-Identifier: BSD-3-Clause
#include "verification/bench/marine_helpers.hpp"

#include <spdlog/fmt/fmt.h>

#include <cmath>

#include "shoal/actuator_command_t.hpp"
#include "shoal/helm_command_t.hpp"
#include "shoal/message_codec.hpp"
#include "shoal/modem_send_t.hpp"

namespace verification {
namespace {

void send_actuator(const sim::Vehicle& vehicle, const char* device, double value, sim::Bus& bus) {
  bus.publish(vehicle.name() + "." + device + ".cmd", shoal::encode(shoal::actuator_command_t{0, value}), {});
}

}  // namespace

std::string marine_fleet_text(const MarineFleet& fleet, int vehicles) {
  return fmt::format(
      "shoal: 1\nname: {}\nphysics: {{step_s: {}}}\n"
      "medium: {{water: {{}}, {}current: [{{velocity_mps: [0.2, 0.1, 0]}}]}}\n{}"
      "vehicles:\n  - name: auv\n    count: {}\n    position_m: [0, 0, {}]\n"
      "    placement: {{pattern: grid, spacing_m: {}}}\n    {}\n",
      fleet.name, fleet.step_s, fleet.more_of_medium, fleet.objects, vehicles, -fleet.depth_m, fleet.spacing_m,
      fleet.vehicle);
}

void StartCommands::think(sim::Time) {
  if (sent_) return;
  sent_ = true;
  int index = 0;
  for (const auto& vehicle : world_.vehicles()) command_(*vehicle, index++, bus_);
}

void set_off_remus(const sim::Vehicle& vehicle, int index, sim::Bus& bus) {
  send_actuator(vehicle, "propeller", 1100 + 10 * (index % 20), bus);  // rpm
  send_actuator(vehicle, "rudder", 0.01 * (index % 7 - 3), bus);       // rad
  send_actuator(vehicle, "stern_planes", 0.002 * (index % 5 - 2), bus);
}

void set_off_otter(const sim::Vehicle& vehicle, int index, sim::Bus& bus) {
  send_actuator(vehicle, "port", 60 + index % 7, bus);  // rad/s
  send_actuator(vehicle, "starboard", 60 + index % 5, bus);
}

void set_off_autopilot(const sim::Vehicle& vehicle, int index, sim::Bus& bus) {
  shoal::helm_command_t helm{};
  helm.speed_mps = 1.5;
  helm.heading_rad = std::remainder(2.4 * index, 2 * M_PI);
  helm.depth_m = 15 + index % 10;
  helm.altitude_m = std::nan("");
  bus.publish(vehicle.name() + ".autopilot.cmd", shoal::encode(helm), {});
}

Talkers::Talkers(const sim::World& world, sim::Bus& bus) : bus_(bus) {
  for (const auto& vehicle : world.vehicles())
    if (world.find_device(vehicle->name() + "/modem") != nullptr) channels_.push_back(vehicle->name() + ".modem.cmd");
  shoal::modem_send_t message{};
  message.data.assign(32, 1);
  message.size = 32;
  payload_ = shoal::encode(message);
}

void Talkers::think(sim::Time now) {
  constexpr double period_s = 10;
  if (channels_.empty()) return;
  const auto count = static_cast<std::int64_t>(channels_.size());
  while (static_cast<double>(next_) * period_s / static_cast<double>(count) <= sim::to_seconds(now))
    bus_.publish(channels_[static_cast<std::size_t>(next_++ % count)], payload_, now);
}

}  // namespace verification
