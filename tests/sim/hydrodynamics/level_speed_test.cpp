// SPDX-License-Identifier: BSD-3-Clause
#include "sim/hydrodynamics/level_speed.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/sim/hydrodynamics/marine_worlds.hpp"

namespace {

using sim::LevelMotion;

/// 10 kg in 10 m/s2, with 100 N of buoyancy 2 cm above its center: 2 N m per rad right it.
sim::CoefficientModel level_model(const std::string& more) {
  return {test::config_of("{frame: frd, mass_kg: 10, inertia_kgm2: [1, 1, 1], center_of_buoyancy_m: [0, 0, -0.02], "
                          "linear_damping: [5, 6, 7, 0, 0, 0], quadratic_damping: [30, 40, 50, 0, 0, 0]" +
                          more + "}"),
          10};
}

TEST(LevelSpeed, IsWhereTheMunkMomentOutweighsTheWeight) {
  const sim::CoefficientModel flat = level_model(", added_mass: [4, 8, 12, 0.1, 0.1, 0.1]");
  // The moment is (12 - 4) V^2 by pitch ahead and (12 - 8) V^2 by roll to the side; by the tilt of 1e-3 to 1e-6.
  EXPECT_NEAR(sim::righting_Nmprad(flat, LevelMotion::ahead, 0.4), 2 - 8 * 0.16, 1e-5);
  EXPECT_NEAR(sim::tipping_mps(flat, LevelMotion::ahead), std::sqrt(2.0 / 8), 1e-5);
  EXPECT_NEAR(sim::tipping_mps(flat, LevelMotion::sideways), std::sqrt(2.0 / 4), 1e-5);
  EXPECT_NEAR(sim::tipping_mps(flat, LevelMotion::ahead, 16), std::sqrt(18.0 / 8), 1e-5);
  EXPECT_NEAR(sim::level_drag_N(flat, LevelMotion::ahead, 2), 5 * 2 + 30 * 4, 1e-9);
  EXPECT_NEAR(sim::level_drag_N(flat, LevelMotion::sideways, 2), 6 * 2 + 40 * 4, 1e-9);
}

TEST(LevelSpeed, IsInfiniteForABodyThatTheMunkMomentRights) {
  EXPECT_TRUE(std::isinf(sim::tipping_mps(level_model(", added_mass: [12, 8, 4, 0.1, 0.1, 0.1]"), LevelMotion::ahead)));
  EXPECT_TRUE(std::isinf(sim::tipping_mps(
      level_model(", added_mass: [4, 8, 12, 0.1, 0.1, 0.1], quirks: {added_mass_coriolis: without_munk}"),
      LevelMotion::ahead)));
  // Top-heavy: at no speed.
  EXPECT_EQ(sim::tipping_mps(level_model(", added_mass: [4, 8, 12, 0.1, 0.1, 0.1], center_of_mass_m: [0, 0, -0.05]"),
                             LevelMotion::ahead),
            0);
}

}  // namespace
