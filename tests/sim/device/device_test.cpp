// SPDX-License-Identifier: BSD-3-Clause
#include "sim/device/device.hpp"

#include <gtest/gtest.h>

#include <numbers>

#include "sim/clock/vehicle_clock.hpp"
#include "tests/devices/world_fixture.hpp"

namespace {

/// A publisher that only stamps.
class Stamps : public sim::Publisher {
 public:
  Stamps(std::int64_t epoch_us, const sim::VehicleClock* clock) : Publisher(epoch_us, clock) {}
  void publish(std::span<const std::byte>) override {}
};

TEST(Publisher, ATruthChannelHasTrueTime) {
  const Stamps stamps(1'000'000, nullptr);
  EXPECT_TRUE(stamps.is_truth());
  EXPECT_EQ(stamps.utime(sim::Time(5)), 1'000'005);
  EXPECT_EQ(stamps.true_utime(sim::Time(5)), 1'000'005);
  EXPECT_EQ(stamps.utime_elsewhere(sim::Time(5), sim::Time(9)), 1'000'005);
}

TEST(Publisher, OtherChannelsHaveTheTimeOfTheClock) {
  test::TestWorld test(
      "shoal: 1\nvehicles: [{name: a, model: {shoal: 1, clock: {offset_s: 0.5}, bodies: [{name: b, parts: [{shape: "
      "box, "
      "mass_kg: 1}]}]}}]\n");
  const Stamps stamps(1'000'000, &test.world.find_vehicle("a")->clock());
  EXPECT_FALSE(stamps.is_truth());
  EXPECT_EQ(stamps.utime(sim::Time(0)), 1'500'000);
  EXPECT_EQ(stamps.true_utime(sim::Time(0)), 1'000'000);
  EXPECT_EQ(stamps.utime_elsewhere(sim::Time(5), sim::Time(9)), 1'000'009);
}

TEST(SweepContext, PosesInAStepAreBetweenThoseOfItsEnds) {
  test::TestWorld test(test::box_world(""));
  const sim::Pose from = sim::make_pose({0, 0, 0}, {0, 0, 0}),
                  to = sim::make_pose({4, 0, 2}, {0, 0, std::numbers::pi / 2});
  const sim::SweepContext sweep{
      test.world, *test.world.find_vehicle("r1"), sim::Time(1000), sim::Time(2000), from, to, sim::Time(2000)};
  EXPECT_TRUE(sweep.X_WS_at(sim::Time(1000)).isApprox(from));
  // A quarter of the way has a quarter of the turn.
  const sim::Pose quarter = sweep.X_WS_at(sim::Time(1250));
  EXPECT_TRUE(quarter.isApprox(sim::make_pose({1, 0, 0.5}, {0, 0, std::numbers::pi / 8}), 1e-12));
  EXPECT_TRUE(sweep.X_WS_at(sim::Time(2000)).isApprox(to));
  EXPECT_TRUE(sweep.X_WS_at(sim::Time(3000)).isApprox(to));
}

}  // namespace
