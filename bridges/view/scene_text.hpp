// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

namespace sim {
class World;
}

namespace bridges {

class SceneAssets;

/// Returns the scene of a world as JSON: bodies with their parts, materials, vehicles with their devices, light, water
/// and zones at their present poses; docs/develop/view_protocol.md has its keys.  Adds to `assets` what the scene
/// names.
std::string scene_text(const sim::World& world, int revision, SceneAssets& assets);

}  // namespace bridges
