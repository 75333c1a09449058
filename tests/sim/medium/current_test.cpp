// SPDX-License-Identifier: BSD-3-Clause
#include "sim/medium/current.hpp"

#include <gmock/gmock.h>

#include <cmath>
#include <filesystem>

#include "sim/bus/in_process_bus.hpp"
#include "sim/world/world.hpp"
#include "sim/world_file/load_world.hpp"
#include "tests/fidelity/closed_forms.hpp"
#include "tests/scratch_folder.hpp"
#include "tests/sim/medium/log_capture.hpp"
#include "tests/sim/medium/medium_worlds.hpp"

namespace {

using sim::Time;
using sim::Vector3d;
using test::closed_forms_of;
using test_support::error_of;
using test_support::make_medium;
using testing::HasSubstr;

TEST(Current, EntriesAddUp) {
  const sim::Medium medium = make_medium(R"(
water: {}
current:
  - {velocity_mps: [0.3, 0, 0]}
  - {type: profile, profile: [{depth_m: 0, velocity_mps: [1, 0, 0]}, {depth_m: 10, velocity_mps: [0, 1, 0]}]}
)");
  EXPECT_TRUE(medium.water_velocity_W({0, 0, -2.5}).isApprox(Vector3d(1.05, 0.25, 0), 1e-12));
  EXPECT_TRUE(medium.water_velocity_W({0, 0, -50}).isApprox(Vector3d(0.3, 1, 0), 1e-12));
}

TEST(Current, OneEntryNeedsNoList) {
  const sim::Medium medium = make_medium("{water: {}, current: {velocity_mps: [0.3, 0.1, 0]}}");
  EXPECT_EQ(medium.water_velocity_W({0, 0, -1}), Vector3d(0.3, 0.1, 0));
  EXPECT_THAT(error_of("{water: {}, current: {velocity: [0.3, 0.1, 0]}}"),
              HasSubstr("medium: current 1: unknown key 'velocity'"));
}

TEST(Current, ProfilesOfDnvFallToTheBottom) {
  for (const auto& form : closed_forms_of("current_power_law_1_7")) {
    const sim::Medium tidal =
        make_medium("{water: {}, current: [{type: power_law, speed_mps: " + std::to_string(form.at("V_surface")) +
                    ", direction_deg: 90, water_depth_m: " + std::to_string(form.at("water_depth")) + "}]}");
    EXPECT_NEAR(tidal.water_velocity_W({0, 0, -form.at("depth")}).y(), form.expected, 1e-9);
    EXPECT_EQ(tidal.water_velocity_W({0, 0, -form.at("water_depth") - 10}).norm(), 0);
  }
  for (const auto& form : closed_forms_of("current_wind_linear")) {
    const sim::Medium windy =
        make_medium("{water: {}, current: [{type: wind_driven, speed_mps: " + std::to_string(form.at("V_surface")) +
                    ", reference_depth_m: " + std::to_string(form.at("d0")) + "}]}");
    EXPECT_NEAR(windy.water_velocity_W({0, 0, -form.at("depth")}).x(), form.expected, 1e-12);
    EXPECT_EQ(windy.water_velocity_W({0, 0, -60}).norm(), 0);
  }
}

TEST(Current, WandersInSpeedAndDirection) {
  const std::string yaml =
      "{water: {}, current: [{type: gauss_markov, speed_mps: 0.5, direction_deg: 90, std_mps: 0.1, "
      "direction_std_deg: 10, correlation_time_s: 20}]}";
  sim::Medium medium = make_medium(yaml), other = make_medium(yaml, 2);
  double speeds = 0, angles = 0;
  constexpr int samples = 20000;
  for (int i = 0; i < samples; ++i) {
    medium.advance_to(Time{std::int64_t{i} * 1000000});
    const Vector3d v_W = medium.water_velocity_W({0, 0, -1});
    EXPECT_EQ(v_W.z(), 0);
    speeds += v_W.norm();
    angles += std::atan2(v_W.y(), v_W.x());
  }
  // 1e3 independent samples: standard errors 0.0032 * sqrt(2) m/s and 0.45 degrees; tolerance 3 of them.
  EXPECT_NEAR(speeds / samples, 0.5, 0.014);
  EXPECT_NEAR(sim::radians_to_degrees(angles / samples), 90, 1.4);
  other.advance_to(medium.now());
  EXPECT_NE(other.water_velocity_W({0, 0, -1}), medium.water_velocity_W({0, 0, -1}));
}

TEST(Current, VortexIsFastestAtItsCore) {
  for (const std::string core : {"lamb_oseen", "rankine"}) {
    const sim::Medium medium = make_medium(
        "{water: {}, current: [{type: vortex, center_m: [10, 0], core_radius_m: 5, peak_speed_mps: 0.4, core: " + core +
        "}]}");
    const auto speed = [&](double r) { return medium.water_velocity_W({10 + r, 0, -1}).y(); };
    EXPECT_NEAR(speed(5), 0.4, 1e-9) << core;
    EXPECT_NEAR(speed(-5), -0.4, 1e-9) << core;
    EXPECT_LT(speed(4.9), 0.4);
    EXPECT_LT(speed(5.1), 0.4);
    EXPECT_EQ(speed(0), 0);
    // Far away the circulation 2 pi r v stays: 2 pi 5 0.4, for Lamb and Oseen times 1 + 1 / (2 a).
    const double factor = core == "rankine" ? 1 : 1 + 0.5 / 1.2564312086;
    EXPECT_NEAR(speed(100) * 100, factor * 0.4 * 5, 1e-9) << core;
  }
}

TEST(Current, ABadFileIsSaidOfItsEntry) {
  const test_support::ScratchFolder folder;
  std::filesystem::create_directory(folder.file("flow"));
  const auto error = [&](const std::string& name) {
    return error_of("{water: {}, current: [{velocity_mps: [1, 0, 0]}, {type: grid, file: " + name + "}]}",
                    folder.file("world.yaml"));
  };
  EXPECT_THAT(error("flow"), HasSubstr(":1:50: medium: current 2: file '" + folder.file("flow") + "' is not a file"));
  EXPECT_THAT(error("none.csv"), HasSubstr("medium: current 2: file '" + folder.file("none.csv") + "' does not exist"));
}

TEST(Tide, LiftsTheSurfaceAndMovesTheWater) {
  sim::Medium medium = make_medium(
      "{water: {surface_m: 1}, tides: [{amplitude_m: 2, period_s: 40000, current_mps: 0.5, current_lead_deg: 90}]}");
  EXPECT_NEAR(medium.surface_m(0, 0), 3, 1e-12);
  EXPECT_NEAR(medium.water_velocity_W({0, 0, -5}).norm(), 0, 1e-12);  // slack at high water
  EXPECT_NEAR(medium.surface_m(0, 0, Time{20000000000}), -1, 1e-9);
  medium.advance_to(Time{30000000000});  // a quarter before high water: the flood is fastest
  EXPECT_NEAR(medium.surface_m(0, 0), 1, 1e-9);
  EXPECT_NEAR(medium.water_velocity_W({0, 0, -5}).x(), 0.5, 1e-9);
}

TEST(Tide, OneEntryNeedsNoList) {
  const sim::Medium medium = make_medium("{water: {}, tides: {amplitude_m: 2, period_s: 40000}}");
  EXPECT_NEAR(medium.surface_m(0, 0), 2, 1e-12);
  EXPECT_THAT(error_of("{water: {}, tides: {amplitude: 2}}"), HasSubstr("medium: tide 1: unknown key 'amplitude'"));
  EXPECT_THAT(error_of("{water: {}, tides: 2}"), HasSubstr("'tides' must be a list of maps, got '2'"));
}

}  // namespace
