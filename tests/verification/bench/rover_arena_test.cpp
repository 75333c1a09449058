// SPDX-License-Identifier: BSD-3-Clause
#include "verification/bench/rover_arena.hpp"

#include <gtest/gtest.h>

#include <algorithm>

#include "shoal/message_codec.hpp"
#include "shoal/planar_lidar_t.hpp"
#include "verification/bench/bench_run.hpp"

namespace {

double distance_driven_m(const std::vector<sim::Vector3d>& from, const verification::BenchRun& scene) {
  double sum_m = 0;
  for (std::size_t i = 0; i < from.size(); ++i)
    sum_m += (scene.world().vehicles()[i]->X_WV().translation() - from[i]).norm();
  return sum_m / static_cast<double>(from.size());
}

std::vector<sim::Vector3d> places(const verification::BenchRun& scene) {
  std::vector<sim::Vector3d> all;
  for (const auto& vehicle : scene.world().vehicles()) all.push_back(vehicle->X_WV().translation());
  return all;
}

TEST(RoverArena, CrowdsStayInOnePieceAndOnTheGround) {
  verification::BenchRun scene(verification::scale_scene(), 50);
  scene.run_for(8);  // time to meet
  double max_bend_m = 0;
  for (int i = 0; i < 70; ++i) {
    scene.run_for(0.1);
    for (const auto& vehicle : scene.world().vehicles()) {
      // The wheels turn about their centers, so a center shows what is wrong with the joint.
      const sim::Pose X_BW = vehicle->base().X_WB().inverse();
      const sim::Vector3d left = X_BW * vehicle->body("left_wheel").X_WB().translation();
      const sim::Vector3d right = X_BW * vehicle->body("right_wheel").X_WB().translation();
      max_bend_m = std::max(
          {max_bend_m, (left - sim::Vector3d(0.08, 0.23, 0)).norm(), (right - sim::Vector3d(0.08, -0.23, 0)).norm()});
      // A pile-up may lift a wheel, not a robot: 5 cm is half a wheel's radius.
      EXPECT_NEAR(vehicle->X_WV().translation().z(), 0, 0.05) << vehicle->name();
    }
  }
  EXPECT_GT(scene.world().physics().quick_steps(), 0) << "nobody met: the test shows nothing";
  // Ten rounds of iteration alone bend them by up to 12 mm where robots of 20 kg push.
  EXPECT_LT(max_bend_m, 0.001);
}

TEST(RoverArena, CrowdsGoAsFarAsWithTheExactSolver) {
  const auto driven_m = [](const std::vector<std::string>& sets) {
    verification::BenchRun scene(verification::scale_scene(), 50, sets);
    const auto begin = places(scene);
    scene.run_for(10);
    return distance_driven_m(begin, scene);
  };
  // The runs are chaotic; the mean over 50 robots is steady to some 10 %.
  const double exact_m = driven_m({"physics.solver=step"});
  EXPECT_NEAR(driven_m({}), exact_m, 0.25 * exact_m);
}

/// Returns the range of the middle beam of the rear one of two rovers, 2 m apart, one behind the other.
double middle_range_m(const verification::RoverArena& arena) {
  const sim::LoadedWorld loaded = sim::load_world_text(verification::rover_arena_text(arena, 2), "arena.yaml");
  sim::InProcessBus bus;
  sim::World world(loaded.config, bus);
  const auto scans = bus.open_mailbox("rover1.lidar", 1);
  std::optional<sim::Message> message;
  for (int i = 0; i < 20 && !message; ++i) {
    world.step();
    message = scans->take();
  }
  const auto scan = shoal::decode<shoal::planar_lidar_t>(message.value().payload, shoal::Finite::any);
  return scan.ranges.at(scan.ranges.size() / 2);
}

TEST(RoverArena, LidarsOfTheLandSceneSeeTheHullOfTheRoverAhead) {
  // Rovers at x = -1 m and 1 m; the lidar is at -0.76 m, the rear of the hull ahead at 0.75 m.  Noise: 1 cm; the wheels
  // settle by less.
  const verification::RoverArena arena{"land", "[0.24, 0, 0.04]", true};
  EXPECT_NEAR(middle_range_m(arena), 1.51, 0.06);
}

TEST(RoverArena, LidarsOfTheScaleSceneLookOverTheRoverAheadAtTheWall) {
  // The lidar is at -0.85 m, the wall at 2 m.
  const verification::RoverArena arena{"scale", "[0.15, 0, 0.15]", true};
  EXPECT_NEAR(middle_range_m(arena), 2.85, 0.06);
}

}  // namespace
