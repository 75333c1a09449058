// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include "experiment/run/run_parts.hpp"
#include "sim/world_file/load_world.hpp"

namespace test {

/// Parts of a run without a network: a crate that falls from a height of 100 m, in steps of 0.01 s.
class PartsOfARun {
 public:
  explicit PartsOfARun(const experiment::RunParts::Options& options = {}, const std::string& more = "")
      : loaded(sim::load_world_text("shoal: 1\nname: well\nphysics: {step_s: 0.01}\nobjects:\n"
                                    "  - {name: crate, position_m: [0, 0, 100], parts: [{shape: box, mass_kg: 5}]}\n" +
                                        more,
                                    "well.yaml", {})),
        parts(loaded, run(), options) {}

  static experiment::RunOptions run() {
    experiment::RunOptions options;
    options.bus = "none";
    options.serial_ports = false;
    return options;
  }
  void step(std::int64_t count) {
    for (std::int64_t i = 0; i < count; ++i) parts.world.step();
  }

  sim::LoadedWorld loaded;
  experiment::RunParts parts;
};

}  // namespace test
