// SPDX-License-Identifier: BSD-3-Clause
#include "autonomy/mapping/mean_scan.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace {

using autonomy::MeanScan;
using testing::ElementsAre;
using testing::FloatNear;

shoal::planar_lidar_t scan_of(const std::vector<float>& ranges_m) {
  shoal::planar_lidar_t scan{};
  scan.nranges = static_cast<std::int32_t>(ranges_m.size());
  scan.ranges = ranges_m;
  scan.radstep = 0.1F;
  return scan;
}

/// A float near 20 m is exact to 1e-6 m.
constexpr float rounding_m = 2e-6F;

TEST(MeanScan, HasTheMeanOfEachBeam) {
  MeanScan mean;
  mean.add(scan_of({2.00F, 20}));
  mean.add(scan_of({2.02F, 20}));
  mean.add(scan_of({1.98F, 20}));
  mean.add(scan_of({2.04F, 20}));
  EXPECT_THAT(mean.scan()->ranges, ElementsAre(FloatNear(2.01F, rounding_m), 20));
}

TEST(MeanScan, LeavesOutABeamThatGrazesAnEdge) {
  MeanScan mean;
  mean.add(scan_of({2, 3}));
  mean.add(scan_of({5, 3}));
  EXPECT_THAT(mean.scan()->ranges, ElementsAre(0, 3));
}

TEST(MeanScan, AnOutlierDoesNotCount) {
  MeanScan mean;
  for (int i = 0; i < 10; ++i) mean.add(scan_of({i == 5 ? 7.0F : 2.0F}));
  mean.add(scan_of({2.11F}));
  EXPECT_THAT(mean.scan()->ranges, ElementsAre(FloatNear(2.011F, rounding_m)));
}

TEST(MeanScan, IgnoresAScanWithOtherBeams) {
  MeanScan mean;
  EXPECT_FALSE(mean.scan());
  mean.add(scan_of({2, 3}));
  mean.add(scan_of({2.01F}));
  shoal::planar_lidar_t turned = scan_of({2.01F, 3.01F});
  turned.rad0 = 1;
  mean.add(turned);
  EXPECT_THAT(mean.scan()->ranges, ElementsAre(2, 3));
}

}  // namespace
