// SPDX-License-Identifier: BSD-3-Clause
#include "verification/bench/marine_helpers.hpp"

namespace verification {

BenchScene naive_scene() {
  return {"naive",
          "kinematic AUVs without a hull, with depth and heading at 1 Hz",
          {1, 100, 1000, 10000},
          [](int vehicles) {
            return marine_fleet_text(
                {"naive", 0.02,
                 "model: {shoal: 1, vehicle: naive, bodies: [{name: hull, kinematic: true, parts: []}], "
                 "devices: [{name: drive, type: naive_drive, start_speed_mps: 1.5}, "
                 "{name: depth, type: pressure, rate_hz: 1}, {name: heading, type: compass, rate_hz: 1}]}"},
                vehicles);
          },
          nullptr};
}

}  // namespace verification
