// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <cmath>

#include "sim/vehicle/vehicle.hpp"
#include "tests/devices/world_fixture.hpp"
#include "tests/sim/hydrodynamics/marine_worlds.hpp"

// What the wind does to a craft by its windage (Fossen 2011, eq. 8.23 to 8.30).

namespace {

constexpr double air_density_kgpm3 = 1.225;
constexpr double wind_mps = 10;

/// A craft of 100 kg with linear damping that lies on still water and heads east.
class WindyWorld : public test::TestWorld {
 public:
  explicit WindyWorld(const std::string& wind, const std::string& more = "height_m: 0")
      : TestWorld(test::marine_world(
            "{frame: frd, mass_kg: 100, inertia_kgm2: [20, 20, 20], "
            "linear_damping: [50, 80, 80, 40, 40, 40], waterline: {length_m: 2, beam_m: 1, "
            "heave_Npm: 5000, roll_Nmprad: 1000, pitch_Nmprad: 1000}, windage: {frontal_area_m2: 0.5, "
            "lateral_area_m2: 1.5, surge_coefficient: 0.6, sway_coefficient: 0.9, "
            "yaw_coefficient: 0.1, length_m: 2, " +
                more + "}}",
            "{water: {surface_m: -20}, wind: " + wind + "}", "", "0.01")) {}
  const sim::Body& body() const { return world.vehicles()[0]->base(); }
};

/// The speed v at which wind and water balance, 1/2 rho C A (W - v)^2 = d v: with k = rho C A / 2 and W the wind
/// v = W + d / (2 k) - sqrt((W + d / (2 k))^2 - W^2).
double drift_mps(double coefficient, double area_m2, double damping) {
  const double k = 0.5 * air_density_kgpm3 * coefficient * area_m2, b = wind_mps + damping / (2 * k);
  return b - std::sqrt(b * b - wind_mps * wind_mps);
}

TEST(Windage, ACraftDriftsAcrossTheWindAsFastAsItsDampingAllows) {
  WindyWorld test("{speed_mps: 10, direction_deg: 90}");
  test.run_for(60);  // 48 time constants of 100 kg over 80 N s/m
  EXPECT_NEAR(test.body().v_WB_W().y(), drift_mps(0.9, 1.5, 80), 1e-9);
  EXPECT_NEAR(test.body().v_WB_W().x(), 0, 1e-9);
  EXPECT_NEAR(test.body().w_WB_W().norm(), 0, 1e-9) << "from abeam nothing turns it";
}

TEST(Windage, AWindFromAsternPushesItsFrontalArea) {
  WindyWorld test("{speed_mps: 10, direction_deg: 0}");
  test.run_for(60);
  EXPECT_NEAR(test.body().v_WB_W().x(), drift_mps(0.6, 0.5, 50), 1e-9);
  EXPECT_NEAR(test.body().v_WB_W().y(), 0, 1e-9);
}

TEST(Windage, WithoutWindAndMotionNoForce) {
  WindyWorld test("{speed_mps: 0}");
  test.run_for(1);
  EXPECT_EQ(test.body().v_WB_W().norm(), 0);
  EXPECT_EQ(test.body().w_WB_W().norm(), 0);
}

TEST(Windage, WindFromAbeamOfTheBowTurnsTheBowAwayFromIt) {
  // The craft heads east.  Wind towards the west and north comes from starboard ahead: the bow goes to port.
  const double pressure_area = 0.5 * air_density_kgpm3 * wind_mps * wind_mps * 1.5;
  for (const double side : {1.0, -1.0}) {
    WindyWorld test("{speed_mps: 10, direction_deg: " + std::to_string(side * 135) + "}");
    test.world.step();
    // N = q C_N A_L L sin(2 angle), with sin(90 deg) = 1, over 20 kg m^2.
    EXPECT_NEAR(test.body().w_WB_W().z() / 0.01, side * pressure_area * 0.1 * 2 / 20, 0.01) << side;
  }
}

TEST(Windage, AnAreaOverTheOriginHeelsTheCraftToLeeward) {
  WindyWorld test("{speed_mps: 10, direction_deg: 90}", "height_m: 0.5");
  test.world.step();
  // Wind towards port: starboard comes up, about -x.  The force times 0.5 m over 20 kg m^2.
  const double force_N = 0.5 * air_density_kgpm3 * wind_mps * wind_mps * 0.9 * 1.5;
  EXPECT_NEAR(test.body().w_WB_W().x() / 0.01, -force_N * 0.5 / 20, 0.03);  // damping half-way takes 1 %
}

TEST(Windage, TheWindCountsInTheRunOfTheOtter) {
  const auto place_after = [](const std::string& wind) {
    test::TestWorld test("shoal: 1\nphysics: {step_s: 0.01}\nmedium: {water: {}" + wind +
                         "}\nvehicles: [{name: otter, file: otter_autopilot.yaml, overrides: {devices.autopilot.mode: "
                         "'off'}}]\n");
    test.run_for(60);
    return test.world.vehicles()[0]->X_WV().translation().eval();
  };
  const sim::Vector3d calm = place_after(""), windy = place_after(", wind: {speed_mps: 6, direction_deg: 0}");
  // 1/2 rho 0.7 0.2 m^2 (6 m/s)^2 = 3.1 N against 77.6 N s/m: 4 cm/s, for nearly a minute.
  EXPECT_NEAR(calm.x(), 0, 0.05);
  EXPECT_NEAR(windy.x() - calm.x(), 2.3, 0.15);
}

}  // namespace
