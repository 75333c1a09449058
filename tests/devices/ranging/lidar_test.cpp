// SPDX-License-Identifier: BSD-3-Clause
#include "devices/ranging/lidar.hpp"

#include <gmock/gmock.h>

#include "shoal/planar_lidar_t.hpp"
#include "tests/devices/ranging/lidar_fixture.hpp"
#include "tests/devices/world_fixture.hpp"

namespace {

using namespace lidar_fixture;

TEST(Lidar, SeesAWallAsGeometrySays) {
  test::TestWorld test(test::rover_world(lidar(), wall));
  test::Listener<shoal::planar_lidar_t> scans(test, "r1.lidar");
  test.run_for(0.5);
  const auto scan = scans.last();
  ASSERT_EQ(scan.nranges, 181);
  EXPECT_FLOAT_EQ(scan.rad0, static_cast<float>(-std::numbers::pi / 2));
  EXPECT_FLOAT_EQ(scan.radstep, static_cast<float>(std::numbers::pi / 180));
  // Reference closed_forms.csv, lidar_plane_wall.  5 mm: the rover settles on its wheels by less than that.
  EXPECT_NEAR(scan.ranges[90], 5.0, 0.005);
  EXPECT_NEAR(scan.ranges[120], 5.773502692, 0.005);
  EXPECT_NEAR(scan.ranges[45], 7.071067812, 0.005);
}

TEST(Lidar, ReportsItsLargestRangeWhereItHitsNothing) {
  test::TestWorld test(test::rover_world(lidar(), wall));
  test::Listener<shoal::planar_lidar_t> scans(test, "r1.lidar");
  test.run_for(0.5);
  EXPECT_EQ(scans.last().ranges[0], 10.0f);  // along the wall
}

TEST(Lidar, NoiseHasTheMeanAndVarianceAskedFor) {
  test::TestWorld test(test::rover_world(lidar(", noise: {gaussian_std: 0.02, bias: 0.1}"), wall));
  test::Listener<shoal::planar_lidar_t> scans(test, "r1.lidar");
  test::Listener<shoal::planar_lidar_t> truths(test, "r1.lidar.truth");
  test.run_for(20);
  const auto measured = scans.take_all();
  const auto true_scans = truths.take_all();
  ASSERT_EQ(measured.size(), true_scans.size());
  double sum = 0, squares = 0, count = 0;
  for (std::size_t i = 0; i < measured.size(); ++i)
    for (std::size_t beam = 60; beam < 120; ++beam) {
      const double error =
          static_cast<double>(measured[i].ranges[beam]) - static_cast<double>(true_scans[i].ranges[beam]);
      sum += error;
      squares += error * error;
      ++count;
    }
  const double mean = sum / count;
  ASSERT_EQ(count, 12000);
  EXPECT_NEAR(mean, 0.1, 4 * 0.02 / std::sqrt(count));
  EXPECT_NEAR(std::sqrt(squares / count - mean * mean), 0.02, 4 * 0.02 / std::sqrt(2 * count));
}

TEST(Lidar, RoundsRangesToItsResolution) {
  test::TestWorld test(test::rover_world(lidar(", resolution_m: 0.25"), wall));
  test::Listener<shoal::planar_lidar_t> scans(test, "r1.lidar");
  test.run_for(0.5);
  EXPECT_EQ(scans.last().ranges[120], 5.75f);
}

TEST(Lidar, NamesEveryBadKeyAtOnce) {
  try {
    test::TestWorld test(test::rover_world(lidar(", beems: 3, fov_deg: 400, see_through: [ice]")));
    FAIL();
  } catch (const sim::ConfigError& error) {
    EXPECT_THAT(error.what(), testing::HasSubstr("device 'lidar': unknown key 'beems'"));
    EXPECT_THAT(error.what(), testing::HasSubstr("'fov_deg' must be >= 0 and <= 360, got 400"));
    EXPECT_THAT(error.what(), testing::HasSubstr("names no category 'ice'; known categories: solid"));
  }
}

TEST(Lidar, CastsAtMostAMillionRaysInAScan) {
  const std::string error = test::error_of_world(test::rover_world(
      "        - {name: lidar, type: lidar, beams: 100000, beam_divergence_deg: 1, beam_samples: 100}\n"));
  EXPECT_THAT(error, testing::HasSubstr("'beams' x 'beam_samples' must be at most 1000000 rays in a sample, got 100000 "
                                        "x 100 = 10000000"));
}

}  // namespace
