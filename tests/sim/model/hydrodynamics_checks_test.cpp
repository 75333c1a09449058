// SPDX-License-Identifier: BSD-3-Clause
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "sim/config/message_text.hpp"
#include "sim/hydrodynamics/coefficient_model.hpp"
#include "sim/model/hydrodynamics_config.hpp"
#include "sim/vehicle/vehicle.hpp"
#include "tests/devices/world_fixture.hpp"
#include "tests/sim/hydrodynamics/marine_worlds.hpp"

namespace {

using testing::HasSubstr;

std::string error_of(const std::string& more, const std::string& step_s = "0.001") {
  return test::error_of_world(test::marine_world("{frame: frd, mass_kg: 10" + more + "}", "{water: {}}", "", step_s));
}

const std::string inertia = ", inertia_kgm2: [1, 1, 1]";

TEST(HydrodynamicsChecks, NegativeAddedMassIsADerivative) {
  EXPECT_THAT(error_of(inertia + ", added_mass: [-0.93, 35.5, 35.5, 0, 0, 0]"),
              HasSubstr("the added mass in surge must be >= 0, got -0.93: papers print derivatives such as X_udot"));
  EXPECT_THAT(error_of(inertia + ", derivatives: {Y_vdot: 35.5}"),
              HasSubstr("the added mass in sway must be >= 0, got -35.5"));
}

TEST(HydrodynamicsChecks, AddedMassIsSymmetric) {
  EXPECT_THAT(error_of(inertia + ", derivatives: {Y_vdot: -35.5, N_rdot: -5, Y_rdot: 1.93, N_vdot: -1.93}"),
              HasSubstr("the added mass must be symmetric, got -1.93 between sway and yaw and 1.93 the other way"));
}

TEST(HydrodynamicsChecks, AddedMassIsNotNegativeInAnyDirection) {
  // The block [[4, 6], [6, 4]] has the eigenvalues 10 and -2.  With 20 kg of body, all of it would be positive.
  EXPECT_THAT(
      error_of(inertia + ", derivatives: {Y_vdot: -4, N_rdot: -4, Y_rdot: -6, N_vdot: -6}"),
      HasSubstr(
          "the added-mass matrix is not positive semi-definite, eigenvalue -2: its off-diagonal terms are too large"));
  // A flat plate off its origin: 4 * 9 = 6 * 6, an eigenvalue of 0.
  EXPECT_EQ(error_of(inertia + ", derivatives: {Y_vdot: -4, N_rdot: -9, Y_rdot: -6, N_vdot: -6}"), "");
}

TEST(HydrodynamicsChecks, DampingBrakesEveryMotion) {
  const auto couplings = [](double one, double other) {
    return inertia + ", linear_damping: [1, 0, 0, 0, 0, 0,  0, 2, 0, 0, 0, " + sim::number_text(one) +
           ",  0, 0, 3, 0, 0, 0,  0, 0, 0, 1, 0, 0,  0, 0, 0, 0, 1, 0,  0, " + sim::number_text(other) +
           ", 0, 0, 0, 2]";
  };
  // Half of 4 + 3 beside 2 and 2: 2 - 3.5.
  EXPECT_THAT(
      error_of(couplings(4, 3)),
      HasSubstr(
          "the symmetric part of 'linear_damping' has a negative eigenvalue, -1.5: it would accelerate some motions"));
  // What has opposite signs takes no energy and brings none, however large.
  EXPECT_EQ(error_of(couplings(40, -40)), "");
}

TEST(HydrodynamicsChecks, AWaterlineHoldsAgainstHeaveAndPitchAtOnce) {
  const auto waterline = [](const std::string& coupling) {
    return inertia + ", waterline: {heave_Npm: 100, roll_Nmprad: 50, pitch_Nmprad: 25, heave_pitch_N: " + coupling +
           "}";
  };
  EXPECT_EQ(error_of(waterline("-49")), "");
  EXPECT_THAT(error_of(waterline("50")),
              HasSubstr("'heave_pitch_N' squared must stay below 'heave_Npm' times 'pitch_Nmprad', got 2500 and 2500"));
}

TEST(HydrodynamicsChecks, InertiaIsPositiveDefinite) {
  EXPECT_THAT(error_of(", inertia_kgm2: [1, 1, -1]"),
              HasSubstr("must be positive definite, its smallest eigenvalue is -1"));
  // 10 kg half a meter off already have 2.5 kg m^2 about the origin.
  EXPECT_THAT(error_of(inertia + ", inertia_about: origin, center_of_mass_m: [0, 0, 0.5]"),
              HasSubstr("its smallest eigenvalue is -1.5; see 'inertia_about'"));
  EXPECT_THAT(error_of(", inertia_kgm2: [1, 0.1, 0, 0, 1, 0, 0, 0, 1]"), HasSubstr("'inertia_kgm2' must be symmetric"));
}

TEST(HydrodynamicsChecks, DampingBrakes) {
  EXPECT_THAT(
      error_of(inertia + ", linear_damping: [-1, 2, 3, 1, 1, 1]"),
      HasSubstr("'linear_damping' must be >= 0 in surge, got -1: a negative value would accelerate the vehicle"));
  EXPECT_THAT(error_of(inertia + ", quadratic_damping: [1, 2, 3, 1, -4, 1]"),
              HasSubstr("'quadratic_damping' must be >= 0 in pitch"));
  EXPECT_THAT(error_of(inertia + ", derivatives: {X_uu: 1.62}"),
              HasSubstr("'X_uu' must be <= 0, got 1.62: positive, it would push the vehicle on"));
  EXPECT_THAT(error_of(inertia + ", derivatives: {N_r: 1.62}"), HasSubstr("'N_r' must be <= 0"));
}

TEST(HydrodynamicsChecks, AHullThatTurnsOverIsDoubted) {
  const std::string rest = ", mass_kg: 10, inertia_kgm2: [1, 1, 1], center_of_mass_m: [0, 0, 0.02]}";
  EXPECT_THAT(sim::doubts_about(test::config_of("{frame: frd" + rest)), testing::IsEmpty());
  EXPECT_THAT(sim::doubts_about(test::config_of("{frame: flu" + rest)),
              testing::ElementsAre(HasSubstr("its center of mass lies 0.02 m above its center of buoyancy")));
}

TEST(HydrodynamicsChecks, AnInertiaThatNoSolidHasIsDoubted) {
  EXPECT_THAT(sim::doubts_about(test::config_of("{mass_kg: 10, inertia_kgm2: [0.2, 4, 40]}")),
              testing::ElementsAre(HasSubstr("no solid has its principal moments of inertia, 0.2, 4 and 40 kg m^2")));
}

TEST(HydrodynamicsChecks, AnInertiaFarBelowThatOfASphereIsDoubted) {
  // Of 1000 kg and 1 m^3: r = 0.62035 m, 2/5 m r^2 = 153.934 kg m^2.
  const auto doubts = [](const std::string& kgm2) {
    return sim::doubts_about(test::config_of("{mass_kg: 1000, inertia_kgm2: " + kgm2 + "}"));
  };
  EXPECT_THAT(doubts("[15.4, 15.4, 15.4]"), testing::IsEmpty());
  EXPECT_THAT(doubts("[15.3, 15.3, 15.3]"),
              testing::ElementsAre("the mean of its moments of inertia is 15.3 kg m^2, less than a tenth of that of a "
                                   "sphere of its mass and volume, 153.934"));
}

TEST(HydrodynamicsChecks, TheRateOfDragGrowsWithTheSpeed) {
  const sim::CoefficientModel model(
      test::config_of("{mass_kg: 10, inertia_kgm2: [1, 1, 1], linear_damping: [20, 0, 0, 0, 0, 0], "
                      "derivatives: {X_uu: -100}}"),
      9.81);
  sim::Vector6d nu = sim::Vector6d::Zero();
  EXPECT_DOUBLE_EQ(model.fastest_rate(sim::Six(nu)), 2);
  nu[0] = -21;
  EXPECT_DOUBLE_EQ(model.fastest_rate(sim::Six(nu)), 2 + 100.0 * 21 / 10);
}

TEST(HydrodynamicsChecks, DragTooStiffForTheStepBrakesAndDoesNotThrowTheBodyAbout) {
  test::TestWorld test(test::marine_world("{mass_kg: 10, inertia_kgm2: [1, 1, 1], derivatives: {X_uu: -100}}",
                                          "{water: {}}", "", "0.01"));
  sim::Body& body = test.world.vehicles()[0]->body("hull");
  body.set_velocity_W({1000, 0, 0}, sim::Vector3d::Zero());
  double before = 1000;
  for (int i = 0; i < 100; ++i) {
    test.world.step();
    const double speed = body.v_WB_W().x();
    ASSERT_GT(speed, 0);
    ASSERT_LT(speed, before);
    before = speed;
  }
  // Backward Euler halves a speed far above, and is of first order below: 1/u grows by 10 in a second.
  EXPECT_NEAR(before, 0.1, 0.02);
}

TEST(HydrodynamicsChecks, ASpinTooFastForTheStepGainsNoEnergy) {
  test::TestWorld test(test::marine_world("{mass_kg: 10, inertia_kgm2: [1, 2, 4], added_mass: [1, 8, 8, 0.1, 2, 2]}",
                                          "{water: {}}", "", "0.05"));
  sim::Body& body = test.world.vehicles()[0]->body("hull");
  body.set_velocity_W({1, 2, 0}, {20, 30, 10});
  double before = body.w_WB_W().norm();
  for (int i = 0; i < 200; ++i) test.world.step();
  EXPECT_LT(body.w_WB_W().norm(), before);
  EXPECT_LT(body.v_WB_W().norm(), 10);
}

}  // namespace
