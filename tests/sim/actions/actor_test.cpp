// SPDX-License-Identifier: BSD-3-Clause
#include <gmock/gmock.h>

#include "tests/devices/world_fixture.hpp"

namespace {

/// A cart that goes east at 1 m/s, and is commanded at 1 s and at 2 s.
std::string cart_world(const std::string& first, const std::string& second = "start") {
  return "shoal: 1\nphysics: {step_s: 0.01, gravity_mps2: 0}\n"
         "objects:\n  - {name: cart, parts: [{shape: box}]}\n"
         "actors:\n  - {name: ride, object: cart, points: [[0, 0, 0], [100, 0, 0]], speed_mps: 1}\n"
         "events:\n  - {name: a, at: 1, do: [{actor: {name: ride, command: " +
         first + "}}]}\n  - {name: b, at: 2, do: [{actor: {name: ride, command: " + second + "}}]}\n";
}

double way_m(const std::string& yaml, double time_s) {
  test::TestWorld test(yaml);
  test.run_for(time_s);
  return test.world.find_object("cart")->base().X_WB().translation().x();
}

// A command acts from the step after the one in which its event fires: a step of 0.01 m.
constexpr double step_m = 0.011;

TEST(ActorAction, StopsAndGoesOn) {
  EXPECT_NEAR(way_m(cart_world("stop"), 2), 1, step_m);
  EXPECT_NEAR(way_m(cart_world("stop"), 3), 2, 2 * step_m);
}

TEST(ActorAction, GoesBackAndForward) {
  EXPECT_NEAR(way_m(cart_world("back", "forward"), 2), 0, 2 * step_m);
  EXPECT_NEAR(way_m(cart_world("back", "forward"), 4), 2, 3 * step_m);
}

TEST(ActorAction, NamesItsCommandsAndActors) {
  EXPECT_THAT(test::error_of_world(cart_world("halt")), testing::HasSubstr("forward"));
  std::string yaml = cart_world("stop");
  yaml.replace(yaml.find("{actor: {name: ride"), 19, "{actor: {name: rode");
  EXPECT_THAT(test::error_of_world(yaml), testing::HasSubstr("names no actor 'rode'; known actors: ride"));
}

}  // namespace
