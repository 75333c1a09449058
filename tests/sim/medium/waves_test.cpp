// SPDX-License-Identifier: BSD-3-Clause
#include "sim/medium/waves.hpp"

#include <gmock/gmock.h>

#include <cmath>
#include <limits>

#include "tests/fidelity/closed_forms.hpp"
#include "tests/sim/medium/medium_worlds.hpp"
#include "tests/sim/medium/wave_records.hpp"

namespace {

using namespace wave_records;

using sim::Time;
using sim::Vector3d;
using sim::WavesConfig;
using test::closed_form;
using test::closed_forms_of;
using test::ClosedForm;
using test::expect_closed_form;
using test_support::make_medium;

constexpr double deep = std::numeric_limits<double>::infinity();

TEST(WaveNumber, IsThatOfDeepAndOfFiniteWater) {
  // Rows have 10 digits.
  for (const auto& form : closed_forms_of("deep_water_wave", "wavelength"))
    EXPECT_NEAR(2 * pi / sim::wave_number(2 * pi / form.at("T"), form.at("g"), deep), form.expected, 1e-7);
  for (const auto& form : closed_forms_of("finite_depth_wave", "wavelength"))
    EXPECT_NEAR(2 * pi / sim::wave_number(2 * pi / form.at("T"), form.at("g"), form.at("water_depth")), form.expected,
                1e-7);
  for (const double depth_m : {0.1, 1.0, 30.0, 1000.0})
    for (const double omega : {0.1, 1.0, 5.0, 20.0}) {
      const double k = sim::wave_number(omega, g, depth_m);
      EXPECT_NEAR(g * k * std::tanh(k * depth_m) / (omega * omega), 1, 1e-13) << depth_m << " " << omega;
    }
}

TEST(RegularWave, RunsWithItsPhaseSpeed) {
  for (const auto& form : closed_forms_of("deep_water_wave", "phase_speed")) {
    const double period_s = form.at("T");
    sim::Medium medium =
        make_medium("{water: {}, waves: {type: regular, height_m: 2, period_s: " + std::to_string(period_s) +
                    ", direction_deg: 90, phase_deg: 0}}");
    EXPECT_NEAR(medium.surface_m(7, 0), 1, 1e-9);
    EXPECT_NEAR(medium.surface_m(0, form.expected * period_s / 2), -1, 1e-9);
    medium.advance_to(Time{1000000});
    EXPECT_NEAR(medium.surface_m(7, form.expected), 1, 1e-9);
    EXPECT_EQ(medium.surface_m(3, 4, Time{1000000}), medium.surface_m(3, 4));
  }
}

TEST(RegularWave, OrbitsShrinkWithTheDepth) {
  // Depth counts from the momentary surface: where the elevation is 0 that is the still one.
  for (const auto& form : closed_forms_of("deep_water_wave", "orbital_speed")) {
    const double period_s = form.at("T"), speed = form.expected;
    const sim::Medium medium =
        make_medium("{water: {}, waves: {type: regular, height_m: " + std::to_string(2 * form.at("amplitude")) +
                    ", period_s: " + std::to_string(period_s) + ", phase_deg: 90}}");
    const sim::LocalWater water = medium.water_at({0, 0, -form.at("depth")});
    EXPECT_NEAR(water.surface_m, 0, 1e-9);
    EXPECT_NEAR(water.velocity_W.norm(), speed, 1e-8);
    // phase 90 degrees: the elevation is -a sin(kx - wt), which rises at the origin.
    EXPECT_NEAR(water.velocity_W.z(), -speed * -1, 1e-8);
    EXPECT_NEAR(water.acceleration_W.x(), speed * 2 * pi / period_s, 1e-8);
  }
}

TEST(RegularWave, MovesTheWaterAsItsElevationSays) {
  // Kinematics at the surface (over it the answer is that of the surface): the water there rises as the surface does.
  // The difference over 2 ms is known to (2 pi / 6 s)^2 (1 ms)^2 / 6 of it.
  for (const std::string depth : {"", ", water_depth_m: 8"}) {
    sim::Medium medium = make_medium(
        "{water: {}, waves: {type: regular, height_m: 0.01, period_s: 6, phase_deg: 40, "
        "direction_deg: 30" +
        depth + "}}");
    medium.advance_to(Time{700000});
    const double rate = (medium.surface_m(3, 4, Time{701000}) - medium.surface_m(3, 4, Time{699000})) / 0.002;
    EXPECT_NEAR(medium.water_velocity_W({3, 4, 1}).z(), rate, 5e-9);
    // Nothing flows through the bottom, and without one, nothing moves far below.
    EXPECT_NEAR(medium.water_at({3, 4, depth.empty() ? -300.0 : -8.0}).velocity_W.z(), 0, 1e-6);
    const Vector3d before_W = medium.water_velocity_W({3, 4, -2});
    medium.advance_to(Time{701000});
    const Vector3d change_W = (medium.water_velocity_W({3, 4, -2}) - before_W) / 0.001;
    EXPECT_LT((change_W - medium.water_at({3, 4, -2}).acceleration_W).norm(), 5e-5);
  }
}

TEST(RegularWave, KeepsTheWaterWhole) {
  // div v = 0 of linear theory, by central differences at the still water of a small wave.
  const sim::Medium medium = make_medium(
      "{water: {}, waves: {type: regular, height_m: 0.002, period_s: 4, phase_deg: 70, direction_deg: 25, "
      "water_depth_m: 5}}");
  const double h = 1e-3;
  double divergence = 0, largest = 0;
  for (int axis = 0; axis < 3; ++axis) {
    Vector3d step = Vector3d::Zero();
    step[axis] = h;
    const Vector3d p_W(1, 2, -1.5);
    const double part =
        (medium.water_velocity_W(p_W + step)[axis] - medium.water_velocity_W(p_W - step)[axis]) / (2 * h);
    divergence += part;
    largest = std::max(largest, std::abs(part));
  }
  EXPECT_LT(std::abs(divergence), 2e-3 * largest);  // the steepness, by which Wheeler's depth differs
}

TEST(RegularWave, PressureFollowsTheWaterAndIsAirAtTheSurface) {
  const sim::Medium medium = make_medium("{water: {}, waves: {type: regular, height_m: 1, period_s: 5, phase_deg: 0}}");
  const double wavelength = closed_form("deep_water_wave", "T=5", "wavelength").expected, k = 2 * pi / wavelength;
  // Under the crest 10.5 m below it, under the trough 9.5 m: rho g (z + a e^(-k d)).
  EXPECT_NEAR(medium.pressure_Pa({0, 0, -10}), 101325 + 1025 * g * (10 + 0.5 * std::exp(-k * 10.5)), 1e-3);
  EXPECT_NEAR(medium.pressure_Pa({wavelength / 2, 0, -10}), 101325 + 1025 * g * (10 - 0.5 * std::exp(-k * 9.5)), 1e-3);
  for (const double x : {0.0, wavelength / 2, 5.0}) {
    const double surface_m = medium.surface_m(x, 0);
    EXPECT_NEAR(medium.pressure_Pa({x, 0, surface_m - 1e-6}), 101325, 0.05) << x;
    EXPECT_EQ(medium.pressure_Pa({x, 0, surface_m + 1e-6}), 101325) << x;
  }
}

/// Elevation statistics of a sea at places far from each other.
struct Record {
  double mean_m = 0, variance_m2 = 0, tz_s = 0;
};

Record record_of(const std::string& waves, double tp_s, int places) {
  sim::Medium medium = make_medium("{water: {}, waves: {" + waves + "}}");
  const auto step = sim::from_seconds(tp_s / 50);
  const int steps = 50 * 200;  // 200 Tp
  std::vector<double> last(static_cast<std::size_t>(places), 0);
  double sum = 0, squares = 0;
  int rises = 0;
  for (int i = 0; i < steps; ++i) {
    medium.advance_to(step * i);
    for (int place = 0; place < places; ++place) {
      const double height = medium.surface_m(1713.0 * place, 931.0 * place * place);
      sum += height;
      squares += height * height;
      double& before = last[static_cast<std::size_t>(place)];
      rises += i > 0 && before <= 0 && height > 0;
      before = height;
    }
  }
  const double count = static_cast<double>(steps) * places;
  return {sum / count, squares / count, sim::to_seconds(step) * count / rises};
}

TEST(IrregularWaves, HaveTheirHeightAndPeriod) {
  // A record of 200 Tp at one place knows the variance of a Gaussian sea to 7 % (sqrt(pi int S^2 / (m0^2 T))); 40
  // places make that 1.1 %.  The rows: variance 5 %, Tz 5 %; asked for here: Hs 3 %.
  for (const ClosedForm& variance : rows_of_spectra()) {
    if (variance.quantity != "variance") continue;
    const std::string waves = spectrum_of(variance) + (variance.at("Hs") > 1 ? ", spreading: 10" : "");
    const Record record = record_of(waves, variance.at("Tp"), 40);
    const double hs_m = variance.at("Hs");
    EXPECT_NEAR(4 * std::sqrt(record.variance_m2), hs_m, 0.03 * hs_m) << waves;
    expect_closed_form(record.variance_m2, variance);
    expect_closed_form(record.tz_s, variance.name, variance.parameters, "Tz");
    EXPECT_NEAR(record.mean_m, 0, 0.02 * hs_m) << waves;
  }
}

TEST(IrregularWaves, SpreadAboutTheirDirection) {
  // The mean of e^(i angle) over cos^2s of the half angle is s / (s + 1) (Longuet-Higgins); 1000 waves draw it with a
  // standard error below 0.02.
  WavesConfig config;
  config.components = 1000;
  config.spreading = 4;
  config.direction_rad = 1;
  sim::Random random(5, "test");
  random.begin_step(0);
  double along = 0, across = 0;
  for (const auto& wave : sim::make_waves(config, g, random)) {
    along += std::cos(wave.direction_rad - 1) / 1000;
    across += std::sin(wave.direction_rad - 1) / 1000;
  }
  EXPECT_NEAR(along, 0.8, 0.05);
  EXPECT_NEAR(across, 0, 0.06);
}

TEST(IrregularWaves, AreTheSumOfTheirComponents) {
  // The vectorized polynomials against the C library, for places and times far off.  1e-7 m: 200 angles of 1e6 rad are
  // known to 1e-10 each.
  for (const std::string depth : {"", ", water_depth_m: 15"}) {
    const auto config = test_support::read_medium(
        "{water: {surface_m: 2}, waves: {hs_m: 2, tp_s: 7, spreading: 5, components: 203" + depth + "}}");
    sim::Medium medium(config, g, 9);
    sim::Waves waves(*config.waves, g, 9);
    const double t = 86400, x = 5000, y = -3000;
    medium.advance_to(sim::from_seconds(t));
    for (const double z : {3.0, 2.0, 0.0, -5.0, -12.0}) {
      double elevation = 0;
      for (const auto& wave : waves.components())
        elevation += wave.amplitude_m *
                     std::cos(wave.k_radpm * (x * std::cos(wave.direction_rad) + y * std::sin(wave.direction_rad)) -
                              wave.omega_radps * t + wave.phase_rad);
      Vector3d v_W = Vector3d::Zero(), a_W = Vector3d::Zero();
      for (const auto& wave : waves.components()) {
        const double k = wave.k_radpm, w = wave.omega_radps;
        const double east = std::cos(wave.direction_rad), north = std::sin(wave.direction_rad);
        const double angle = k * (x * east + y * north) - w * t + wave.phase_rad;
        double below = std::max(0.0, elevation - (z - 2)), level = std::exp(-k * below), upward = level;
        if (!depth.empty()) {
          below *= 15 / (15 + elevation);
          level = std::cosh(k * (15 - below)) / std::sinh(k * 15);
          upward = std::sinh(k * (15 - below)) / std::sinh(k * 15);
        }
        const double c = std::cos(angle), s = std::sin(angle), speed = wave.amplitude_m * w;
        v_W += speed * Vector3d(level * c * east, level * c * north, upward * s);
        a_W += speed * w * Vector3d(level * s * east, level * s * north, -upward * c);
      }
      const sim::LocalWater water = medium.water_at({x, y, z});
      EXPECT_NEAR(water.surface_m, 2 + elevation, 1e-7);
      EXPECT_LT((water.velocity_W - v_W).norm(), 1e-7) << z;
      EXPECT_LT((water.acceleration_W - a_W).norm(), 1e-7) << z;
    }
  }
}

TEST(IrregularWaves, SaySurfaceTheSameWhoeverAsks) {
  sim::Medium medium = make_medium("{water: {}, waves: {hs_m: 1, tp_s: 6, spreading: 4, components: 101}}");
  medium.advance_to(Time{12345678});
  for (int i = 0; i < 50; ++i) {
    const double x = 13.7 * i, y = -3.1 * i * i;
    EXPECT_EQ(medium.surface_m(x, y), medium.water_at({x, y, -1}).surface_m);
    EXPECT_EQ(medium.surface_m(x, y), medium.surface_m(x, y, Time{12345678}));
  }
}

TEST(IrregularWaves, SeedChoosesTheSea) {
  const std::string yaml = "{water: {}, waves: {sea_state: 3}}";
  EXPECT_EQ(make_medium(yaml, 4).surface_m(1, 2), make_medium(yaml, 4).surface_m(1, 2));
  EXPECT_NE(make_medium(yaml, 4).surface_m(1, 2), make_medium(yaml, 5).surface_m(1, 2));
  EXPECT_EQ(test_support::read_medium(yaml).waves->hs_m, 0.88);
  EXPECT_EQ(test_support::read_medium(yaml).waves->tp_s, 7.5);
  EXPECT_EQ(make_medium("{water: {surface_m: 2}, waves: {sea_state: 0}}").surface_m(1, 2), 2);
}

}  // namespace
