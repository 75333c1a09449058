// SPDX-License-Identifier: BSD-3-Clause
#include "sim/medium/stability.hpp"

#include <gmock/gmock.h>

#include <algorithm>

#include "sim/medium/sea_water.hpp"
#include "sim/world_file/load_world.hpp"
#include "tests/sim/medium/log_capture.hpp"
#include "tests/sim/medium/medium_worlds.hpp"

namespace {

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
