// SPDX-License-Identifier: BSD-3-Clause
#include <spdlog/fmt/fmt.h>

#include <cmath>
#include <string>

#include "verification/bench/marine_helpers.hpp"

namespace verification {

namespace {

/// `water`: value of `medium: water`.  The fleet is within 3 x 3 km, so that every modem receives every message.
std::string talking_fleet_text(const char* name, const char* water, int vehicles) {
  return fmt::format(
      "shoal: 1\nname: {}\nphysics: {{step_s: 0.02}}\n"
      "medium: {{water: {}, current: [{{velocity_mps: [0.2, 0.1, 0]}}], wind: {{velocity_mps: [5, 0, 0]}}}}\n"
      "objects: [{{name: bottom, fixed: true, position_m: [0, 0, -60], parts: [{{shape: plane}}]}}]\n"
      "vehicles:\n  - name: auv\n    count: {}\n    position_m: [0, 0, -20]\n"
      "    placement: {{pattern: grid, spacing_m: {:.1f}}}\n"
      "    model:\n      shoal: 1\n      vehicle: talker\n      bodies:\n"
      "        - {{name: hull, kinematic: true, parts: [{{shape: capsule, radius_m: 0.095, length_m: 1.41, "
      "rpy_deg: [0, 90, 0]}}]}}\n      devices:\n"
      "        - {{name: drive, type: naive_drive, start_speed_mps: 1.5}}\n"
      "        - {{name: heading, type: compass, rate_hz: 1}}\n"
      "        - {{name: modem, type: acoustic_modem, preset: micromodem_rate0, rate_hz: 5}}\n",
      name, water, vehicles, 3000 / std::sqrt(vehicles));
}

std::unique_ptr<ScenePrograms> make_talkers(const sim::World& world, sim::Bus& bus) {
  return std::make_unique<Talkers>(world, bus);
}

}  // namespace

BenchScene acoustics_scene() {
  return {"acoustics",
          "AUVs within 3 km whose modems all receive each other; each sends 32 bytes every 10 s, on straight lines",
          {10, 100, 1000},
          [](int vehicles) { return talking_fleet_text("acoustics", "{}", vehicles); },
          make_talkers};
}

BenchScene acoustics_rays_scene() {
  return {"acoustics_rays",
          "as acoustics, along rays bent by a thermocline below the fleet",
          {10, 100, 1000},
          [](int vehicles) {
            return talking_fleet_text("acoustics_rays",
                                      "{profile: [{depth_m: 0, temperature_C: 16}, {depth_m: 25, temperature_C: 15.9}, "
                                      "{depth_m: 40, temperature_C: 10}]}",
                                      vehicles);
          },
          make_talkers};
}

}  // namespace verification
