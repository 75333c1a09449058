// SPDX-License-Identifier: BSD-3-Clause
#include "motion/analysis/connect.hpp"

#include <gmock/gmock.h>

#include "motion/analysis/motion_check.hpp"
#include "sim/world_file/load_world.hpp"
#include "tests/project_paths.hpp"
#include "verification/motions/standing_poses.hpp"

namespace {

using motion::ConnectionKind;

sim::WorldConfig studio_of_poses() {
  return sim::load_world(test_support::source_path("worlds/ers7_studio.yaml")).config;
}

sim::JointValues legs(double swing, double knee) {
  sim::JointValues pose;
  for (const char* leg : {"lf", "rf", "lh", "rh"}) {
    pose.emplace_back(leg + std::string("_swing"), swing);
    pose.emplace_back(leg + std::string("_flap"), 0);
    pose.emplace_back(leg + std::string("_knee"), knee);
  }
  return pose;
}

motion::ConnectOptions in_one_world() {
  motion::ConnectOptions options;
  options.worlds = 0;
  return options;
}

TEST(Connector, FromStandingToCrouchingTheWayIsStraight) {
  motion::Connector connector(studio_of_poses(), "dog", motion::held_pose("stand", "ers7", legs(0, 0.5)),
                              in_one_world());
  const motion::Connection connection = connector.connect(legs(-0.7, 1.5));
  EXPECT_EQ(connection.kind, ConnectionKind::straight);
  EXPECT_EQ(connection.played, 1);
  ASSERT_EQ(connection.arrivals.size(), 1u);
  EXPECT_LE(connection.arrivals[0].error, in_one_world().arrive_rad);
  // At 1 rad/s the knee takes 1 s; the course of a smooth key is faster in the middle, and within the servo's speed.
  EXPECT_NEAR(connection.motion.end_s(), 1, 1e-9);
  EXPECT_TRUE(motion::check_motion(connection.motion, *studio_of_poses().vehicles.front().config).empty());
}

TEST(Connector, TheStartIsWhereTheMotionBeforeEnds) {
  sim::JointMotion before = motion::held_pose("before", "ers7", legs(0, 0.5));
  before.keys[1].joints = legs(0, 0.8);
  before.keys[1].joints.emplace_back("head_pan", 0.4);
  motion::Connector connector(studio_of_poses(), "dog", before, in_one_world());
  const motion::Connection connection = connector.connect(legs(0, 0.5));
  ASSERT_EQ(connection.kind, ConnectionKind::straight);
  for (const sim::MotionTrack& track : connection.motion.tracks()) {
    if (track.joint.ends_with("knee")) {
      EXPECT_NEAR(track.value_at(0), 0.8, 1e-9);
      EXPECT_NEAR(track.value_at(connection.motion.end_s()), 0.5, 1e-9);
    }
    // What the end does not name stays as the start has it.
    if (track.joint == "head_pan") {
      EXPECT_NEAR(track.value_at(connection.motion.end_s()), 0.4, 1e-9);
    }
  }
}

TEST(Connector, AStartInWhichItFallsIsRefused) {
  sim::WorldConfig world = studio_of_poses();
  // On its back.
  world.vehicles.front().X_WV = sim::make_pose({0, 0, 0.3}, {M_PI, 0, 0});
  try {
    motion::Connector connector(world, "dog", motion::held_pose("stand", "ers7", legs(0, 0.5)), in_one_world());
    FAIL();
  } catch (const sim::ConfigError& error) {
    EXPECT_STREQ(error.what(), "vehicle 'dog' does not stand still at the end of 'stand'");
  }
}

TEST(Connector, AnUnknownJointIsRefused) {
  motion::Connector connector(studio_of_poses(), "dog", motion::held_pose("stand", "ers7", legs(0, 0.5)),
                              in_one_world());
  EXPECT_THROW(connector.connect({{"lf_wheel", 0}}), sim::ConfigError);
}

TEST(Connector, AnEndThatIsNotReachedIsSearchedUntilTheCandidatesAreUsedUp) {
  motion::ConnectOptions options = in_one_world();
  options.arrive_rad = 0;  // a joint is never exactly there
  options.candidates = 12;
  motion::Connector connector(studio_of_poses(), "dog", motion::held_pose("stand", "ers7", legs(0, 0.5)), options);
  const motion::Connection connection = connector.connect(legs(-0.7, 1.5));
  EXPECT_EQ(connection.kind, ConnectionKind::none);
  EXPECT_LT(connection.value, 0);
  // Straight, slower, by the stance, and a generation: 4 + 3 ln n candidates for 12 joints and two times.
  EXPECT_EQ(connection.played, 3 + 11);
}

TEST(Connector, RandomPairsOfPosesAreConnectedTheSameWithAnyNumberOfThreads) {
  const sim::WorldConfig world = studio_of_poses();
  const verification::StandingPoses poses = verification::standing_poses(world, "dog", 4, 7);
  ASSERT_EQ(poses.poses.size(), 4u);
  for (std::size_t i = 0; i < 4; i += 2) {
    std::vector<motion::Connection> found;
    for (const int threads : {1, 2}) {
      if (i > 0 && threads > 1) continue;
      motion::ConnectOptions options;
      options.worlds = 1;
      options.threads = threads;
      motion::Connector connector(world, "dog", motion::held_pose("from", "ers7", poses.poses[i]), options);
      found.push_back(connector.connect(poses.poses[i + 1]));
    }
    EXPECT_NE(found[0].kind, ConnectionKind::none);
    EXPECT_EQ(found[0].kind, found.back().kind);
    EXPECT_EQ(found[0].played, found.back().played);
    EXPECT_EQ(sim::motion_text(found[0].motion), sim::motion_text(found.back().motion));
    for (const motion::Arrival& arrival : found[0].arrivals) EXPECT_LE(arrival.error, 2 * M_PI / 180);
  }
}

}  // namespace
