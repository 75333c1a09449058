// SPDX-License-Identifier: BSD-3-Clause
#include "sim/medium/sea_water.hpp"

#include <gmock/gmock.h>

#include "sim/medium/stability.hpp"
#include "sim/world_file/load_world.hpp"
#include "tests/fidelity/closed_forms.hpp"

namespace {

using test::closed_forms_of;
using test::expect_closed_form;

TEST(SeaWater, SoundIsAsFastAsTheEquationsSay) {
  for (const auto& form : closed_forms_of("sound_speed_mackenzie"))
    expect_closed_form(sim::mackenzie_mps(form.at("T"), form.at("S"), form.at("depth")), form);
  for (const auto& form : closed_forms_of("sound_speed_medwin"))
    expect_closed_form(sim::medwin_mps(form.at("T"), form.at("S"), form.at("depth")), form);
  for (const auto& form : closed_forms_of("sound_speed_unesco_chen_millero"))
    expect_closed_form(sim::chen_millero_mps(form.at("T68"), form.at("S"), form.at("p_dbar")), form);
}

TEST(SeaWater, DensityHasTheCheckValuesOfUnesco) {
  // Unesco technical papers in marine science 36 (1981), check values of the equation, to their last digit.
  EXPECT_NEAR(sim::eos80_kgpm3(5, 0, 0), 999.96675, 5e-6);
  EXPECT_NEAR(sim::eos80_kgpm3(5, 35, 0), 1027.67547, 5e-6);
  EXPECT_NEAR(sim::eos80_kgpm3(5, 0, 10000), 1044.12802, 5e-6);
  EXPECT_NEAR(sim::eos80_kgpm3(25, 35, 10000), 1062.53817, 5e-6);
}

}  // namespace
