// SPDX-License-Identifier: BSD-3-Clause
#include "devices/ranging/ray_casting.hpp"

#include <gmock/gmock.h>

#include <cmath>
#include <numbers>

#include "shoal/planar_lidar_t.hpp"
#include "tests/devices/ranging/lidar_fixture.hpp"
#include "tests/devices/world_fixture.hpp"
#include "tests/sim/config/read_yaml.hpp"

namespace {

TEST(BeamPattern, OfOneRayOrNoAngleIsItsAxis) {
  EXPECT_THAT(devices::cone_pattern(0.3, 1), testing::ElementsAre(sim::Vector3d(1, 0, 0)));
  EXPECT_THAT(devices::cone_pattern(0, 100), testing::ElementsAre(sim::Vector3d(1, 0, 0)));
}

TEST(BeamPattern, RaysShareTheConeInEqualSolidAngles) {
  const double half_angle_rad = 0.3;
  const auto rays = devices::cone_pattern(half_angle_rad, 1000);
  ASSERT_EQ(rays.size(), 1000u);
  int inner = 0;
  sim::Vector3d sum = sim::Vector3d::Zero();
  // The inner cone with half of the solid angle.
  const double middle_cosine = (1 + std::cos(half_angle_rad)) / 2;
  for (const sim::Vector3d& ray : rays) {
    EXPECT_NEAR(ray.norm(), 1, 1e-12);
    EXPECT_GE(ray.x(), std::cos(half_angle_rad));
    inner += ray.x() > middle_cosine;
    sum += ray;
  }
  EXPECT_EQ(inner, 500);
  EXPECT_NEAR(sum.y() / 1000, 0, 1e-3);  // around the axis
  EXPECT_NEAR(sum.z() / 1000, 0, 1e-3);
}

TEST(BeamPattern, AHalfSpaceIsTwoPi) {
  EXPECT_NEAR(devices::cone_solid_angle_sr(std::numbers::pi / 2), 2 * std::numbers::pi, 1e-12);
  EXPECT_NEAR(devices::cone_solid_angle_sr(std::numbers::pi), 4 * std::numbers::pi, 1e-12);
  EXPECT_EQ(devices::cone_solid_angle_sr(0), 0);
}

using namespace lidar_fixture;

TEST(Lidar, DoesNotSeeItsOwnVehicleUnlessAsked) {
  const auto ahead = [](const char* more) {
    // Inside the hull's height, from behind its front face.
    test::TestWorld test(test::rover_world(
        "        - {name: lidar, type: lidar, position_m: [-0.5, 0, 0.03], beams: 1" + std::string(more) + "}\n"));
    test::Listener<shoal::planar_lidar_t> scans(test, "r1.lidar");
    test.run_for(0.5);
    return scans.last().ranges[0];
  };
  EXPECT_EQ(ahead(""), 30.0f);
  EXPECT_NEAR(ahead(", sees_own_vehicle: true"), 0.3, 1e-3);  // the hull's rear face at x = -0.2
}

TEST(Lidar, LooksThroughTheCategoriesItIsCommandedTo) {
  const std::string glass =
      "  - {name: pane, fixed: true, position_m: [2, 0, 1], parts: [{shape: box, size_m: [0.02, 4, 2], category: "
      "glass}]}\n";
  const auto ahead = [&](const char* more) {
    test::TestWorld test(test::rover_world(lidar(more), glass + wall) + "\ncategories: [glass]\n");
    test::Listener<shoal::planar_lidar_t> scans(test, "r1.lidar");
    test.run_for(0.5);
    return scans.last().ranges[90];
  };
  EXPECT_NEAR(ahead(""), 1.99, 0.005);
  EXPECT_NEAR(ahead(", see_through: [glass]"), 5.0, 0.005);
}

using testing::ElementsAre;
using testing::HasSubstr;

std::vector<std::string> errors_of(const std::string& yaml, double beams, double rays) {
  return test::errors_of_reading(yaml, [&](sim::ParamReader& in) {
    int ignored = 0;
    in.read("beams", ignored, sim::at_least(0), "");
    in.read("rays", ignored, sim::at_least(0), "");
    const devices::RayFactor factors[] = {{"beams", beams}, {"rays", rays}};
    devices::check_rays(in, factors);
  });
}

TEST(ParamChecks, ASampleHasAMillionRaysAtMost) {
  EXPECT_THAT(errors_of("{beams: 1000, rays: 1000}", 1000, 1000), testing::IsEmpty());
  EXPECT_THAT(
      errors_of("{beams: 1001, rays: 1000}", 1001, 1000),
      ElementsAre(HasSubstr("w.yaml:1:21: 'beams' x 'rays' must be at most 1000000 rays in a sample, got 1001 x "
                            "1000 = 1001000")));
}

TEST(ParamChecks, TheErrorIsAtTheLastKeyThatIsGiven) {
  EXPECT_THAT(errors_of("{beams: 2000}", 2000, 1000), ElementsAre(HasSubstr("w.yaml:1:9: ")));
}

TEST(ParamChecks, TheRateOfADeviceIsThatOfItsMap) {
  const auto rate = [](const std::string& yaml) {
    double rate_hz = 0;
    test::errors_of_reading(yaml, [&](sim::ParamReader& in) { rate_hz = devices::rate_hz_of(in, 10); });
    return rate_hz;
  };
  EXPECT_EQ(rate("{rate_hz: 4}"), 4);
  EXPECT_EQ(rate("{}"), 10);
  EXPECT_EQ(rate("{rate_hz: every_step}"), 0);
  EXPECT_EQ(rate("{rate_hz: -1}"), 10);  // an error that is reported elsewhere
}

}  // namespace
