// SPDX-License-Identifier: BSD-3-Clause
#include "motion/analysis/perturbed_world.hpp"

#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>

#include "devices/motion/servo_bank.hpp"
#include "sim/bus/in_process_bus.hpp"
#include "sim/world/world.hpp"
#include "sim/world_file/load_world.hpp"
#include "tests/project_paths.hpp"

namespace {

sim::WorldConfig studio() {
  return sim::load_world(test_support::source_path("worlds/ers7_studio.yaml")).config;
}

double mass_kg(const sim::WorldConfig& config) {
  sim::InProcessBus bus;
  const sim::World world(config, bus);
  double mass_kg = 0;
  for (const auto& [name, body] : world.vehicles().front()->bodies()) mass_kg += body->mass_kg();
  return mass_kg;
}

TEST(PerturbedWorld, ChangesWhatThePerturbationSays) {
  const sim::WorldConfig world = studio();
  motion::Perturbation perturbation;
  perturbation.friction = 0.45;
  perturbation.mass = 1.1;
  perturbation.effort = 0.5;
  perturbation.lag_s = 0.015;
  perturbation.half_step = true;
  const sim::WorldConfig changed = motion::perturbed(world, "dog", perturbation);
  EXPECT_DOUBLE_EQ(changed.physics.step_s, 0.001);
  ASSERT_EQ(changed.contacts.size(), world.contacts.size());
  EXPECT_DOUBLE_EQ(changed.contacts.front().friction, 0.45);
  EXPECT_NEAR(mass_kg(changed) / mass_kg(world), 1.1, 1e-9);
  // 1.2 N m and 40 /s of the file: 1 / (1/40 + 0.015) = 25.
  const auto servos = devices::servos_of(*changed.vehicles.front().config);
  const auto knee = std::find_if(servos.begin(), servos.end(), [](const auto& one) { return one.device == "lf_knee"; });
  EXPECT_DOUBLE_EQ(knee->params->max_effort, 0.6);
  EXPECT_NEAR(knee->params->kp, 25, 1e-9);
}

TEST(PerturbedWorld, ScalesTheTorqueSpeedLineToo) {
  sim::LoadOptions options;
  options.sets = {"vehicles.dog.devices.lf_knee.stall_effort=0.8", "vehicles.dog.devices.lf_knee.no_load_velocity=6"};
  const sim::WorldConfig world = sim::load_world(test_support::source_path("worlds/ers7_studio.yaml"), options).config;
  motion::Perturbation perturbation;
  perturbation.effort = 0.5;
  const sim::WorldConfig changed = motion::perturbed(world, "dog", perturbation);
  const auto servos = devices::servos_of(*changed.vehicles.front().config);
  const auto knee = std::find_if(servos.begin(), servos.end(), [](const auto& one) { return one.device == "lf_knee"; });
  EXPECT_DOUBLE_EQ(knee->params->gear.line.stall_effort.value_or(0), 0.4);
}

TEST(PerturbedWorld, BumpsReplaceTheGround) {
  motion::Perturbation perturbation;
  perturbation.ground_m = 0.003;
  const sim::WorldConfig changed = motion::perturbed(studio(), "dog", perturbation);
  EXPECT_EQ(changed.objects.front().bodies.front().parts.front().shape, sim::PartShape::terrain);
  sim::InProcessBus bus;
  sim::World world(changed, bus);
  // The dog stands on it: after half a second no lower than the bumps are deep.
  const double start_m = world.vehicles().front()->X_WV().translation().z();
  for (int i = 0; i < 250; ++i) world.step();
  const double sunk_m = start_m - world.vehicles().front()->X_WV().translation().z();
  EXPECT_GT(sunk_m, 0);
  EXPECT_LT(sunk_m, 0.008);
}

TEST(PerturbedWorld, AWorldForWalksHasOnlyWhatMovesTheVehicle) {
  const sim::WorldConfig reduced = motion::world_for_walks(studio());
  // 20 servos, the group and the player.
  EXPECT_EQ(reduced.vehicles.front().config->devices.size(), 22u);
}

TEST(PerturbedWorld, DrawsAreSpreadOverTheRangesAndDependOnTheSeed) {
  const auto drawn = motion::drawn_perturbations(8, 3, "test");
  ASSERT_EQ(drawn.size(), 8u);
  // One in each eighth of each range.
  std::vector<int> friction, mass;
  for (const motion::Perturbation& one : drawn) {
    friction.push_back(static_cast<int>((*one.friction - 0.4) / 0.6 * 8));
    mass.push_back(static_cast<int>((one.mass - 0.9) / 0.2 * 8));
    EXPECT_TRUE(one.effort >= 0.6 && one.effort <= 1.2);
    EXPECT_TRUE(one.lag_s >= 0 && one.lag_s <= 0.016);
  }
  EXPECT_THAT(friction, testing::UnorderedElementsAre(0, 1, 2, 3, 4, 5, 6, 7));
  EXPECT_THAT(mass, testing::UnorderedElementsAre(0, 1, 2, 3, 4, 5, 6, 7));
  EXPECT_EQ(std::count_if(drawn.begin(), drawn.end(), [](const auto& one) { return one.half_step; }), 2);
  EXPECT_EQ(std::count_if(drawn.begin(), drawn.end(), [](const auto& one) { return one.ground_m > 0; }), 4);
  EXPECT_EQ(*motion::drawn_perturbations(8, 3, "test")[5].friction, *drawn[5].friction);
  EXPECT_NE(*motion::drawn_perturbations(8, 4, "test")[5].friction, *drawn[5].friction);
}

TEST(PerturbedWorld, AVehicleWithoutAPlayerIsRefused) {
  const sim::WorldConfig world = studio();
  EXPECT_EQ(motion::walking_vehicle(world, ""), "dog");
  try {
    motion::walking_vehicle(world, "cat");
    FAIL();
  } catch (const sim::ConfigError& error) {
    EXPECT_EQ(error.what(), world.file + ": there is no vehicle 'cat' with a motion_player");
  }
}

}  // namespace
