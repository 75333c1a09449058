// SPDX-License-Identifier: BSD-3-Clause
#include <gmock/gmock.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <numbers>

#include "sim/bus/in_process_bus.hpp"
#include "sim/world/world.hpp"
#include "sim/world_file/load_world.hpp"
#include "tests/fidelity/closed_forms.hpp"
#include "tests/scratch_folder.hpp"
#include "tests/sim/medium/log_capture.hpp"
#include "tests/sim/medium/medium_worlds.hpp"
#include "tests/state_hash_of.hpp"

namespace {

using sim::Time;
using sim::Vector3d;
using test::closed_forms_of;
using test::expect_closed_form;
using test_support::error_of;
using test_support::make_medium;
using test_support::read_medium;
using testing::HasSubstr;

void write(const std::string& file, const std::string& text) {
  std::ofstream(file) << text;
}

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

TEST(GaussMarkov, IsDiscretisedExactly) {
  // std = sigma_w / sqrt(2 mu), T = 1 / mu.
  for (const auto& form : closed_forms_of("gauss_markov", "exact_discrete_noise_std")) {
    const double mu = form.at("mu"), std = form.at("sigma_w") / std::sqrt(2 * mu);
    EXPECT_NEAR(sim::fresh_std(std, form.at("dt"), 1 / mu), form.expected, 1e-11);
  }
  for (const auto& form : closed_forms_of("gauss_markov", "autocorrelation"))
    EXPECT_NEAR(sim::kept_share(form.at("lag"), 1 / form.at("mu")), form.expected, 1e-10);
}

TEST(GaussMarkov, HasItsVarianceAndCorrelation) {
  sim::GaussMarkov process(Vector3d(0.05, 0.05, 0.05), 50, sim::Random(3, "test"));
  // 3 x 1e5 samples a second apart, T = 50 s: of 2e3 x 3 independent ones each, the standard error of the variance is
  // sqrt(2 / 6000) = 2 %.  The tolerance is that of closed_forms.csv, which is 5 of them.
  double squares = 0, products = 0;
  std::vector<Vector3d> values;
  for (int i = 0; i < 100000; ++i) {
    process.advance_to(Time{std::int64_t{i} * 1000000});
    values.push_back(process.values());
  }
  for (std::size_t i = 0; i + 10 < values.size(); ++i) {
    squares += values[i].squaredNorm();
    products += values[i].dot(values[i + 10]);
  }
  expect_closed_form(squares / (3.0 * 99990), "gauss_markov", "sigma_w=0.01;mu=0.02", "stationary_variance");
  expect_closed_form(products / squares, "gauss_markov", "mu=0.02;lag=10", "autocorrelation");
}

TEST(GaussMarkov, DoesNotDependOnTheStepsThatLedThere) {
  sim::GaussMarkov fine(Vector3d::Ones(), 7, sim::Random(3, "test")),
      coarse(Vector3d::Ones(), 7, sim::Random(3, "test"));
  for (int ms = 0; ms <= 20000; ms += 5) fine.advance_to(Time{std::int64_t{ms} * 1000});
  coarse.advance_to(Time{20000000});
  EXPECT_EQ(fine.values(), coarse.values());
  EXPECT_EQ(test::state_hash_of(fine), test::state_hash_of(coarse));
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

TEST(Current, GridIsBilinearAndKnowsItsBorder) {
  const test_support::ScratchFolder folder;
  write(folder.file("flow.csv"), "x_m,y_m,east_mps,north_mps\n0,0,0,1\n10,0,1,1\n0,20,2,1\n10,20,5,1\n");
  for (const std::string outside : {"zero", "edge"}) {
    const sim::Medium medium(
        read_medium("{water: {}, current: [{type: grid, file: flow.csv, outside: " + outside + "}]}",
                    folder.file("world.yaml")),
        9.81, 1);
    // u(a, b) with a = 0.5, b = 0.25: 0.75 * 0.5 + 0.25 * 3.5.
    EXPECT_TRUE(medium.water_velocity_W({5, 5, -1}).isApprox(Vector3d(1.25, 1, 0), 1e-12));
    EXPECT_TRUE(medium.current_known({5, 5, -1}));
    EXPECT_FALSE(medium.current_known({-5, 0, -1}));
    const Vector3d beyond = outside == "zero" ? Vector3d::Zero() : Vector3d(0, 1, 0);
    EXPECT_EQ(medium.water_velocity_W({-5, 0, -1}), beyond);
  }
}

TEST(Current, GridComesFromAPairOfEsriGrids) {
  const test_support::ScratchFolder folder;
  const std::string header = "ncols 2\nnrows 2\nxllcenter 1000\nyllcenter 2000\ncellsize 10\n";
  write(folder.file("u.asc"), header + "0 1\n2 3\n");
  write(folder.file("v.asc"), header + "0 0\n0 -9999\n");
  const sim::Medium medium(
      read_medium(
          "{water: {}, current: [{type: grid, east_file: u.asc, north_file: v.asc, map_origin_m: [1000, 2000]}]}",
          folder.file("world.yaml")),
      9.81, 1);
  // The first row of the file is the north; the hole takes its neighbor's 0.
  EXPECT_TRUE(medium.water_velocity_W({5, 0, -1}).isApprox(Vector3d(2.5, 0, 0), 1e-12));
  EXPECT_TRUE(medium.water_velocity_W({5, 10, -1}).isApprox(Vector3d(0.5, 0, 0), 1e-12));
}

TEST(Current, BadGridsAreRefusedWithTheLine) {
  const test_support::ScratchFolder folder;
  const auto error = [&](const std::string& csv) {
    write(folder.file("flow.csv"), csv);
    return error_of("{water: {}, current: [{type: grid, file: flow.csv}]}", folder.file("world.yaml"));
  };
  const std::string header = "x_m,y_m,east_mps,north_mps\n";
  EXPECT_THAT(error("x,y,u,v\n"), HasSubstr("line 1: the header must name"));
  EXPECT_THAT(error(header + "0,0,a,1\n"), HasSubstr("line 2: 'east_mps' is not a number"));
  EXPECT_THAT(error(header + "0,0,nan,1\n"), HasSubstr("line 2: 'east_mps' is not a number, got 'nan'; a grid in a CSV "
                                                       "file must have all its points"));
  EXPECT_THAT(error(header + "0,0,,1\n"), HasSubstr("line 2: 'east_mps' is not a number, got ''"));
  EXPECT_THAT(error(header + "0,0,-99,1\n0,1,1,1\n1,0,1,1\n1,1,1,1\n"),
              HasSubstr("has a current of 99 m/s, which is a code for a missing value"));
  EXPECT_THAT(error(header + "0,0,1\n"), HasSubstr("line 2: 'north_mps' is missing"));
  EXPECT_THAT(error(header + "0,0,1,1\n0,1,1,1\n1,0,1,1\n"), HasSubstr("one row for each of 2 x 2 points, has 3"));
  EXPECT_THAT(error(header + "0,0,1,1\n0,1,1,1\n1,0,1,1\n1,0,1,1\n"), HasSubstr("has the point 1, 0 twice"));
  EXPECT_THAT(error(header + "0,0,1,1\n1,0,1,1\n3,0,1,1\n0,1,1,1\n1,1,1,1\n3,1,1,1\n"),
              HasSubstr("is not a regular grid"));
  EXPECT_THAT(error(header + "0,0,101,1\n0,1,1,1\n1,0,1,1\n1,1,1,1\n"), HasSubstr("a current of 101 m/s"));
  EXPECT_THAT(error(""), HasSubstr("has no rows"));
}

TEST(Current, GridsAreReadAsSpreadsheetsAndGdalWriteThem) {
  const test_support::ScratchFolder folder;
  write(folder.file("flow.csv"),
        "\xef\xbb\xbfx_m,y_m,east_mps,north_mps\r\n0,0,1,0\r\n10,0,1,0\r\n0,10,1,0\r\n10,10,"
        "1,0\r\n");
  const std::string grid = "\xef\xbb\xbfncols 2\nnrows 2\nxllcenter 0\nyllcenter 0\ndx 10\ndy 10\nNODATA_value nan\n";
  write(folder.file("u.asc"), grid + "1 nan\n1 1\n");
  write(folder.file("v.asc"), grid + "0 0\n0 0\n");
  for (const char* files : {"file: flow.csv", "east_file: u.asc, north_file: v.asc"}) {
    const sim::Medium medium(
        read_medium("{water: {}, current: [{type: grid, " + std::string(files) + "}]}", folder.file("world.yaml")),
        9.81, 1);
    EXPECT_EQ(medium.water_velocity_W({7, 7, -1}), Vector3d(1, 0, 0)) << files;
  }
  write(folder.file("v.asc"), grid + "0 0\n0 zero\n");
  EXPECT_THAT(
      error_of("{water: {}, current: [{type: grid, east_file: u.asc, north_file: v.asc}]}", folder.file("world.yaml")),
      HasSubstr("v.asc' line 9: current 2 of row 2 is not a number, got 'zero'"));
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

TEST(Current, WhereABodyLeftItsFileIsSaidToTheDecimeter) {
  const test_support::ScratchFolder folder;
  write(folder.file("flow.csv"), "x_m,y_m,east_mps,north_mps\n0,0,1,0\n10,0,1,0\n0,10,1,0\n10,10,1,0\n");
  const sim::LoadedWorld loaded = sim::load_world_text(R"(
shoal: 1
medium: {water: {}, current: [{type: grid, file: flow.csv}]}
objects:
  - {name: buoy, position_m: [10.16, 3.333333333333333, 0], parts: [{shape: sphere, radius_m: 1, density_kgpm3: 500}]}
)",
                                                       folder.file("world.yaml"));
  sim::InProcessBus bus;
  sim::World world(loaded.config, bus);
  const test_support::LogCapture log;
  world.step();
  EXPECT_THAT(log.text(), HasSubstr("has left the file of the current at 10.2, 3.3 m"));
}

TEST(Current, KeysOfOtherTypesAreRefused) {
  EXPECT_THAT(error_of("{water: {}, current: [{type: vortex, std_mps: 1}]}"),
              HasSubstr("'std_mps' does not apply to type vortex"));
  EXPECT_THAT(error_of("{water: {}, current: [{type: grid}]}"), HasSubstr("needs either 'file' or both"));
  EXPECT_THAT(error_of("{water: {}, current: [{type: profile}]}"), HasSubstr("needs the key 'profile'"));
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

TEST(Wind, GrowsWithTheHeight) {
  const sim::Medium power = make_medium("wind: {speed_mps: 10, direction_deg: 90, profile: power, exponent: 0.12}");
  EXPECT_NEAR(power.air_velocity_W({0, 0, 10}).y(), 10, 1e-9);
  EXPECT_NEAR(power.air_velocity_W({0, 0, 2}).y(), 10 * std::pow(0.2, 0.12), 1e-9);
  const sim::Medium log = make_medium("wind: {velocity_mps: [10, 0, 0], profile: log, roughness_m: 0.001}");
  EXPECT_NEAR(log.air_velocity_W({0, 0, 1}).x(), 7.5, 1e-9);  // ln(1000) / ln(10000)
  EXPECT_EQ(log.air_velocity_W({0, 0, -1}).norm(), 0);
}

TEST(Wind, ComesFromWhereForecastsSay) {
  const sim::Medium medium = make_medium("wind: {speed_mps: 8, from_compass_deg: 270}");
  EXPECT_TRUE(medium.air_velocity_W({0, 0, 10}).isApprox(Vector3d(8, 0, 0), 1e-12));  // a west wind blows to the east
  const sim::Medium north = make_medium("wind: {speed_mps: 8, from_compass_deg: 0}");
  EXPECT_TRUE(north.air_velocity_W({0, 0, 10}).isApprox(Vector3d(0, -8, 0), 1e-12));
}

TEST(Wind, GustsHaveTheirDeviationAlongAndAcross) {
  sim::Medium medium =
      make_medium("wind: {speed_mps: 10, direction_deg: 90, gusts: {std_mps: 2, across_std_mps: 1, length_m: 50}}");
  double along = 0, across = 0;
  constexpr int samples = 40000;
  for (int i = 0; i < samples; ++i) {
    medium.advance_to(Time{std::int64_t{i} * 1000000});
    const Vector3d v_W = medium.air_velocity_W({0, 0, 10});
    along += (v_W.y() - 10) * (v_W.y() - 10);
    across += v_W.x() * v_W.x();
  }
  // T = 5 s, two of them apart: 8e3 independent samples, 1.6 % of the variance, 1 % between ticks; tolerance 4 %.
  EXPECT_NEAR(std::sqrt(along / samples), 2, 0.08);
  EXPECT_NEAR(std::sqrt(across / samples), 1, 0.04);
}

TEST(Wind, ADryWorldHasItToo) {
  sim::Medium medium = make_medium("wind: {gusts: {}}"), later = make_medium("wind: {gusts: {}}");
  const std::uint64_t before = test::state_hash_of(medium);
  later.advance_to(Time{1000000});
  EXPECT_NE(before, test::state_hash_of(later));
}

}  // namespace
