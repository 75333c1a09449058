// SPDX-License-Identifier: BSD-3-Clause
#include "verification/bench/marine_helpers.hpp"

namespace verification {

BenchScene nav_scene() {
  return {"nav",
          "REMUS 100 that localize themselves: autopilot, DVL, AHRS, pressure, GPS, silent modem, drifting clock",
          {1, 10, 100, 1000},
          [](int vehicles) {
            return marine_fleet_text(
                {"nav", 0.01, "file: remus100_nav.yaml", "", 20, 20,
                 "objects: [{name: bottom, fixed: true, position_m: [0, 0, -60], parts: [{shape: plane}]}]\n"},
                vehicles);
          },
          [](const sim::World& world, sim::Bus& bus) -> std::unique_ptr<ScenePrograms> {
            return std::make_unique<StartCommands>(world, bus, set_off_autopilot);
          }};
}

}  // namespace verification
