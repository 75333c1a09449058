// SPDX-License-Identifier: BSD-3-Clause
#include "sim/rays/world_scene.hpp"

#include "sim/rays/embree_scene.hpp"
#include "sim/rays/ode_scene.hpp"

namespace sim {

std::unique_ptr<WorldScene> make_world_scene(RayLibrary library, const SceneMoves& moves) {
  switch (library) {
    case RayLibrary::embree:
      return std::make_unique<EmbreeScene>(moves);
    case RayLibrary::ode:
      break;
  }
  return std::make_unique<OdeScene>(moves);
}

}  // namespace sim
