// SPDX-License-Identifier: BSD-3-Clause
#include "verification/bench/marine_helpers.hpp"

namespace verification {

BenchScene sea_scene() {
  return {"sea",
          "REMUS 100 by coefficients under water, with propeller, fins, and depth and heading at 1 Hz",
          {1, 100, 1000, 10000},
          [](int vehicles) {
            return marine_fleet_text({"sea", 0.02, "file: remus100_fleet.yaml"}, vehicles);
          },
          [](const sim::World& world, sim::Bus& bus) -> std::unique_ptr<ScenePrograms> {
            return std::make_unique<StartCommands>(world, bus, set_off_remus);
          }};
}

}  // namespace verification
