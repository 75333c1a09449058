// SPDX-License-Identifier: BSD-3-Clause
#include <cmath>
#include <numbers>

#include "tests/project_paths.hpp"
#include "tests/sim/hydrodynamics/floating_worlds.hpp"

// Floating bodies in regular waves.

namespace {

using sim::Body;
using sim::Vector3d;
using test::body_of;
using test::TestWorld;

std::string in_waves(const std::string& wave, const std::string& object, double step_s = 0.01) {
  return "shoal: 1\nphysics: {step_s: " + sim::number_text(step_s) +
         ", gravity_mps2: 9.80665}\nmedium: {water: {density_kgpm3: 1025}, waves: {type: regular, " + wave +
         "}}\nobjects:\n  - {name: it, " + object + "}\n";
}

/// The first harmonic of what `value` gives, over some periods: amplitude and phase of a cosine of the time.
struct Harmonic {
  double amplitude = 0, phase_rad = 0;
};
template <typename Value>
Harmonic harmonic_of(TestWorld& test, double period_s, int periods, const Value& value) {
  const double omega = 2 * std::numbers::pi / period_s;
  double cosine = 0, sine = 0;
  const int steps = static_cast<int>(std::round(periods * period_s / sim::to_seconds(test.world.step_time())));
  for (int i = 0; i < steps; ++i) {
    test.world.step();
    const double t = sim::to_seconds(test.world.now()), y = value();
    cosine += y * std::cos(omega * t) * 2 / steps;
    sine += y * std::sin(omega * t) * 2 / steps;
  }
  return {std::hypot(cosine, sine), std::atan2(-sine, cosine)};
}

TEST(InWaves, ABoxRidesALongWave) {
  // 8 s: the wave is 100 m long, the box swings in 0.9 s by itself.  1 / (1 - (0.9/8)^2) is 1.3 % more than the wave.
  const char* box = "position_m: [0, 0, 0.55], parts: [{shape: box, size_m: [2, 1, 0.5], density_kgpm3: 410}]";
  TestWorld test(in_waves("height_m: 1, period_s: 8", box));
  test.run_for(80);
  const Body& body = body_of(test);
  double worst = 0;
  const Harmonic heave = harmonic_of(test, 8, 5, [&] {
    const Vector3d p_W = body.X_WB().translation();
    worst = std::max(worst, std::abs(p_W.z() - 0.05 - test.world.medium().surface_m(p_W.x(), p_W.y())));
    return p_W.z();
  });
  EXPECT_NEAR(heave.amplitude, 0.5, 0.02);
  EXPECT_LT(worst, 0.03) << "it stays where the surface is, crest and trough";
}

TEST(InWaves, ABoxTiltsWithTheSlopeOfALongWave) {
  const char* box = "position_m: [0, 0, 0.55], parts: [{shape: box, size_m: [2, 1, 0.5], density_kgpm3: 410}]";
  TestWorld test(in_waves("height_m: 1, period_s: 8", box));
  test.run_for(80);
  const Body& body = body_of(test);
  const Harmonic pitch = harmonic_of(test, 8, 5, [&] { return sim::rpy_from_rotation(body.X_WB().linear()).y(); });
  const double k = 4 * std::numbers::pi * std::numbers::pi / (64 * 9.80665);
  EXPECT_NEAR(pitch.amplitude, 0.5 * k, 0.1 * 0.5 * k);  // slope of the wave: k a
}

TEST(InWaves, AWaveShorterThanABoatHardlyLiftsIt) {
  // 1.132 s: 2 m long, as the boat: as much of it is lifted as goes down.
  const char* boat = "position_m: [0, 0, 0.05], parts: [{shape: box, size_m: [2, 1, 0.5], density_kgpm3: 410}]";
  TestWorld test(in_waves("height_m: 0.1, period_s: 1.132", boat));
  test.run_for(30);
  const Body& body = body_of(test);
  const Harmonic heave = harmonic_of(test, 1.132, 20, [&] { return body.X_WB().translation().z(); });
  EXPECT_LT(heave.amplitude, 0.25 * 0.05);
}

TEST(InWaves, AMeshOfABoxMovesAsTheBox) {
  const auto place_after = [](const std::string& part) {
    TestWorld test(in_waves("height_m: 0.3, period_s: 2", "position_m: [0, 0, 0.2], parts: [" + part + "]"));
    test.run_for(10);
    return body_of(test).X_WB();
  };
  const std::string mesh = test_support::source_path("tests/sim/hydrodynamics/box_1m.obj");
  const sim::Pose box = place_after("{shape: box, size_m: [2, 2, 2], density_kgpm3: 500}");
  const sim::Pose same =
      place_after("{shape: mesh, mesh: " + mesh + ", scale: 2, density_kgpm3: 500, drag_coefficient: [1.05]}");
  // Masses and cuts are sums in another order; their last bits grow with the swings.
  EXPECT_LT((box.translation() - same.translation()).norm(), 1e-6);
}

TEST(InWaves, ASubmergedBodyGoesWithTheWater) {
  // A neutral ball of added mass is carried along the orbit of the water: (m + a) dv/dt = (rho V + a) Dv/dt.
  TestWorld test(in_waves("height_m: 1, period_s: 6",
                          "position_m: [0, 0, -3], parts: [{shape: sphere, radius_m: 0.2, density_kgpm3: 1025, "
                          "added_mass_coefficient: 0.5}]"));
  test.run_for(60);
  const Body& body = body_of(test);
  double worst = 0;
  for (int i = 0; i < 600; ++i) {
    test.world.step();
    worst = std::max(worst, (body.v_WB_W() - test.world.medium().water_velocity_W(body.X_WB().translation())).norm());
  }
  EXPECT_LT(worst, 0.05);  // orbital speed there: 0.38 m/s
}

TEST(InWaves, TheStepsAreSmall) {
  // The step is of second order; that the boat wets by pieces of panels disturbs it.
  const auto place_after = [](double step_s) -> Vector3d {
    TestWorld test(in_waves("height_m: 0.5, period_s: 4",
                            "position_m: [0, 0, 0.3], parts: [{shape: capsule, radius_m: 0.3, length_m: 2, rpy_deg: "
                            "[0, 90, 0], density_kgpm3: 500}]",
                            step_s));
    test.run_for(10);
    return body_of(test).X_WB().translation();
  };
  const Vector3d coarse = place_after(0.02), middle = place_after(0.01), fine = place_after(0.005);
  EXPECT_LT((coarse - fine).norm(), 0.1);
  EXPECT_NEAR((coarse - middle).norm() / (middle - fine).norm(), 4, 1);
}

}  // namespace
