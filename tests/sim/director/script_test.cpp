// SPDX-License-Identifier: BSD-3-Clause
#include "sim/director/script.hpp"

#include <gmock/gmock.h>

#include "sim/world/world_editor.hpp"
#include "tests/devices/world_fixture.hpp"
#include "tests/sim/director/event_worlds.hpp"

namespace {

using namespace event_worlds;

using testing::ElementsAre;

TEST(Events, FireInTheFirstStepThatStartsAtTheirTimeOrLater) {
  test::TestWorld test(event_world("  - {name: a, at: [0, 0.1, 0.305], " + tick));
  EXPECT_THAT(ticks(test, 1), ElementsAre(0, 10, 31));
}

TEST(Events, FireEverySoOftenWithinTheirTime) {
  test::TestWorld test(event_world("  - {name: a, every: 0.2, from_s: 0.1, until_s: 0.7, " + tick));
  EXPECT_THAT(ticks(test, 2), ElementsAre(10, 30, 50, 70));
  test::TestWorld plain(event_world("  - {name: a, every: 0.2, times: 3, " + tick));
  EXPECT_THAT(ticks(plain, 2), ElementsAre(20, 40, 60));
}

TEST(Events, ComeLaterByTheirDelay) {
  test::TestWorld test(event_world("  - {name: a, at: 0.1, delay_s: 0.25, " + tick));
  EXPECT_THAT(ticks(test, 1), ElementsAre(35));
}

TEST(Events, WithJitterAreTheSameForTheSameSeedOnly) {
  const auto steps = [](int seed) {
    test::TestWorld test(event_world("  - {name: a, every: 1, jitter_s: 0.5, " + tick) +
                         "run: {seed: " + std::to_string(seed) + "}\n");
    return ticks(test, 20);
  };
  const auto first = steps(1);
  EXPECT_EQ(first, steps(1));
  EXPECT_NE(first, steps(2));
  for (std::size_t i = 0; i < first.size(); ++i) {
    EXPECT_GE(first[i], static_cast<std::int64_t>(100 * (i + 1)));
    EXPECT_LE(first[i], static_cast<std::int64_t>(100 * (i + 1) + 50));
  }
}

TEST(Events, OfAProbabilityFireAboutSoOften) {
  test::TestWorld test(event_world("  - {name: a, every: 0.01, probability: 0.3, " + tick));
  // 1000 chances of 0.3: 300 with a standard deviation of 14.5; four of them.
  EXPECT_NEAR(static_cast<double>(ticks(test, 10.005).size()), 300, 58);
}

TEST(World, WithEverythingOnHasTheSameHashesTwice) {
  const std::string text =
      test::rover_world(
          drive + "        - {name: gps, type: gps, rate_hz: 10}\n",
          "  - {name: cart, parts: [{shape: box, size_m: [1, 1, 1]}]}\n"
          "  - {name: crate, present: false, position_m: [0, 4, 1], parts: [{shape: box, mass_kg: 1}]}\n") +
      R"(
zones:
  - {name: slow, shape: cylinder, position_m: [1, 0, 0], radius_m: 1, height_m: 3, speed_limit_mps: 0.2, gps_denied: true}
actors:
  - {name: ride, object: cart, path: spline, points: [[0, 3, 0.6], [4, 3, 0.6], [4, 6, 0.6]], speed_mps: 2}
events:
)" + go +
      R"(
  - {name: come, every: 0.5, jitter_s: 0.2, probability: 0.6, do: [{add: {object: crate, area_m: [1, 1, 0], random_yaw: true}}]}
  - {name: pass, every: 0.7, delay_s: 0.1, do: [{remove: crate}]}
  - {name: hit, when: cart touches any, do: [{log: hit}]}
  - {name: fail, when: r1 enters slow, do: [{one_of: [[{fault: {device: r1/gps, kind: silent}}], [{fault: {device: r1/gps, kind: stuck}}]]}]}
run: {seed: 5}
)";
  const auto hashes = [&] {
    test::TestWorld test(text);
    std::vector<std::uint64_t> all;
    for (int i = 0; i < 4000; ++i) {
      test.world.step();
      all.push_back(test.world.state().hash());
    }
    return all;
  };
  EXPECT_EQ(hashes(), hashes());
}

}  // namespace
