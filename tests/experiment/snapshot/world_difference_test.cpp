// SPDX-License-Identifier: BSD-3-Clause
#include "experiment/snapshot/world_difference.hpp"

#include <gmock/gmock.h>

#include "tests/devices/world_fixture.hpp"

namespace {

using testing::ElementsAre;
using testing::IsEmpty;

TEST(WorldDifference, NamesWhatOnlyTheFirstWorldHas) {
  const test::TestWorld one(test::box_world("        - {name: imu, type: imu}\n        - {name: gps, type: gps}\n",
                                            "{step_s: 0.01}",
                                            "objects: [{name: crate, parts: [{shape: box, mass_kg: 1}]}]\n"
                                            "events: [{name: storm, at: 1, do: [{log: x}]}]\n"));
  const test::TestWorld other(test::box_world("        - {name: imu, type: imu}\n"));
  EXPECT_THAT(experiment::entities_only_in(one.loaded.config, other.loaded.config),
              ElementsAre("object 'crate'", "device 'r1/gps'", "event 'storm'"));
  EXPECT_THAT(experiment::entities_only_in(other.loaded.config, one.loaded.config), IsEmpty());
}

}  // namespace
