// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include "sim/bus/in_process_bus.hpp"
#include "sim/camera/renderer.hpp"
#include "sim/camera/water_view.hpp"
#include "sim/world/world.hpp"
#include "sim/world_file/load_world.hpp"

namespace water_view_fixture {

/// A world with waves of 1 m, or flat water, over a bottom at a depth of 5 m.
struct Sea {
  explicit Sea(bool waves)
      : loaded(sim::load_world_text(std::string("shoal: 1\nname: sea\nmedium:\n  water: {}\n") +
                                        (waves ? "  waves: {type: jonswap, hs_m: 1, tp_s: 5}\n" : "") +
                                        "objects: [{name: bottom, fixed: true, position_m: [0, 0, -5], parts: [{shape: "
                                        "plane}]}]\n",
                                    "sea.yaml", {})),
        world(loaded.config, bus) {}

  sim::LoadedWorld loaded;
  sim::InProcessBus bus;
  sim::World world;
};

}  // namespace water_view_fixture
