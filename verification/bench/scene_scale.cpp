// SPDX-License-Identifier: BSD-3-Clause
#include "verification/bench/rover_arena.hpp"

namespace verification {

/// Kept for comparison with figures from before the scene `land` existed.
BenchScene scale_scene() {
  return {"scale",
          "as land, but the lidars stand above the hulls and see no rovers, which push each other; kept for comparison",
          {1, 10, 100, 1000},
          [](int vehicles) {
            return rover_arena_text({"scale", "[0.15, 0, 0.15]"}, vehicles);
          },
          wanderers};
}

}  // namespace verification
