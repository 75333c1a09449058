// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <cmath>

#include "experiment/score/scoring.hpp"
#include "sim/world/world_state.hpp"
#include "tests/devices/world_fixture.hpp"

namespace {

/// Two boxes without weight: the leader at the origin, the other at (-3, 4, 2).
struct TwoBoxes {
  explicit TwoBoxes(const std::string& metrics)
      : test(
            test::box_world("        []\n", "{step_s: 0.01, gravity_mps2: 0}",
                            "  - name: wing\n"
                            "    position_m: [-3, 4, 2]\n"
                            "    model:\n"
                            "      shoal: 1\n"
                            "      vehicle: box\n"
                            "      bodies: [{name: hull, parts: [{shape: box, size_m: [0.6, 0.4, 0.2], mass_kg: 1}]}]\n"
                            "metrics:\n" +
                                metrics)),
        scoring(test.world) {}

  void run_for(double time_s) {
    const sim::Time end = test.world.now() + sim::from_seconds(time_s);
    while (test.world.now() < end) {
      test.world.step();
      scoring.after_step();
    }
  }
  void move(const char* vehicle, const sim::Vector3d& v_W) {
    test.world.find_vehicle(vehicle)->bodies().front().second->set_velocity_W(v_W, sim::Vector3d::Zero());
  }
  double figure(const std::string& name) const { return scoring.figures().at(name); }

  test::TestWorld test;
  experiment::Scoring scoring;
};

TEST(FormationError, IsTheHorizontalDistanceFromThePlaceByTheCourseOfTheLeader) {
  TwoBoxes boxes(
      "  - {name: there, type: formation_error, vehicle: wing, leader: r1, offset_m: [4, 3]}\n"
      "  - {name: off, type: formation_error, vehicle: wing, leader: r1, offset_m: [0, 0]}\n");
  // Northwards: 4 m ahead is north, 3 m to the left is west.
  boxes.move("r1", {0, 1, 0});
  boxes.move("wing", {0, 1, 0});
  boxes.run_for(1);
  EXPECT_NEAR(boxes.figure("there.max_m"), 0, 1e-9);
  EXPECT_NEAR(boxes.figure("off.rms_m"), 5, 1e-9);  // 3-4-5; the height does not count
  EXPECT_NEAR(boxes.figure("off.final_m"), 5, 1e-9);
}

TEST(FormationError, OfALeaderThatStandsIsByItsBow) {
  TwoBoxes boxes("  - {name: bow, type: formation_error, vehicle: wing, leader: r1, offset_m: [-3, 4]}\n");
  boxes.run_for(0.1);
  EXPECT_NEAR(boxes.figure("bow.max_m"), 0, 1e-9);
}

TEST(FormationError, IsTheRootOfTheMeanSquare) {
  TwoBoxes boxes(
      "  - {name: rms, type: formation_error, vehicle: wing, leader: r1, offset_m: [-3, 4], from_s: 0.505}\n");
  // The leader moves away at 1 m/s: the error of step k is 0.01 k, from step 51 to 100.
  boxes.move("r1", {1, 0, 0});
  boxes.run_for(1);
  double sum_m2 = 0;
  for (int k = 51; k <= 100; ++k) sum_m2 += 1e-4 * k * k;
  EXPECT_NEAR(boxes.figure("rms.rms_m"), std::sqrt(sum_m2 / 50), 1e-9);
  EXPECT_NEAR(boxes.figure("rms.max_m"), 1, 1e-9);
}

TEST(Separation, IsTheSmallestDistanceOfTwoVehiclesAndItsTime) {
  TwoBoxes boxes("  - {name: apart, type: separation}\n");
  boxes.move("wing", {3, -4, 0});  // above the leader after 1 s
  boxes.run_for(2);
  EXPECT_NEAR(boxes.figure("apart.min_m"), 2, 1e-6);
  EXPECT_NEAR(boxes.figure("apart.at_s"), 1, 0.011);
}

TEST(Separation, OfASingleVehicleIsNone) {
  test::TestWorld test(test::box_world("        []\n", "{step_s: 0.01, gravity_mps2: 0}",
                                       "metrics: [{name: apart, type: separation}]\n"));
  experiment::Scoring scoring(test.world);
  test.world.step();
  scoring.after_step();
  EXPECT_TRUE(std::isnan(scoring.figures().at("apart.min_m")));
}

}  // namespace
