// SPDX-License-Identifier: BSD-3-Clause
#include <gmock/gmock.h>

#include "shoal/dvl_t.hpp"
#include "tests/devices/navigation/immersed_sensor_fixture.hpp"

namespace {

using shoal::dvl_t;
using test::bottom_at;
using test::marine_world;

TEST(Dvl, APresetIsAUnitByItsDataSheet) {
  test::TestWorld test(marine_world("type: dvl, preset: workhorse_600, scale_std: 0, velocity_noise: {bias_std: 0}",
                                    "[0, 0, -10]", bottom_at(-30)));
  test::set_velocity(test, {1, 0, 0});
  test::Listener<dvl_t> reports(test, "r1.s");
  test.run_for(20);
  std::vector<double> errors;
  for (const auto& report : reports.take_all()) errors.push_back(report.velocity_mps[0] - 1);
  // 3 mm/s at 1 m/s.
  EXPECT_NEAR(test::statistics(errors).std, 0.003, 4 * 0.003 / std::sqrt(4000) + 1e-5);
}

}  // namespace
