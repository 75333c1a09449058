// SPDX-License-Identifier: BSD-3-Clause
#include "verification/bench/marine_helpers.hpp"

namespace verification {

BenchScene otters_scene() {
  return {"otters",
          "Otter boats by coefficients in a sea of 200 waves",
          {1, 10, 100},
          [](int vehicles) {
            return marine_fleet_text({"otters", 0.02, "file: otter.yaml",
                                      "waves: {type: jonswap, hs_m: 0.5, tp_s: 4, components: 200, spreading: 4}, ", 0},
                                     vehicles);
          },
          [](const sim::World& world, sim::Bus& bus) -> std::unique_ptr<ScenePrograms> {
            return std::make_unique<StartCommands>(world, bus, set_off_otter);
          }};
}

}  // namespace verification
