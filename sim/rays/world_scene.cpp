// SPDX-License-Identifier: BSD-3-Clause
#include "sim/rays/world_scene.hpp"

#include <stdexcept>

#include "sim/rays/embree_scene.hpp"
#include "sim/rays/ode_scene.hpp"

namespace sim {

std::unique_ptr<WorldScene> make_world_scene(const std::string& library, const SceneMoves& moves) {
  if (library == "embree") return std::make_unique<EmbreeScene>(moves);
  if (library == "ode") return std::make_unique<OdeScene>(moves);
  throw std::invalid_argument("no library '" + library + "' for rays");
}

}  // namespace sim
