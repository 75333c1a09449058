// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "sim/medium/current.hpp"
#include "sim/medium/medium_config.hpp"

namespace sim {
class World;
}

namespace bridges {

class SceneAssets;

/// Returns the scene of a world as JSON: bodies with their parts, materials, vehicles with their devices, light, water
/// and zones at their present poses; docs/develop/view_protocol.md has its keys.  Adds to `assets` what the scene
/// names.
std::string scene_text(const sim::World& world, int revision, SceneAssets& assets);

/// Writes tides for a scene, so that a viewer can compute height and current at any time.
nlohmann::ordered_json tides_json(const std::vector<sim::TideConfig>& tides);

/// Writes the entries of a current for a scene, so that a viewer can compute it at any place: all of it except the
/// random parts, whose means are written.  A grid has at most 64 x 64 points.
nlohmann::ordered_json currents_json(const std::vector<sim::CurrentConfig>& entries, const sim::Current& current);

}  // namespace bridges
