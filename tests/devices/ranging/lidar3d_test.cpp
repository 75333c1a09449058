// SPDX-License-Identifier: BSD-3-Clause
#include "devices/ranging/lidar3d.hpp"

#include <gmock/gmock.h>

#include "shoal/point_cloud_t.hpp"
#include "tests/devices/ranging/ranging_fixture.hpp"

namespace {

using shoal::point_cloud_t;
using test::ranging_world;
using test::wall_at;

/// 10 turns a second.  The last `rate_hz` counts: a key may stand once, so the fixture's goes.
std::string lidar_world(const std::string& more, const std::string& objects) {
  std::string yaml = ranging_world("type: lidar3d, range_max_m: 100, " + more, objects);
  return yaml.replace(yaml.find("rate_hz: 100"), 12, "rate_hz: 10");
}

TEST(Lidar3d, AWallIsAPlane) {
  test::TestWorld test(lidar_world("rings: 3, lowest_deg: -10, highest_deg: 10, columns: 360", wall_at(5)));
  test::Listener<point_cloud_t> clouds(test, "r1.s.truth");
  test.run_for(0.2);
  const auto cloud = clouds.last();
  // Columns within 87 deg of +x meet the wall within 100 m: 5 / cos(87 deg) = 95.5, and 97.0 for the outer rings.
  EXPECT_EQ(cloud.count, 3 * (2 * 87 + 1));
  for (int i = 0; i < cloud.count; ++i) {
    EXPECT_NEAR(cloud.x_m[i], 5, 1e-6);  // float
    const double level_m = std::hypot(cloud.x_m[i], cloud.y_m[i]);
    EXPECT_NEAR(std::atan2(cloud.z_m[i], level_m), sim::degrees_to_radians(10 * (cloud.rings[i] - 1)), 1e-6);
  }
}

TEST(Lidar3d, WhatIsTooNearIsNoPoint) {
  // The wall is beyond 3 m along beams of more than acos(2/3) = 48.2 deg; only these have points.
  test::TestWorld test(
      lidar_world("rings: 1, lowest_deg: 0, highest_deg: 0, columns: 360, range_min_m: 3", wall_at(2)));
  test::Listener<point_cloud_t> clouds(test, "r1.s"), truths(test, "r1.s.truth");
  test.run_for(0.2);
  for (const auto& cloud : {clouds.last(), truths.last()}) {
    EXPECT_EQ(cloud.count, 2 * (88 - 48));  // 49 to 88 deg on both sides: 2 m / cos(88 deg) = 57 m
    for (int i = 0; i < cloud.count; ++i) EXPECT_NEAR(cloud.x_m[i], 2, 1e-5);  // float at 57 m
  }
}

TEST(Lidar3d, NoiseThatLeavesTheLimitsMakesNoPointAtThem) {
  // Ahead a wall is 1 mm beyond the least range: with 50 mm of noise it is nearer in 49.2 % of the turns.
  test::TestWorld test(
      lidar_world("ring_angles_deg: [0], columns: 2, range_min_m: 5, range_std_m: 0.05", wall_at(5.001)));
  test::Listener<point_cloud_t> clouds(test, "r1.s"), truths(test, "r1.s.truth");
  test.run_for(100);
  EXPECT_EQ(truths.last().count, 1);
  double points = 0;
  const auto all = clouds.take_all();
  for (const auto& cloud : all) {
    points += cloud.count;
    for (const float x_m : cloud.x_m) EXPECT_GE(x_m, 5 - 1e-6);  // a float has 7 digits
  }
  const auto turns = static_cast<double>(all.size());
  EXPECT_NEAR(points / turns, 0.508, 4 * 0.5 / std::sqrt(turns));  // four standard deviations
}

TEST(Lidar3d, ColumnsAreMeasuredOneAfterTheOther) {
  test::TestWorld test(lidar_world("rings: 1, lowest_deg: 0, highest_deg: 0, columns: 100", wall_at(5)));
  test::Listener<point_cloud_t> clouds(test, "r1.s");
  test.run_for(0.2);
  const auto cloud = clouds.last();
  ASSERT_GT(cloud.count, 40);
  for (int i = 0; i < cloud.count; ++i) {
    const double azimuth = std::atan2(cloud.y_m[i], cloud.x_m[i]);
    const double column = (azimuth + std::numbers::pi) / (2 * std::numbers::pi) * 100;
    EXPECT_NEAR(cloud.time_offsets_us[i], -1000 * (99 - std::round(column)), 1);
  }
}

TEST(Lidar3d, AWallIsSkewedByATurningBodyAsTheClosedFormSays) {
  test::TestWorld test(lidar_world("rings: 1, lowest_deg: 0, highest_deg: 0, columns: 720", wall_at(5)));
  test::Listener<point_cloud_t> clouds(test, "r1.s.truth");
  sim::Body& hull = test.world.find_vehicle("r1")->body("hull");
  hull.set_velocity_W(sim::Vector3d::Zero(), {0, 0, 1});
  test.run_for(0.5);
  // The integrator turns a little less than 1 rad/s, evenly.
  const double rate_radps = sim::yaw_of(hull.X_WB().linear()) / 0.5;
  EXPECT_NEAR(rate_radps, 1, 1e-4);
  const auto cloud = clouds.last();
  ASSERT_GT(cloud.count, 300);
  double max_skew_m = 0;
  for (int i = 0; i < cloud.count; ++i) {
    const double yaw = rate_radps * (0.5 + cloud.time_offsets_us[i] * 1e-6);
    const double azimuth = std::atan2(cloud.y_m[i], cloud.x_m[i]);
    const double range_m = 5 / std::cos(azimuth + yaw);
    // A float has 7 digits; the error of the angle grows with the range.
    EXPECT_NEAR(std::hypot(cloud.x_m[i], cloud.y_m[i]), range_m, 2e-6 * range_m * range_m);
    // Seen from the frame at the end of the turn without regard to time, the wall would be off.
    if (range_m < 10)
      max_skew_m = std::max(max_skew_m, std::abs(cloud.x_m[i] * std::cos(0.5) - cloud.y_m[i] * std::sin(0.5) - 5));
  }
  EXPECT_GT(max_skew_m, 0.3);
}

TEST(Lidar3d, DarkSurfacesDropOut) {
  std::string yaml = lidar_world("rings: 1, columns: 360, range_at_10_percent_m: 10", wall_at(5, "dark"));
  yaml.replace(yaml.find("nothing_special"), 15, "dark, laser: {reflectivity: 0.02}");
  test::TestWorld test(yaml);
  test::Listener<point_cloud_t> clouds(test, "r1.s");
  test.run_for(0.2);
  EXPECT_EQ(clouds.last().count, 0);  // 10 m sqrt(0.2) = 4.5 m
}

TEST(Lidar3d, NoiseIsAlongTheBeam) {
  test::TestWorld test(lidar_world("ring_angles_deg: [0], columns: 360, range_std_m: 0.05", wall_at(5)));
  test::Listener<point_cloud_t> clouds(test, "r1.s"), truths(test, "r1.s.truth");
  test.run_for(5);
  std::vector<double> errors;
  const auto noisy = clouds.take_all(), truth = truths.take_all();
  for (std::size_t k = 1; k < truth.size(); ++k)
    for (int i = 0; i < truth[k].count; ++i)
      errors.push_back(std::hypot(noisy[k].x_m[i], noisy[k].y_m[i]) - std::hypot(truth[k].x_m[i], truth[k].y_m[i]));
  const auto [mean, std, count] = test::statistics(errors);
  ASSERT_GT(count, 5000);
  EXPECT_NEAR(mean, 0, 4 * 0.05 / std::sqrt(count));
  EXPECT_NEAR(std, 0.05, 4 * 0.05 / std::sqrt(2 * count));
}

TEST(Lidar3d, ChangesItsRateWhileItRuns) {
  test::TestWorld test(lidar_world("rings: 1, lowest_deg: 0, highest_deg: 0, columns: 360", wall_at(5)));
  test::Listener<point_cloud_t> clouds(test, "r1.s");
  test.run_for(0.25);
  EXPECT_EQ(test.change("r1/s", "{rate_hz: 20}"), "");
  test.run_for(0.5);
  const auto all = clouds.take_all();
  EXPECT_EQ(all.back().count, 2 * 87 + 1);
  EXPECT_GE(all.back().time_offsets_us.front(), -50000);
}

TEST(Lidar3d, ATurnHasNoPointsFromBeforeAMove) {
  test::TestWorld test(lidar_world("rings: 1, lowest_deg: 0, highest_deg: 0, columns: 100", wall_at(5)));
  test::Listener<point_cloud_t> clouds(test, "r1.s");
  test.run_for(0.15);  // half of the second turn
  test.world.editor().move_vehicle("r1", sim::make_pose({2, 0, 0}, sim::Vector3d::Zero()));
  test.run_for(0.05);
  const auto cloud = clouds.last();
  EXPECT_GT(cloud.count, 20);
  for (int i = 0; i < cloud.count; ++i) {
    EXPECT_NEAR(cloud.x_m[i], 3, 1e-5);
    EXPECT_GT(cloud.time_offsets_us[i], -50000);
  }
}

TEST(Lidar3d, SaysWhatIsWrongWithItsParameters) {
  EXPECT_THAT(test::error_of_world(lidar_world("lowest_deg: 5, highest_deg: -5", wall_at(5))),
              testing::HasSubstr("'lowest_deg' must be <= highest_deg"));
  EXPECT_THAT(
      test::error_of_world(lidar_world("rings: 1000, columns: 100000", wall_at(5))),
      testing::HasSubstr(
          "'rings' x 'columns' x 'beam_samples' must be at most 1000000 rays in a sample, got 1000 x 100000 x 1 "
          "= 100000000"));
  std::string angles = "0";
  for (int i = 0; i < 1000; ++i) angles += ", 0";
  EXPECT_THAT(test::error_of_world(lidar_world("ring_angles_deg: [" + angles + "]", wall_at(5))),
              testing::HasSubstr("'ring_angles_deg' must have at most 1000 angles, got 1001"));
}

TEST(Lidar3d, TurnsAtLeastOnceInAThousandSeconds) {
  test::TestWorld test(lidar_world("", wall_at(5)));
  EXPECT_EQ(test.change("r1/s", "{rate_hz: 0.001}"), "");
  EXPECT_THAT(test.change("r1/s", "{rate_hz: 0.0009}"),
              testing::HasSubstr("'rate_hz' of a head that turns must be >= 0.001, or 'every_step', got 0.0009"));
}

}  // namespace
