// SPDX-License-Identifier: BSD-3-Clause
#include "bridges/view/scene_assets.hpp"

#include <gtest/gtest.h>

#include "sim/model/physics_config.hpp"

namespace {

TEST(SceneAssets, ALargeTerrainIsThinnedOut) {
  bridges::SceneAssets assets;
  sim::PartConfig part;
  part.shape = sim::PartShape::terrain;
  part.terrain.emplace();
  part.terrain->source = sim::TerrainConfig::Source::sine;
  std::size_t bytes = 0;
  for (const double size_m : {1000.0, 2000.0}) {  // a million and four million heights
    part.terrain->size_m = {size_m, size_m};
    const std::string hash = assets.add_terrain(part);
    ASSERT_NE(hash, "");
    bytes = assets.all().at(hash).size();
    EXPECT_GT(bytes, 3'900'000u);
    EXPECT_LE(bytes, bridges::SceneAssets::max_bytes);
  }
  EXPECT_LT(bytes, 4u * 2001 * 2001);
}

}  // namespace
