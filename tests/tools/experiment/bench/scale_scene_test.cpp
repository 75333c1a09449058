// SPDX-License-Identifier: BSD-3-Clause
#include "tools/experiment/bench/scale_scene.hpp"

#include <gtest/gtest.h>

namespace {

double distance_driven_m(const std::vector<sim::Vector3d>& from, const tools::ScaleScene& scene) {
  double sum_m = 0;
  for (std::size_t i = 0; i < from.size(); ++i)
    sum_m += (scene.world().vehicles()[i]->X_WV().translation() - from[i]).norm();
  return sum_m / static_cast<double>(from.size());
}

std::vector<sim::Vector3d> places(const tools::ScaleScene& scene) {
  std::vector<sim::Vector3d> all;
  for (const auto& vehicle : scene.world().vehicles()) all.push_back(vehicle->X_WV().translation());
  return all;
}

TEST(ScaleScene, CrowdsStayInOnePieceAndOnTheGround) {
  tools::ScaleScene scene(50);
  scene.run_for(15);  // time to meet
  EXPECT_GT(scene.world().physics().quick_steps(), 0) << "nobody met: the test shows nothing";
  for (const auto& vehicle : scene.world().vehicles()) {
    const sim::Pose X_BW = vehicle->base().X_WB().inverse();
    // The wheels turn about their centres, so a centre shows what is wrong with the joint.  The solver of crowds is
    // iterative (10 rounds here): robots of 20 kg that push bend the joints by up to 1 cm for a moment; a joint that
    // was lost would be off by more.
    const sim::Vector3d left = X_BW * vehicle->body("left_wheel").X_WB().translation();
    const sim::Vector3d right = X_BW * vehicle->body("right_wheel").X_WB().translation();
    EXPECT_NEAR((left - sim::Vector3d(0.08, 0.23, 0)).norm(), 0, 0.01) << vehicle->name();
    EXPECT_NEAR((right - sim::Vector3d(0.08, -0.23, 0)).norm(), 0, 0.01) << vehicle->name();
    // A pile-up may lift a wheel, not a robot: 5 cm is half a wheel's radius.
    EXPECT_NEAR(vehicle->X_WV().translation().z(), 0, 0.05) << vehicle->name();
  }
}

TEST(ScaleScene, CrowdsGoAsFarAsWithTheExactSolver) {
  const auto driven_m = [](const std::vector<std::string>& sets) {
    tools::ScaleScene scene(50, sets);
    const auto begin = places(scene);
    scene.run_for(10);
    return distance_driven_m(begin, scene);
  };
  // The runs are chaotic; the mean over 50 robots is steady to some 10 %.
  const double exact_m = driven_m({"physics.solver=step"});
  EXPECT_NEAR(driven_m({}), exact_m, 0.25 * exact_m);
}

}  // namespace
