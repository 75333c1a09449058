// SPDX-License-Identifier: BSD-3-Clause
#include "devices/navigation/dvl.hpp"

#include <gmock/gmock.h>

#include "shoal/dvl_t.hpp"
#include "tests/devices/navigation/immersed_sensor_fixture.hpp"

namespace {

using shoal::dvl_t;
using test::bottom_at;
using test::marine_world;

/// The truth of a vehicle that goes at `v_W` (m/s) from the start; the second sample, for the first comes before that.
dvl_t truth_at_speed(const std::string& yaml, const sim::Vector3d& v_W) {
  test::TestWorld test(yaml);
  test::set_velocity(test, v_W);
  test::Listener<dvl_t> truths(test, "r1.s.truth");
  test.run_for(0.01);
  return truths.last();
}

TEST(Dvl, MeasuresFlatBottomAsTheClosedFormSays) {
  const auto report = truth_at_speed(marine_world("type: dvl", "[0, 0, -10]", bottom_at(-30)), {1.5, -0.4, 0.2});
  ASSERT_EQ(report.bottom_lock, 1);
  EXPECT_NEAR(report.velocity_mps[0], 1.5, 1e-9);
  EXPECT_NEAR(report.velocity_mps[1], -0.4, 1e-9);
  EXPECT_NEAR(report.velocity_mps[2], 0.2, 1e-9);
  const double altitude_m = 20 + 0.2 * 0.01;
  EXPECT_NEAR(report.altitude_m, altitude_m, 1e-4);  // rays are exact to 1e-6 of their length
  const double s = std::sin(sim::degrees_to_radians(30)), c = std::cos(sim::degrees_to_radians(30));
  const double h = std::sqrt(0.5);
  const double x[] = {h, -h, -h, h}, y[] = {h, h, -h, -h};  // at 45, 135, 225 and 315 deg
  for (int i = 0; i < 4; ++i) {
    EXPECT_EQ(report.beam_valid[i], 1);
    EXPECT_NEAR(report.beam_range_m[i], altitude_m / c, 1e-4);
    EXPECT_NEAR(report.beam_velocity_mps[i], s * (1.5 * x[i] - 0.4 * y[i]) - c * 0.2, 1e-9);
  }
}

TEST(Dvl, MeasuresInItsOwnAxesOverASlopeWhenItIsPitched) {
  // Nose down by 10 deg, over a bottom that tilts by 15 deg.
  const auto report = truth_at_speed(marine_world("type: dvl, first_azimuth_deg: 0", "[0, 0, -10]", bottom_at(-30, 15),
                                                  "", "{water: {surface_m: 0}}", "[0, 10, 0]"),
                                     {1, 0.5, 0});
  ASSERT_EQ(report.bottom_lock, 1);
  const double pitch_rad = sim::degrees_to_radians(10);
  EXPECT_NEAR(report.velocity_mps[0], std::cos(pitch_rad), 1e-9);
  EXPECT_NEAR(report.velocity_mps[1], 0.5, 1e-9);
  EXPECT_NEAR(report.velocity_mps[2], std::sin(pitch_rad), 1e-9);
  // The plane's normal is n = (sin 15, 0, cos 15); it is n.(p + 30 z) above it, and meets it along the direction d at
  // the range of that over -n.d.  The sensor's x axis is (cos 10, 0, -sin 10), its -z axis (-sin 10, 0, -cos 10).
  const double slope_rad = sim::degrees_to_radians(15);
  const double height_m = std::sin(slope_rad) * 0.01 + std::cos(slope_rad) * 20;
  const auto range_at = [&](double forward_deg) {  // of a direction in the xz-plane, from -z of the sensor towards x
    const double down_rad = sim::degrees_to_radians(forward_deg) - pitch_rad;  // from straight down towards x
    return height_m / (std::cos(slope_rad) * std::cos(down_rad) - std::sin(slope_rad) * std::sin(down_rad));
  };
  EXPECT_NEAR(report.beam_range_m[0], range_at(30), 1e-3);
  EXPECT_NEAR(report.beam_range_m[2], range_at(-30), 1e-3);
  EXPECT_NEAR(report.altitude_m, range_at(0), 1e-3);
}

TEST(Dvl, LosesTheBottomByAltitudeAndByAngle) {
  const auto locked = [](const std::string& keys, double bottom_m, const std::string& rpy_deg) {
    return truth_at_speed(marine_world("type: dvl, altitude_min_m: 2, altitude_max_m: 30" + keys, "[0, 0, -10]",
                                       bottom_at(bottom_m), "", "{water: {surface_m: 0}}", rpy_deg),
                          {0, 0, 0});
  };
  EXPECT_EQ(locked("", -39.9, "[0, 0, 0]").bottom_lock, 1);
  EXPECT_EQ(locked("", -40.1, "[0, 0, 0]").bottom_lock, 0);
  EXPECT_EQ(locked("", -12.1, "[0, 0, 0]").bottom_lock, 1);
  const auto near = locked("", -11.9, "[0, 0, 0]");
  EXPECT_EQ(near.bottom_lock, 0);
  EXPECT_TRUE(std::isnan(near.velocity_mps[0]) && std::isnan(near.altitude_m) && std::isnan(near.beam_range_m[0]));
  // Rolled by 40 deg the beams of one side meet the bottom far from its normal: at
  // acos(cos 30 cos 40 - sin 30 sin 40 / sqrt 2) = 64.3 deg.
  const auto rolled = [&](const char* angle) { return locked(angle, -15, "[40, 0, 0]"); };
  EXPECT_EQ(rolled(", incidence_max_deg: 65").bottom_lock, 1);
  EXPECT_EQ(rolled(", incidence_max_deg: 64").bottom_lock, 0);
}

TEST(Dvl, ThreeBeamsAreEnough) {
  // A pit under the fourth beam: the plate is missing beyond x > 0, y < 0.
  const std::string plates =
      "[{name: a, fixed: true, position_m: [-50, 0, -31], parts: [{shape: box, size_m: [100, 200, 2]}]}, "
      "{name: b, fixed: true, position_m: [50, 50, -31], parts: [{shape: box, size_m: [100, 100, 2]}]}]";
  const auto report = truth_at_speed(marine_world("type: dvl", "[0, 0, -10]", plates), {1, 0.5, -0.2});
  EXPECT_EQ(report.beam_valid[3], 0);
  ASSERT_EQ(report.bottom_lock, 1);
  EXPECT_NEAR(report.velocity_mps[0], 1, 1e-9);
  EXPECT_NEAR(report.velocity_mps[1], 0.5, 1e-9);
  EXPECT_NEAR(report.velocity_mps[2], -0.2, 1e-9);
  EXPECT_NEAR(report.altitude_m, 20 - 0.002, 1e-3);
}

TEST(Dvl, TracksALayerOfWaterWithoutABottom) {
  const char* current = "{water: {surface_m: 0}, current: {velocity_mps: [0.3, -0.1, 0]}}";
  const auto report = truth_at_speed(marine_world("type: dvl", "[0, 0, -10]", "[]", "", current), {1, 0, 0});
  EXPECT_EQ(report.bottom_lock, 0);
  ASSERT_EQ(report.water_lock, 1);
  EXPECT_NEAR(report.water_velocity_mps[0], 0.7, 1e-9);
  EXPECT_NEAR(report.water_velocity_mps[1], 0.1, 1e-9);
  EXPECT_NEAR(report.water_velocity_mps[2], 0, 1e-9);
  // The bottom is in the layer: no water track.
  const auto low = truth_at_speed(marine_world("type: dvl", "[0, 0, -10]", bottom_at(-17), "", current), {1, 0, 0});
  EXPECT_EQ(low.bottom_lock, 1);
  EXPECT_EQ(low.water_lock, 0);
}

TEST(Dvl, ReceivesNothingInAirAndInADryWorld) {
  for (const char* medium : {"{water: {surface_m: -20}}", "{}"}) {
    const auto report = truth_at_speed(marine_world("type: dvl", "[0, 0, -10]", bottom_at(-30), "", medium), {1, 0, 0});
    EXPECT_EQ(report.bottom_lock, 0) << medium;
    EXPECT_EQ(report.water_lock, 0) << medium;
  }
}

TEST(Dvl, NoiseOfItsBeamsSpreadsByTheGeometry) {
  // sum b b^T = diag(2 sin^2 a, 2 sin^2 a, 4 cos^2 a): the error of x is that of a beam over sqrt(2) sin a, of z that
  // over 2 cos a.
  test::TestWorld test(
      marine_world("type: dvl, beam_std_mps: 0.01, beam_std_per_mps: 0.005", "[0, 0, -10]", bottom_at(-30)));
  test::set_velocity(test, {2, 0, 0});
  test::Listener<dvl_t> reports(test, "r1.s");
  test.run_for(20);
  std::vector<double> x, z;
  double fom_mps = 0;
  for (const auto& report : reports.take_all()) {
    x.push_back(report.velocity_mps[0] - 2);
    z.push_back(report.velocity_mps[2]);
    fom_mps = report.fom_mps;
  }
  const double beam_mps = 0.01 + 2 * 0.005;
  const double x_mps = beam_mps / (std::sqrt(2) * 0.5), z_mps = beam_mps / (2 * std::cos(sim::degrees_to_radians(30)));
  const auto in_x = test::statistics(x), in_z = test::statistics(z);
  ASSERT_EQ(in_x.count, 2000);
  EXPECT_NEAR(in_x.mean, 0, 4 * x_mps / std::sqrt(2000));
  EXPECT_NEAR(in_x.std, x_mps, 4 * x_mps / std::sqrt(4000));
  EXPECT_NEAR(in_z.std, z_mps, 4 * z_mps / std::sqrt(4000));
  EXPECT_NEAR(fom_mps, std::sqrt(2 * x_mps * x_mps + z_mps * z_mps), 1e-9);
}

TEST(Dvl, AWrongSpeedOfSoundScalesVelocitiesAndRanges) {
  // The medium's speed of sound at 10 m in the default water, against 1500.
  test::TestWorld test(marine_world("type: dvl, assumed_sound_speed_mps: 1500", "[0, 0, -10]", bottom_at(-30)));
  test::set_velocity(test, {2, 0, 0});
  test::Listener<dvl_t> reports(test, "r1.s");
  test.run_for(0.01);
  const auto report = reports.last();
  const double scale = 1500 / test.world.medium().sound_speed_mps({0, 0, -10});
  ASSERT_GT(std::abs(scale - 1), 1e-3);
  EXPECT_NEAR(report.velocity_mps[0], 2 * scale, 1e-6);
  EXPECT_NEAR(report.altitude_m, 20 * scale, 1e-4);
}

TEST(Dvl, SaysWhatIsWrongWithItsParameters) {
  EXPECT_THAT(test::error_of_world(marine_world("type: dvl, altitude_min_m: 200, layer_from_m: 9, beam_angle_deg: 80")),
              testing::AllOf(testing::HasSubstr("'altitude_min_m' must be < altitude_max_m"),
                             testing::HasSubstr("'layer_from_m' must be < layer_to_m"),
                             testing::HasSubstr("'beam_angle_deg' must be >= 5 and <= 60, got 80")));
}

}  // namespace
