// SPDX-License-Identifier: BSD-3-Clause
#include <gmock/gmock.h>

#include "shoal/leak_t.hpp"
#include "sim/world/world_editor.hpp"
#include "tests/devices/navigation/immersed_sensor_fixture.hpp"

namespace {

using shoal::leak_t;
using test::marine_world;

TEST(Leak, ComesFromGoingDeeperThanTheHullIsRatedForAndStays) {
  test::TestWorld test(marine_world("type: leak, rated_depth_m: 10.5, ingress_lps: 0.1, alarm_l: 0.05"));
  test::Listener<leak_t> reports(test, "r1.s");
  test.run_for(1);
  EXPECT_EQ(reports.last().leak, 0);
  test::set_velocity(test, {0, 0, -1});  // 10.5 m deep after half a second
  test.run_for(0.49);
  EXPECT_EQ(reports.last().water_l, 0);
  test.run_for(0.51);
  test::set_velocity(test, {0, 0, 2});
  test.run_for(1);  // at 9 m
  const auto report = reports.last();
  EXPECT_EQ(report.leak, 1);
  EXPECT_NEAR(report.water_l, 0.1 * 1.5, 0.1 * 0.021);  // within two samples
}

TEST(Leak, AnEventMakesOneUnderWaterOnly) {
  for (const auto& [position_m, leaks] : {std::pair{"[0, 0, -10]", 1}, std::pair{"[0, 0, 1]", 0}}) {
    test::TestWorld test(marine_world("type: leak, ingress_lps: 0.1, volume_l: 0.2", position_m));
    test::Listener<leak_t> reports(test, "r1.s");
    EXPECT_EQ(test.change("r1/s", "{leaking: true}"), "");
    test.run_for(1);
    const auto report = reports.last();
    EXPECT_EQ(report.leak, leaks);
    EXPECT_NEAR(report.water_l, 0.1 * leaks, 0.0021);
    test.run_for(2);
    EXPECT_NEAR(reports.last().water_l, 0.2 * leaks, 1e-9);  // full
  }
}

TEST(Leak, ABiasOfItsProbeIsAFalseAlarm) {
  test::TestWorld test(marine_world("type: leak"));
  test::Listener<leak_t> reports(test, "r1.s"), truths(test, "r1.s.truth");
  sim::FaultConfig fault;
  fault.kind = sim::FaultKind::biased;
  fault.quantity = "water";
  fault.bias = 0.5;
  test.world.editor().set_fault("r1/s", fault);
  test.run_for(0.1);
  EXPECT_EQ(reports.last().leak, 1);
  EXPECT_EQ(truths.last().leak, 0);
}

TEST(Leak, NoiseHasTheSpreadAskedFor) {
  // With water in the hull, so that nothing is cut off at zero.
  test::TestWorld test(
      marine_world("type: leak, leaking: true, ingress_lps: 100, volume_l: 5, water_noise: {gaussian_std: 0.1}"));
  test::Listener<leak_t> reports(test, "r1.s");
  test.run_for(0.2);
  reports.take_all();
  test.run_for(20);
  std::vector<double> water_l;
  for (const auto& report : reports.take_all()) water_l.push_back(report.water_l);
  const auto [mean, std, count] = test::statistics(water_l);
  EXPECT_NEAR(mean, 5, 4 * 0.1 / std::sqrt(count));
  EXPECT_NEAR(std, 0.1, 4 * 0.1 / std::sqrt(2 * count));
}

TEST(Leak, RefusesARatedDepthOfNothing) {
  EXPECT_THAT(test::error_of_world(marine_world("type: leak, rated_depth_m: 0")),
              testing::HasSubstr("device 's': 'rated_depth_m' must be > 0, got 0"));
}

}  // namespace
