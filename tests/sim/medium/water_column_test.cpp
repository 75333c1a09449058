// SPDX-License-Identifier: BSD-3-Clause
#include "sim/medium/water_column.hpp"

#include <gmock/gmock.h>

#include <algorithm>

#include "sim/medium/sea_water.hpp"
#include "sim/world_file/load_world.hpp"
#include "tests/fidelity/closed_forms.hpp"
#include "tests/sim/medium/log_capture.hpp"
#include "tests/sim/medium/medium_worlds.hpp"

namespace {

using sim::Vector3d;
using test::closed_forms_of;
using test::expect_closed_form;
using test_support::make_medium;

TEST(Water, PressureGrowsWithTheDepth) {
  for (const auto& form : closed_forms_of("hydrostatic_pressure")) {
    const sim::Medium medium = make_medium("water: {density_kgpm3: " + std::to_string(form.at("rho")) + "}");
    expect_closed_form(medium.pressure_Pa({3, 4, -form.at("depth")}), form);
    EXPECT_EQ(medium.pressure_Pa({3, 4, 1}), form.at("p_atm"));
  }
  const sim::Medium medium = make_medium("water: {}");
  EXPECT_EQ(medium.density_kgpm3({0, 0, -1}), 1025);
  EXPECT_EQ(medium.density_kgpm3({0, 0, 1}), 1.225);
}

TEST(Water, ProfileIsLinearBetweenItsRowsAndContinuesAtItsEnds) {
  const sim::Medium medium = make_medium(R"(
water:
  profile:
    - {depth_m: 10, temperature_C: 20, salinity_psu: 30, density_kgpm3: 1020, sound_speed_mps: 1500}
    - {depth_m: 50, temperature_C: 10, salinity_psu: 35, density_kgpm3: 1028, sound_speed_mps: 1480}
)");
  EXPECT_NEAR(medium.temperature_C({0, 0, -20}), 17.5, 1e-12);
  EXPECT_NEAR(medium.salinity_psu({0, 0, -20}), 31.25, 1e-12);
  EXPECT_NEAR(medium.density_kgpm3({0, 0, -20}), 1022, 1e-9);
  EXPECT_NEAR(medium.water_at({0, 0, -20}).density_kgpm3, 1022, 1e-9);
  EXPECT_NEAR(medium.sound_speed_mps({0, 0, -20}), 1495, 1e-9);
  EXPECT_EQ(medium.temperature_C({0, 0, -5}), 20);
  EXPECT_EQ(medium.temperature_C({0, 0, 5}), 20);
  EXPECT_EQ(medium.temperature_C({0, 0, -500}), 10);
  // The weight of the water above: 10 m of 1020, 40 m of 1024 on average, 50 m of 1028.
  EXPECT_NEAR(medium.pressure_Pa({0, 0, -100}), 101325 + 9.80665 * (10 * 1020 + 40 * 1024 + 50 * 1028), 1e-6);
  // Half way: 20 m from 1020 to 1024.
  EXPECT_NEAR(medium.pressure_Pa({0, 0, -30}), 101325 + 9.80665 * (10 * 1020 + 20 * 1022), 1e-6);
}

TEST(Water, DensityFollowsTheEquationOfState) {
  const sim::Medium medium = make_medium("water: {density: eos80, temperature_C: 5, salinity_psu: 35}");
  EXPECT_NEAR(medium.density_kgpm3({0, 0, -1e-6}), 1027.67547, 1e-4);
  // Where the pressure is 1000 dbar the density must be that of the equation there: between rows 20 m apart the error
  // of a straight line is (20 m)^2 / 8 times the second derivative, 1e-11 / m^2 of the density.
  const Vector3d deep(0, 0, -1000);
  const double dbar = (medium.pressure_Pa(deep) - 101325) / 1e4;
  EXPECT_NEAR(medium.density_kgpm3(deep), sim::eos80_kgpm3(5, 35, dbar), 1e-4);
  // dp/dz = rho g, by a central difference.
  const double slope = (medium.pressure_Pa({0, 0, -1001}) - medium.pressure_Pa({0, 0, -999})) / 2;
  EXPECT_NEAR(slope, medium.density_kgpm3(deep) * 9.80665, 1e-3);
}

TEST(Water, SoundSpeedIsThatOfTheChosenEquation) {
  const Vector3d p_W(0, 0, -500);
  const std::string water = "temperature_C: 4, salinity_psu: 34, ";
  const auto mackenzie = make_medium("water: {" + water + "sound_speed: mackenzie}");
  expect_closed_form(mackenzie.sound_speed_mps(p_W), "sound_speed_mackenzie", "T=4;S=34;depth=500", "c");
  const auto medwin = make_medium("water: {" + water + "sound_speed: medwin}");
  expect_closed_form(medwin.sound_speed_mps(p_W), "sound_speed_medwin", "T=4;S=34;depth=500", "c");
  const double dbar = 1025 * 9.80665 * 500 / 1e4;
  EXPECT_NEAR(make_medium("water: {" + water + "sound_speed: unesco}").sound_speed_mps(p_W),
              sim::chen_millero_mps(4, 34, dbar), 1e-9);
  EXPECT_EQ(make_medium("water: {sound_speed_mps: 1500}").sound_speed_mps(p_W), 1500);
  EXPECT_EQ(make_medium("water: {sound_speed_mps: 1500}").sound_speed_mps({0, 0, 2}), 340.3);
}

using test_support::make_medium;

std::optional<double> unstable_at_m(const std::string& rows, const std::string& density) {
  const sim::WaterConfig water =
      *test_support::read_medium("water: {density: " + density + ", profile: [" + rows + "]}").water;
  return sim::unstable_at_m(water, sim::WaterColumn(water, 9.80665));
}

TEST(Water, ThatIsLighterBelowThanAboveIsFound) {
  const std::string heavy = "{depth_m: 0, density_kgpm3: 1020}, {depth_m: 5, density_kgpm3: 1020}, ";
  EXPECT_EQ(unstable_at_m(heavy + "{depth_m: 20, density_kgpm3: 1021}", "constant"), std::nullopt);
  EXPECT_EQ(unstable_at_m(heavy + "{depth_m: 20, density_kgpm3: 1019}", "constant"), 20);
  // Cold over warm; salt over cold holds it.
  EXPECT_EQ(unstable_at_m("{depth_m: 0, temperature_C: 5}, {depth_m: 30, temperature_C: 15}", "eos80"), 30);
  EXPECT_EQ(
      unstable_at_m("{depth_m: 0, temperature_C: 5, salinity_psu: 30}, {depth_m: 30, temperature_C: 15}", "eos80"),
      std::nullopt);
  // Without an equation of state the temperature has no weight.
  EXPECT_EQ(unstable_at_m("{depth_m: 0, temperature_C: 5}, {depth_m: 30, temperature_C: 15}", "constant"),
            std::nullopt);
  // Water of one salinity that is mixed well from 4 to 6 km: it warms by 0.2 K as it is pressed.
  EXPECT_EQ(unstable_at_m("{depth_m: 4000, temperature_C: 1.5}, {depth_m: 6000, temperature_C: 1.7}", "eos80"),
            std::nullopt);
  EXPECT_EQ(unstable_at_m("{depth_m: 4000, temperature_C: 1.5}, {depth_m: 6000, temperature_C: 3}", "eos80"), 6000);
}

TEST(Water, ThatIsLighterBelowThanAboveIsWarnedOfOnce) {
  const test_support::LogCapture log;
  const sim::Medium medium = make_medium(
      "water: {profile: [{depth_m: 0, density_kgpm3: 1025}, {depth_m: 20, density_kgpm3: 1020}, {depth_m: 40, "
      "density_kgpm3: 1015}]}");
  const std::string text = log.text();
  EXPECT_THAT(text, testing::EndsWith("'profile' is lighter at 20 m than above it: such water would overturn\n"));
  EXPECT_EQ(std::count(text.begin(), text.end(), '\n'), 1);
}

}  // namespace
