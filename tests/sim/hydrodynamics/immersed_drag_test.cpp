// SPDX-License-Identifier: BSD-3-Clause
#include "sim/hydrodynamics/immersed_drag.hpp"

#include <cmath>
#include <string>

#include "sim/hydrodynamics/immersed_volume.hpp"
#include "tests/fidelity/closed_forms.hpp"
#include "tests/sim/hydrodynamics/floating_worlds.hpp"
#include "tests/sim/hydrodynamics/release_fixture.hpp"

namespace {

using namespace release_fixture;
using sim::Body;
using test::body_of;
using test::expect_closed_form;
using test::floating_world;
using test::TestWorld;

double height(const Body& body) {
  return body.X_WB().translation().z();
}

TEST(Floating, AHeavySphereSinksAsFastAsDragAndAddedMassLetIt) {
  TestWorld test(floating_world(
      "[{shape: sphere, radius_m: 0.05, density_kgpm3: 2700, drag_coefficient: [0.47], added_mass_coefficient: 0.5}]",
      "[0, 0, -1]"));
  Body& body = body_of(test);
  test.world.step();
  expect_closed_form(-body.v_WB_W().z() / 0.001, "falling_sphere", "Ca=0.5", "initial_accel");
  test.run_for(0.499);
  expect_closed_form(-body.v_WB_W().z(), "falling_sphere", "t=0.5", "velocity");
  expect_closed_form(-1 - height(body), "falling_sphere", "t=0.5", "depth");
  test.run_for(5);
  expect_closed_form(-body.v_WB_W().z(), "falling_sphere", "Ca=0.5", "terminal_velocity");
}

TEST(Floating, AFastSheetIsBrakedButNotThrownBack) {
  TestWorld test(floating_world("[{shape: box, size_m: [0.01, 1, 1], density_kgpm3: 1025}]", "[0, 0, -5]", 0.05));
  Body& body = body_of(test);
  body.set_velocity_W({100, 0, 0}, {0, 20, 20});
  for (int i = 0; i < 200; ++i) {
    test.world.step();
    EXPECT_GT(body.v_WB_W().x(), -5) << i;
    EXPECT_LT(body.v_WB_W().norm(), 101) << i;
  }
  EXPECT_LT(body.v_WB_W().norm(), 5);
}

TEST(Release, ABallRisesNoFasterThanItsTerminalSpeed) {
  // Drag 1/2 rho C_d pi r^2 v^2 balances rho V g: v^2 = 8 g r / (3 C_d).
  const double terminal = std::sqrt(8 * 9.80665 * 0.3 / (3 * 0.47));
  for (const std::string more : {"", no_added_mass})
    for (const double step_s : steps_s) {
      TestWorld test(floating_world("[{" + std::string(bubble) + more + "}]", "[0, 0, -20]", step_s));
      for (int i = 0; i < 4 / step_s; ++i) {
        test.world.step();
        ASSERT_LT(body_of(test).v_WB_W().z(), terminal * 1.001) << "step " << step_s;
      }
      EXPECT_NEAR(body_of(test).v_WB_W().z(), terminal, 0.01 * terminal) << "step " << step_s;
    }
}

TEST(Release, ADragCoefficientIsANumberOrAList) {
  const auto depth_after = [](const std::string& drag) {
    TestWorld test(released("shape: sphere, radius_m: 0.2, density_kgpm3: 2000, drag_coefficient: " + drag, 0.01));
    test.run_for(2);
    return body_of(test).X_WB().translation().z();
  };
  EXPECT_EQ(depth_after("1.2"), depth_after("[1.2]"));
  EXPECT_EQ(depth_after("1.2"), depth_after("[1.2, 1.2, 1.2]"));
  EXPECT_LT(depth_after("0.6"), depth_after("1.2") - 0.1);
  EXPECT_NE(test::error_of_world(released(std::string(sphere_02) + ", drag_coefficient: -1", 0.01)), "");
  EXPECT_NE(test::error_of_world(released(std::string(sphere_02) + ", drag_coefficient: much", 0.01)), "");
}

}  // namespace
