// SPDX-License-Identifier: BSD-3-Clause
#include "experiment/replay/replayed_world.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/devices/world_fixture.hpp"

namespace {

using experiment::line_difference;
using testing::ElementsAre;
using testing::IsEmpty;

TEST(LineDifference, EqualTextsHaveNone) {
  EXPECT_THAT(line_difference("a\nb\n", "a\nb\n"), IsEmpty());
  EXPECT_THAT(line_difference("", ""), IsEmpty());
}

TEST(LineDifference, NamesTheLinesThatAreInOneTextAlone) {
  EXPECT_THAT(line_difference("a\nb\nc\nd\n", "a\nx\nc\nd\ne\n"),
              ElementsAre("-     2  b", "+     2  x", "+     5  e"));
}

TEST(LineDifference, StopsAtTheMost) {
  EXPECT_THAT(line_difference("1\n2\n3\n", "", 2), ElementsAre("-     1  1", "-     2  2", "and 1 more lines"));
}

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
