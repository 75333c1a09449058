// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "shoal/acoustic_received_t.hpp"
#include "shoal/modem_send_t.hpp"
#include "sim/vehicle/mounted_device.hpp"
#include "tests/devices/world_fixture.hpp"

namespace test {

/// A vehicle of modem_sea(): a ball without weight.
struct Moored {
  std::string name;
  std::string position_m;
  std::string devices;  ///< of the list, such as `{name: modem, type: acoustic_modem}`
  std::string keys;     ///< further ones of the vehicle file, such as `clock: {offset_s: 1}`
};

/// Vehicles in water where sound goes at 1500 m/s; steps of 10 ms.  `more`: further keys of the world.
inline std::string modem_sea(const std::vector<Moored>& vehicles, const std::string& more = "",
                             const std::string& medium = "{water: {surface_m: 0, sound_speed_mps: 1500}}") {
  std::string yaml =
      "shoal: 1\nphysics: {step_s: 0.01, gravity_mps2: 0}\nmedium: " + medium + "\n" + more + "vehicles:\n";
  for (const Moored& vehicle : vehicles)
    yaml +=
        "  - {name: " + vehicle.name + ", position_m: " + vehicle.position_m +
        ", model: {shoal: 1, vehicle: " + "ball_" + vehicle.name +
        ", bodies: [{name: hull, hydrodynamics: {model: none}, parts: [{shape: sphere, radius_m: 0.1, mass_kg: 1}]}]"
        ", devices: [" +
        vehicle.devices + "]" + (vehicle.keys.empty() ? "" : ", " + vehicle.keys) + "}}\n";
  return yaml;
}

inline shoal::modem_send_t bytes_to(const std::string& text, const std::string& destination = "") {
  shoal::modem_send_t send{};
  send.destination = destination;
  send.size = static_cast<std::int32_t>(text.size());
  send.data.assign(text.begin(), text.end());
  return send;
}

template <typename Received>
std::string text_of(const Received& received) {
  return {received.data.begin(), received.data.end()};
}

template <typename Model>
const Model& device_of(const sim::World& world, const std::string& full_name) {
  return dynamic_cast<const Model&>(*world.find_device(full_name)->sensor());
}
template <typename Model>
const Model& device_of(const LoadedTestWorld& test, const std::string& full_name) {
  return device_of<Model>(test.world, full_name);
}

}  // namespace test
