// SPDX-License-Identifier: BSD-3-Clause
#include "devices/inertial/vibration.hpp"

#include <gmock/gmock.h>

#include <cmath>
#include <numbers>

#include "shoal/vibration_t.hpp"
#include "tests/devices/state_fixture.hpp"

namespace {

using testing::HasSubstr;

std::string vibration_world(const std::string& keys = "") {
  return test::box_world("        - {name: vibration, type: vibration, rate_hz: 2" + keys + "}\n",
                         "{step_s: 0.0005, gravity_mps2: 9.81}");
}

/// Root mean square of a box of 1 kg that is shaken by 1 N at a frequency, after 2 s.
double shaken(test::TestWorld& test, double frequency_Hz) {
  test::Listener<shoal::vibration_t> reports(test, "r1.vibration");
  auto& hull = test.world.find_vehicle("r1")->body("hull");
  for (int i = 0; i < 4000; ++i) {
    hull.add_force_W({std::sin(2 * std::numbers::pi * frequency_Hz * 0.0005 * i), 0, 0}, hull.X_WB().translation());
    test.world.step();
  }
  return reports.last().rms_mps2;
}

/// Gain of a first-order low pass and high pass.
double gain(double frequency_Hz, double low_Hz, double high_Hz) {
  const double a = frequency_Hz / high_Hz, b = frequency_Hz / low_Hz;
  // 1 / (1 + j a) and j b / (1 + j b)
  return b / std::sqrt((1 + a * a) * (1 + b * b));
}

TEST(Vibration, PassesItsBandAndNothingElse) {
  for (const double frequency_Hz : {2.0, 50.0, 400.0}) {
    test::TestWorld test(vibration_world());
    const double expected = gain(frequency_Hz, 10, 200) / std::numbers::sqrt2;
    // Filters in steps of 0.5 ms: within 8 % up to a fifth of the rate of the steps.
    EXPECT_NEAR(shaken(test, frequency_Hz), expected, 0.08 * expected + 0.002) << frequency_Hz;
  }
}

TEST(Vibration, DoesNotFeelGravity) {
  test::TestWorld test(vibration_world());
  test::Listener<shoal::vibration_t> reports(test, "r1.vibration");
  test.run_for(1.5);
  EXPECT_NEAR(reports.last().rms_mps2, 0, 1e-6);
}

TEST(Vibration, PeakIsThatSinceTheLastReport) {
  test::TestWorld test(vibration_world());
  test::Listener<shoal::vibration_t> reports(test, "r1.vibration");
  test.run_for(0.6);
  auto& hull = test.world.find_vehicle("r1")->body("hull");
  hull.add_force_W({200, 0, 0}, hull.X_WB().translation());  // 0.1 N s in one step
  test.run_for(1.4);
  const auto all = reports.take_all();
  ASSERT_GE(all.size(), 3u);
  std::size_t felt = 0;
  for (std::size_t i = 1; i < all.size(); ++i) felt = all[i].peak_mps2 > all[felt].peak_mps2 ? i : felt;
  // The first step after the impulse: 200 m/s^2 times 1 - exp(-dt / T) of the low pass and exp(-dt / T) of the high
  // pass.
  const double expected =
      200 * (1 - std::exp(-0.0005 * 2 * std::numbers::pi * 200)) * std::exp(-0.0005 * 2 * std::numbers::pi * 10);
  EXPECT_NEAR(all[felt].peak_mps2, expected, 0.01 * expected);
  EXPECT_LT(all.back().peak_mps2, 0.01 * expected);
}

TEST(Vibration, AddsTheErrorOfItsNoise) {
  test::TestWorld test(vibration_world(", noise: {bias: 0.5}"));
  test::Listener<shoal::vibration_t> reports(test, "r1.vibration");
  test.run_for(1.2);
  EXPECT_NEAR(reports.last().rms_mps2, 0.5, 1e-6);
}

TEST(Vibration, SaysWhatIsWrongWithItsParameters) {
  EXPECT_THAT(test::error_of_world(vibration_world(", low_Hz: 20, high_Hz: 20")),
              HasSubstr("'high_Hz' must be > 'low_Hz'"));
}

}  // namespace
