// SPDX-License-Identifier: BSD-3-Clause
// The referee of worlds/soccer.yaml, without the programs of its robots.

#include <gmock/gmock.h>

#include "shoal/utime_t.hpp"
#include "sim/world/world_state.hpp"
#include "tests/devices/world_fixture.hpp"
#include "tests/project_paths.hpp"

namespace {

struct Soccer : test::LoadedTestWorld {
  explicit Soccer(const sim::LoadOptions& options = {.sets = {"metrics=[]", "pass=[]"}})
      : LoadedTestWorld(sim::load_world(test_support::source_path("worlds/soccer.yaml"), with_messages(options))),
        blue(*this, "referee.goal_blue"),
        yellow(*this, "referee.goal_yellow"),
        outs(*this, "referee.out") {
    world.step();  // the kick-off
  }
  /// Rolls the ball from a place at 1 m/s for half a second.
  void roll(double x_m, double y_m, double x_mps, double y_mps) {
    world.editor().move_vehicle("ball", sim::make_pose({x_m, y_m, 0.11}, {0, 0, 0}));
    world.find_vehicle("ball")->body("ball").set_velocity_W({x_mps, y_mps, 0}, {-y_mps / 0.11, x_mps / 0.11, 0});
    run_for(0.5);
  }
  sim::Vector3d ball_W() const { return world.find_vehicle("ball")->X_WV().translation(); }

  test::Listener<shoal::utime_t> blue, yellow, outs;
};

TEST(Soccer, AGoalCountsForTheOtherTeamAndTheBallReturnsToTheMiddleLine) {
  Soccer test;
  // From 0.1 m before the line: the whole ball is behind it after 0.21 s.
  test.roll(4.4, 0.5, 1, 0);
  EXPECT_EQ(test.blue.take_all().size(), 1u);
  EXPECT_NEAR(test.ball_W().x(), 0, 1e-9);
  EXPECT_LE(std::abs(test.ball_W().y()), 2);
  test.roll(-4.4, -0.5, -1, 0);
  EXPECT_EQ(test.yellow.take_all().size(), 1u);
  EXPECT_NEAR(test.ball_W().x(), 0, 1e-9);
  EXPECT_EQ(test.blue.take_all().size() + test.outs.take_all().size(), 0u);
}

TEST(Soccer, ABallIsOutWhenAllOfItIsBehindALine) {
  Soccer test;
  test.roll(2, 2.5, 0, 1);  // to 0.5 m: on the line
  EXPECT_EQ(test.outs.take_all().size(), 0u);
  EXPECT_GT(test.ball_W().y(), 2.9);
  const double sides[][4] = {{2, 2.9, 0, 1}, {-2, -2.9, 0, -1}, {4.4, 1.8, 1, 0}, {-4.4, -1.8, -1, 0}};
  for (const auto& [x_m, y_m, x_mps, y_mps] : sides) {
    test.roll(x_m, y_m, x_mps, y_mps);
    EXPECT_EQ(test.outs.take_all().size(), 1u) << x_m;
    EXPECT_NEAR(test.ball_W().x(), 0, 1e-9) << x_m;
  }
  EXPECT_EQ(test.blue.take_all().size() + test.yellow.take_all().size(), 0u);
}

TEST(Soccer, TheRobotOfTheHumanStandsUntilSomeoneDrivesIt) {
  Soccer test;
  const sim::Vector3d start = test.world.find_vehicle("human")->X_WV().translation();
  test.run_for(5);
  EXPECT_NEAR((test.world.find_vehicle("human")->X_WV().translation() - start).norm(), 0, 1e-3);
}

TEST(Soccer, TheBallStartsAtAPlaceOfTheSeed) {
  const auto start_of = [](std::int64_t seed) {
    return Soccer({.sets = {"metrics=[]", "pass=[]"}, .seed = seed}).ball_W();
  };
  EXPECT_EQ(start_of(1), start_of(1));
  EXPECT_NE(start_of(1), start_of(2));
}

}  // namespace
