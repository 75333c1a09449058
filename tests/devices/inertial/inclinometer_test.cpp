// SPDX-License-Identifier: BSD-3-Clause
#include <gmock/gmock.h>

#include "shoal/inclination_t.hpp"
#include "tests/devices/inertial/weightless.hpp"
#include "tests/devices/world_fixture.hpp"

namespace {

using sim::Vector3d;

std::string inclinometer(const std::string& more = "") {
  return "        - {name: tilt, type: inclinometer, rate_hz: 100, phase_s: 0, truth: true" + more + "}\n";
}
using test::weightless;

TEST(Inclinometer, ReadsItsMountingOnALevelRover) {
  test::TestWorld test(test::rover_world(inclinometer(", rpy_deg: [20, -10, 45]")));
  test::Listener<shoal::inclination_t> reports(test, "r1.tilt");
  test::Listener<shoal::inclination_t> truths(test, "r1.tilt.truth");
  test.run_for(3);
  const auto report = reports.last();
  EXPECT_NEAR(report.roll_rad, sim::degrees_to_radians(20), 0.01);  // the rover tilts on its casters by less
  EXPECT_NEAR(report.pitch_rad, sim::degrees_to_radians(-10), 0.01);
  const auto truth = truths.last();  // at rest both agree
  EXPECT_NEAR(report.roll_rad, truth.roll_rad, 1e-4);
  EXPECT_NEAR(report.pitch_rad, truth.pitch_rad, 1e-4);
}

/// A level box that is pushed forward with g, and upwards with its weight.
shoal::inclination_t pushed(const std::string& more, const std::string& channel, double time_s) {
  test::TestWorld test(test::box_world(inclinometer(more)));
  test::Listener<shoal::inclination_t> reports(test, channel);
  sim::Body& body = test.world.vehicles()[0]->body("hull");
  while (test.world.now() < sim::from_seconds(time_s)) {
    body.add_force_W({9.80665, 0, 9.80665}, body.X_WB().translation());
    test.world.step();
  }
  return reports.last();
}

TEST(Inclinometer, TakesAccelerationForATilt) {
  // The specific force (g, 0, g) looks like the nose up by 45 degrees.
  EXPECT_NEAR(pushed(", time_constant_s: 0", "r1.tilt", 0.1).pitch_rad, sim::degrees_to_radians(-45), 1e-9);
  EXPECT_NEAR(pushed(", time_constant_s: 0", "r1.tilt.truth", 0.1).pitch_rad, 0, 1e-9);
  EXPECT_NEAR(pushed(", ideal: true", "r1.tilt", 0.1).pitch_rad, 0, 1e-9);
}

TEST(Inclinometer, TheLowPassTakesItsTime) {
  // The first sample, at 10 ms, knows gravity only; after T the force along x is (1 - 1/e) g.
  EXPECT_NEAR(std::tan(-pushed(", time_constant_s: 0.2", "r1.tilt", 0.2).pitch_rad), 1 - std::exp(-(0.2 - 0.01) / 0.2),
              1e-9);
}

TEST(Inclinometer, TheLowPassBeginsAnewInAnotherPlace) {
  test::TestWorld test(test::box_world(inclinometer(", time_constant_s: 10")));
  test::Listener<shoal::inclination_t> reports(test, "r1.tilt");
  test.run_for(0.05);
  const double roll_rad = sim::degrees_to_radians(60);
  test.world.editor().move_vehicle("r1", sim::make_pose({0, 0, 0}, {roll_rad, 0, 0}));
  test.run_for(0.01);
  EXPECT_NEAR(reports.last().roll_rad, roll_rad, 1e-9);
}

TEST(Inclinometer, NoiseHasTheSpreadAskedFor) {
  test::TestWorld test(test::box_world(inclinometer(", ideal: true, noise: {gaussian_std: 0.01}"), weightless));
  test::Listener<shoal::inclination_t> reports(test, "r1.tilt");
  test.run_for(20);
  double squares = 0, mean = 0;
  const auto all = reports.take_all();
  const double n = 2.0 * static_cast<double>(all.size());
  for (const auto& report : all) {
    mean += (report.roll_rad + report.pitch_rad) / n;
    squares += (report.roll_rad * report.roll_rad + report.pitch_rad * report.pitch_rad) / n;
  }
  EXPECT_NEAR(mean, 0, 4 * 0.01 / std::sqrt(n));
  EXPECT_NEAR(std::sqrt(squares), 0.01, 4 * 0.01 / std::sqrt(2 * n));
}

TEST(Inclinometer, RefusesANegativeTimeConstant) {
  try {
    test::TestWorld test(test::box_world(inclinometer(", time_constant_s: -1")));
    FAIL();
  } catch (const sim::ConfigError& error) {
    EXPECT_THAT(error.what(), testing::HasSubstr("device 'tilt': 'time_constant_s' must be >= 0, got -1"));
  }
}

}  // namespace
