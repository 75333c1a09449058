// SPDX-License-Identifier: BSD-3-Clause
#include "sim/medium/medium.hpp"

#include <gmock/gmock.h>

#include "sim/medium/sea_water.hpp"
#include "sim/medium/water_column.hpp"
#include "sim/world_file/load_world.hpp"
#include "tests/sim/medium/log_capture.hpp"
#include "tests/sim/medium/medium_worlds.hpp"
#include "tests/state_hash_of.hpp"

namespace {

using test_support::make_medium;

TEST(Water, StandsAtTheHeightOfItsSurface) {
  const sim::Medium medium = make_medium("water: {surface_m: -3, density_kgpm3: 1000}");
  EXPECT_EQ(medium.surface_m(1, 2), -3);
  EXPECT_EQ(medium.depth_m({0, 0, -5}), 2);
  EXPECT_FALSE(medium.in_water({0, 0, -2}));
  EXPECT_DOUBLE_EQ(medium.pressure_Pa({0, 0, -5}), 101325 + 2000 * 9.80665);
}

TEST(Water, ADryWorldHasNone) {
  const sim::Medium medium = make_medium("{}");
  EXPECT_FALSE(medium.has_water());
  EXPECT_FALSE(medium.in_water({0, 0, -100}));
  EXPECT_EQ(medium.pressure_Pa({0, 0, -100}), 101325);
  EXPECT_EQ(medium.water_at({0, 0, -1}).density_kgpm3, 0);
  EXPECT_EQ(test::state_hash_of(medium), sim::StateArchive::hasher().hash());
}

}  // namespace
