// SPDX-License-Identifier: BSD-3-Clause
#include "tools/programs/bridges/bridge_options.hpp"

#include "sim/config/config_node.hpp"
#include "sim/config/param_reader.hpp"
#include "sim/world_file/world_config.hpp"

namespace autonomy {

using bridges::VehicleNavigation;

void BridgedVehicle::declare(command_line::DeclaredOptions& options) {
  options.text("gps", "DEVICE", gps, "GPS: position and speed");
  options.text("ahrs", "DEVICE", ahrs, "AHRS: heading, pitch, roll");
  options.text("compass", "DEVICE", compass, "compass: heading, instead of an AHRS");
  options.text("pressure", "DEVICE", pressure, "pressure sensor: depth");
  options.text("altimeter", "DEVICE", altimeter, "altimeter: altitude");
  options.text("dvl", "DEVICE", dvl, "DVL: altitude, and speed without GPS");
  options.text("estimate", "CHANNEL", estimate,
               "position and speed from shoal.estimate_t on this channel, instead of GPS");
  options.text("autopilot", "DEVICE", autopilot, "autopilot that takes heading, speed and depth");
  options.text("port_thruster", "DEVICE", port_thruster, "left propeller of a vehicle that is steered by two")
      .needs({"starboard_thruster"});
  options.text("starboard_thruster", "DEVICE", starboard_thruster, "right propeller").needs({"port_thruster"});
  options.number("full_ahead", full_ahead, 1e-6, 1e6, "command of both propellers at 100 percent");
  options.flag("truth", truth, "navigation is the truth of the simulator, instead of the reports of devices");
}

VehicleNavigation::Position BridgedVehicle::position() const {
  if (truth) return VehicleNavigation::Position::truth;
  return estimate.empty() ? VehicleNavigation::Position::gps : VehicleNavigation::Position::estimate;
}

std::string BridgedVehicle::command_channel(const std::string& device) const {
  return device.empty() ? "" : name + "." + device + ".cmd";
}

bridges::ThrusterPair BridgedVehicle::thrusters() const {
  return {command_channel(port_thruster), command_channel(starboard_thruster), full_ahead, command_channel(autopilot)};
}

void BridgedVehicle::subscribe(shoal::Client& client, VehicleNavigation& navigation,
                               const std::function<void(VehicleNavigation::Fields)>& changed) const {
  const auto listen = [&]<class Message>(const std::string& channel) {
    client.subscribe<Message>(channel, [&navigation, changed](const Message& message) {
      const VehicleNavigation::Fields fields = navigation.take(message);
      if (!fields.empty()) changed(fields);
    });
  };
  if (truth) listen.operator()<shoal::sim_state_t>("sim.state");
  if (!estimate.empty()) listen.operator()<shoal::estimate_t>(estimate);
  const auto listen_to = [&]<class Message>(const std::string& device) {
    if (!device.empty()) listen.template operator()<Message>(name + "." + device);
  };
  listen_to.operator()<shoal::gps_data_t>(gps);
  listen_to.operator()<shoal::ins_t>(ahrs);
  listen_to.operator()<shoal::compass_t>(compass);
  listen_to.operator()<shoal::pressure_t>(pressure);
  listen_to.operator()<shoal::sonar_range_t>(altimeter);
  listen_to.operator()<shoal::dvl_t>(dvl);
}

sim::GeodeticPosition origin_of_world(const std::string& resolved_config) {
  sim::Diagnostics diagnostics;
  const sim::ConfigNode world = sim::parse_config_text(resolved_config, "sim.info", diagnostics);
  sim::OriginConfig origin;
  if (const sim::ConfigNode* node = world.find("origin")) {
    sim::ParamReader in(*node, "origin", diagnostics);
    origin.read(in);
  }
  diagnostics.throw_if_any();
  return origin.position;
}

}  // namespace autonomy
