// SPDX-License-Identifier: BSD-3-Clause
#include <gmock/gmock.h>

#include "tests/devices/world_fixture.hpp"
#include "tests/sim/director/event_worlds.hpp"

namespace {

using namespace event_worlds;

TEST(Events, ChooseAtRandomByTheirOwnNameWhateverElseHappens) {
  const std::string a =
      "  - {name: a, every: 0.1, do: [{move: {name: ball, places: [[1, 0, 5], [2, 0, 5], [3, 0, 5]], random_yaw: "
      "true}}]}\n";
  const auto places = [&](const std::string& others) {
    test::TestWorld test(event_world(a + others));
    std::vector<double> xs;
    for (int i = 0; i < 30; ++i) {
      test.run_for(0.1);
      xs.push_back(test.world.find_object("ball")->base().X_WB().translation().x());
    }
    return xs;
  };
  const auto alone = places("");
  EXPECT_EQ(alone, places("  - {name: b, every: 0.01, do: [{log: b}], probability: 0.5}\n"));
  EXPECT_THAT(alone, testing::Contains(1));
  EXPECT_THAT(alone, testing::Contains(2));
  EXPECT_THAT(alone, testing::Contains(3));
}

}  // namespace
