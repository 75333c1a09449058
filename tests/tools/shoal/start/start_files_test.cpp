// SPDX-License-Identifier: BSD-3-Clause
#include "tools/shoal/start/start_files.hpp"

#include <gmock/gmock.h>

#include <fstream>

#include "tests/devices/world_fixture.hpp"
#include "tests/scratch_folder.hpp"

namespace {

TEST(StartFiles, AreWorldsAndVehiclesWithoutMistakes) {
  for (const bool under_water : {false, true}) {
    const test_support::ScratchFolder folder;
    std::ofstream(folder.file("mine.yaml")) << tools::start_vehicle("mine", under_water, "");
    const std::string text =
        under_water ? tools::start_sea("trip", "mine.yaml", "") : tools::start_world("trip", "mine.yaml", "");
    std::ofstream(folder.file("trip.yaml")) << text;
    test::LoadedTestWorld test(folder.file("trip.yaml"));
    EXPECT_EQ(test.loaded.config.name, "trip");
    test.run_for(0.1);
    EXPECT_EQ(test.world.vehicles().size(), 1u);
  }
}

TEST(StartFiles, NameTheSchemaForEditors) {
  EXPECT_THAT(tools::start_vehicle("mine", false, "schema/vehicle.schema.json"),
              testing::HasSubstr("schema/vehicle.schema.json"));
  EXPECT_THAT(tools::start_vehicle("mine", false, ""), testing::Not(testing::HasSubstr("schema")));
}

}  // namespace
