// SPDX-License-Identifier: BSD-3-Clause
#include <gmock/gmock.h>

#include "shoal/compass_t.hpp"
#include "sim/world/world_editor.hpp"
#include "tests/devices/inertial/weightless.hpp"
#include "tests/devices/world_fixture.hpp"

namespace {

using sim::degrees_to_radians;

/// 50 uT, 60 degrees down: 25 uT of it are level.  Declination 10 degrees east.
std::string compass(const std::string& more = "") {
  return "        - {name: compass, type: compass, rate_hz: 100, phase_s: 0, truth: true, field_uT: 50, "
         "inclination_deg: 60, declination_deg: 10" +
         more + "}\n";
}
using test::weightless;

/// What the compass says when the box has this attitude.
shoal::compass_t at(const std::string& more, double yaw_deg, double pitch_deg = 0, double roll_deg = 0,
                    const std::string& channel = "r1.compass") {
  test::TestWorld test(test::box_world(compass(more), weightless));
  test::Listener<shoal::compass_t> reports(test, channel);
  test.world.editor().move_vehicle(
      "r1", sim::make_pose({0, 0, 0}, sim::Vector3d(degrees_to_radians(roll_deg), degrees_to_radians(pitch_deg),
                                                    degrees_to_radians(yaw_deg))));
  test.run_for(0.1);
  return reports.last();
}

double difference(double a_rad, double b_rad) {
  return sim::wrap_angle(a_rad - b_rad);
}

TEST(Compass, ReadsTheHeadingClockwiseFromMagneticNorth) {
  // Yaw 90 looks north: 10 degrees west of magnetic north.  Yaw 0 looks east: 90 - 10.
  const std::string ideal = ", tilt_compensation: ideal, declination_correction_deg: 10";
  EXPECT_NEAR(at(ideal, 90).heading_rad, degrees_to_radians(350), 1e-9);
  EXPECT_NEAR(difference(at(ideal, 90).heading_true_rad, 0), 0, 1e-9);
  EXPECT_NEAR(at(ideal, 0).heading_rad, degrees_to_radians(80), 1e-9);
  EXPECT_NEAR(at(ideal, 0).heading_true_rad, degrees_to_radians(90), 1e-9);
  // Looking along magnetic north, x has all that is level and z what points down.
  const auto report = at(ideal, 80);
  EXPECT_NEAR(report.field_uT[0], 25, 1e-9);
  EXPECT_NEAR(report.field_uT[1], 0, 1e-9);
  EXPECT_NEAR(report.field_uT[2], -50 * std::sqrt(0.75), 1e-9);
}

TEST(Compass, TheTruthKnowsTrueNorthWhateverItWasTold) {
  const auto truth = at(", declination_correction_deg: 3, hard_iron_uT: [9, 9, 9]", 0, 20, 10, "r1.compass.truth");
  EXPECT_NEAR(truth.heading_true_rad, degrees_to_radians(90), 1e-9);
  EXPECT_NEAR(truth.heading_rad, degrees_to_radians(80), 1e-9);
}

TEST(Compass, HardIronGivesASineOverAFullTurn) {
  // 2.5 uT forward on 25 uT: the needle sees (H cos h + b, H sin h), so
  // tan(deviation) = -(b / H) sin h / (1 + (b / H) cos h); with b / H = 0.1: 0 at 0, -5.71 degrees at 90, 0 at 180,
  // 5.71 degrees at 270.
  const std::string iron = ", tilt_compensation: ideal, hard_iron_uT: [2.5, 0, 0]";
  const double at_side = std::atan(0.1);
  EXPECT_NEAR(at_side, degrees_to_radians(5.7106), 1e-5);
  for (int heading_deg = 0; heading_deg < 360; heading_deg += 30) {
    const double h = degrees_to_radians(heading_deg);
    const auto report = at(iron, 80 - heading_deg);
    EXPECT_NEAR(difference(report.heading_rad, h), -std::atan2(0.1 * std::sin(h), 1 + 0.1 * std::cos(h)), 1e-9)
        << heading_deg;
  }
  EXPECT_NEAR(difference(at(iron, 80 - 90).heading_rad, degrees_to_radians(90)), -at_side, 1e-9);
  EXPECT_NEAR(difference(at(iron, 80 - 270).heading_rad, degrees_to_radians(270)), at_side, 1e-9);
}

TEST(Compass, SoftIronGivesTwoWavesInATurn) {
  // x sees twice the field: tan(reading) = tan(h) / 2.
  const std::string iron = ", tilt_compensation: ideal, soft_iron: [2, 0, 0, 0, 1, 0, 0, 0, 1]";
  EXPECT_NEAR(at(iron, 80 - 45).heading_rad, std::atan(0.5), 1e-9);
  EXPECT_NEAR(at(iron, 80 - 90).heading_rad, degrees_to_radians(90), 1e-9);
  EXPECT_NEAR(at(iron, 80 - 225).heading_rad, std::atan(0.5) + degrees_to_radians(180), 1e-9);
}

TEST(Compass, WithoutTiltCompensationARollTurnsTheNeedle) {
  EXPECT_NEAR(at(", tilt_compensation: ideal", 80, 15, 20).heading_rad, 0, 1e-9);
  // Rolled by 20 degrees, left side up, towards magnetic north: y sees -50 sin(60) sin(20) of what points down,
  // against 25 along x.
  const double y_uT = -50 * std::sqrt(0.75) * std::sin(degrees_to_radians(20));
  EXPECT_NEAR(difference(at(", tilt_compensation: none", 80, 0, 20).heading_rad, std::atan2(y_uT, 25)), 0, 1e-9);
}

TEST(Compass, LevelsByTheSpecificForceAtRest) {
  test::TestWorld test(test::rover_world(compass(", rpy_deg: [20, -10, 80]")));
  test::Listener<shoal::compass_t> reports(test, "r1.compass");
  test::Listener<shoal::compass_t> truths(test, "r1.compass.truth");
  test.run_for(3);
  EXPECT_NEAR(difference(reports.last().heading_rad, truths.last().heading_rad), 0, 1e-3);
}

TEST(Compass, NoiseHasTheSpreadAskedFor) {
  test::TestWorld test(
      test::box_world(compass(", tilt_compensation: ideal, field_noise: {gaussian_std: 0.5}"), weightless));
  test::Listener<shoal::compass_t> reports(test, "r1.compass");
  test::Listener<shoal::compass_t> truths(test, "r1.compass.truth");
  test.run_for(20);
  const auto all = reports.take_all();
  const auto truth = truths.last();
  const auto n = static_cast<double>(all.size());
  double field = 0, heading = 0;
  for (const auto& report : all) {
    for (int i = 0; i < 3; ++i) field += std::pow(report.field_uT[i] - truth.field_uT[i], 2) / (3 * n);
    heading += std::pow(difference(report.heading_rad, truth.heading_rad), 2) / n;
  }
  EXPECT_NEAR(std::sqrt(field), 0.5, 4 * 0.5 / std::sqrt(2 * 3 * n));
  EXPECT_NEAR(std::sqrt(heading), 0.5 / 25, 4 * 0.02 / std::sqrt(2 * n));  // across the level field
}

TEST(Compass, RefusesAMatrixOfEightNumbers) {
  try {
    test::TestWorld test(test::box_world(compass(", soft_iron: [1, 0, 0, 0, 1, 0, 0, 0]")));
    FAIL();
  } catch (const sim::ConfigError& error) {
    EXPECT_THAT(error.what(), testing::HasSubstr("device 'compass': 'soft_iron' must have 9 numbers, got 8"));
  }
}

}  // namespace
