// SPDX-License-Identifier: BSD-3-Clause
#include "autonomy/missions/robots/dog_steering.hpp"

#include <gmock/gmock.h>

#include <cmath>

namespace {

using autonomy::BallSighting;
using autonomy::DogSteering;
using autonomy::HeadPose;
using testing::Optional;

BallSighting seen_at(double bearing_rad, double elevation_rad) {
  BallSighting sighting;
  sighting.bearing_rad = bearing_rad;
  sighting.elevation_rad = elevation_rad;
  return sighting;
}

TEST(DogSteering, LevelsASightingOfAHeadThatLooksDown) {
  DogSteering steering({.search_down_rad = 0.6});
  // In the middle of the image: 0.6 rad down.
  const BallSighting middle = steering.level(seen_at(0, 0));
  EXPECT_NEAR(middle.bearing_rad, 0, 1e-12);
  EXPECT_NEAR(middle.elevation_rad, -0.6, 1e-12);
  // On the middle row, the direction (cos b, sin b) in the plane that is pitched by 0.6 rad.
  const BallSighting left = steering.level(seen_at(0.3, 0));
  EXPECT_NEAR(std::tan(left.bearing_rad), std::tan(0.3) / std::cos(0.6), 1e-12);
  // Above it, at the horizon.
  EXPECT_NEAR(steering.level(seen_at(0, 0.6)).elevation_rad, 0, 1e-12);
}

TEST(DogSteering, TheHeadFollowsTheBallWithTheNodFirst) {
  DogSteering steering({.search_down_rad = 0.1, .max_down_rad = 0.8, .follow_gain = 0.5, .max_nod_rad = 0.25});
  const HeadPose nodded = steering.look(seen_at(0, -0.2));  // 0.1 + 0.5 * 0.2
  EXPECT_NEAR(nodded.head_nod_rad, -0.2, 1e-12);
  EXPECT_NEAR(nodded.neck_tilt_rad, 0, 1e-12);
  const HeadPose bent = steering.look(seen_at(0, -0.4));
  EXPECT_NEAR(bent.head_nod_rad, -0.25, 1e-12);
  EXPECT_NEAR(bent.neck_tilt_rad, -0.15, 1e-12);
  for (int i = 0; i < 10; ++i) steering.look(seen_at(0, -0.4));
  EXPECT_NEAR(steering.down_rad(), 0.8, 1e-12);
  for (int i = 0; i < 100; ++i) steering.look(std::nullopt);
  EXPECT_NEAR(steering.down_rad(), 0.1, 1e-12);
}

TEST(DogSteering, WalksByTheTurnRate) {
  const auto motion = [](double turn_radps) {
    DogSteering steering({.curve_radps = 0.2, .spot_radps = 0.5});
    return steering.walk(0, {0.1, turn_radps}, false);
  };
  EXPECT_THAT(motion(0.1), Optional(std::string("trot")));
  EXPECT_THAT(motion(0.3), Optional(std::string("trot_left")));
  EXPECT_THAT(motion(-0.3), Optional(std::string("trot_right")));
  EXPECT_THAT(motion(0.7), Optional(std::string("turn_left")));
  EXPECT_THAT(motion(-0.7), Optional(std::string("turn_right")));
}

TEST(DogSteering, KeepsAMotionForAWhile) {
  DogSteering steering({.hold_s = 0.3});
  EXPECT_TRUE(steering.walk(0, {0.1, 0}, false));
  EXPECT_FALSE(steering.walk(100'000, {0.1, 0}, false)) << "it is the same";
  EXPECT_FALSE(steering.walk(200'000, {0.1, 1}, false)) << "too early";
  EXPECT_THAT(steering.walk(300'000, {0.1, 1}, false), Optional(std::string("turn_left")));
}

TEST(DogSteering, KicksByAMotionWhenTheBallIsAhead) {
  DogSteering steering({.curve_radps = 0.2, .hold_s = 0});
  EXPECT_THAT(steering.walk(0, {0.1, 0.1}, true), Optional(std::string("kick")));
  EXPECT_THAT(steering.walk(100'000, {0.1, -0.3}, true), Optional(std::string("trot_right")));
  EXPECT_THAT(steering.walk(200'000, {0.1, 0.1}, false), Optional(std::string("trot")));
}

}  // namespace
