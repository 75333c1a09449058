// SPDX-License-Identifier: BSD-3-Clause
#include <gmock/gmock.h>

#include "shoal/pressure_t.hpp"
#include "tests/devices/navigation/immersed_sensor_fixture.hpp"

namespace {

using shoal::pressure_t;
using test::marine_world;

/// With gravity, which the box follows: 0.5 g t^2 = 0.5 mm in the first step.
std::string with_gravity(std::string yaml) {
  const std::string none = "gravity_mps2: 0";
  return yaml.replace(yaml.find(none), none.size(), "gravity_mps2: 9.80665");
}

TEST(Pressure, DepthIsOffByTheDensityItAssumes) {
  const auto yaml = with_gravity(marine_world("type: pressure, assumed_density_kgpm3: 1000", "[0, 0, -100]", "[]", "",
                                              "{water: {surface_m: 0, density_kgpm3: 1025}}"));
  // The medium may make the water denser with depth: by less than 0.1 % at 100 m.
  EXPECT_NEAR(test::first_truth<pressure_t>(yaml).depth_m, 102.5, 0.1);
}

TEST(Pressure, RefusesAnAssumedDensityOfAir) {
  EXPECT_THAT(test::error_of_world(marine_world("type: pressure, assumed_density_kgpm3: 1.2")),
              testing::HasSubstr("device 's': 'assumed_density_kgpm3' must be >= 500 and <= 2000, got 1.2"));
}

}  // namespace
