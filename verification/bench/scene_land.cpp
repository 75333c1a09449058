// SPDX-License-Identifier: BSD-3-Clause
#include "verification/bench/rover_arena.hpp"

namespace verification {

std::string land_scene_text(int robots, bool one_entry_each) {
  // The lidar is at the front of the hull, 0.14 m above the ground, and so sees the hulls of others.
  return rover_arena_text({"land", "[0.24, 0, 0.04]", one_entry_each}, robots);
}

BenchScene land_scene() {
  return {"land",
          "rovers that wander among walls and boxes, with lidars of 180 rays at 10 Hz that see the other rovers",
          {1, 10, 100, 1000},
          [](int vehicles) { return land_scene_text(vehicles); },
          wanderers};
}

}  // namespace verification
