// SPDX-License-Identifier: BSD-3-Clause
#include "sim/base/geodesy.hpp"

#include <gmock/gmock.h>

#include <set>

#include "tests/fidelity/gps_points.hpp"

namespace {

using sim::Geodesy;
using sim::GeodeticPosition;

TEST(Geodesy, AgreesWithEveryPointOfTheReferenceBothWays) {
  // The rows have 11 digits of a degree, 1 um, and um of height.  Asked for are 1e-8 degrees and 1 mm.
  std::set<std::string> origins;
  for (const test::GpsPoint& point : test::gps_points()) {
    const auto where = [&] { return testing::Message() << point.origin_name << " " << point.p_W.transpose(); };
    const Geodesy geodesy(point.origin);
    const GeodeticPosition position = geodesy.to_geodetic(point.p_W);
    EXPECT_NEAR(position.latitude_deg, point.position.latitude_deg, 1e-10) << where();
    EXPECT_NEAR(position.longitude_deg, point.position.longitude_deg, 1e-10) << where();
    EXPECT_NEAR(position.height_m, point.position.height_m, 1e-5) << where();
    EXPECT_LT((geodesy.to_local(point.position) - point.p_W).norm(), 1e-5) << where();
    EXPECT_LT((geodesy.to_local(position) - point.p_W).norm(), 1e-8) << where();
    origins.insert(point.origin_name);
  }
  EXPECT_THAT(origins, testing::ElementsAre("charles_river", "dateline", "equator", "sydney", "trondheim"));
}

TEST(Geodesy, KnowsALongitudeByEitherOfItsNames) {
  const Geodesy geodesy({-17, 179.999, 0});
  const GeodeticPosition east = geodesy.to_geodetic({5000, 3000, -20});
  EXPECT_LT(east.longitude_deg, -179);
  EXPECT_LT(
      (geodesy.to_local({east.latitude_deg, east.longitude_deg + 360, east.height_m}) - sim::Vector3d(5000, 3000, -20))
          .norm(),
      1e-7);
}

}  // namespace
