// SPDX-License-Identifier: BSD-3-Clause
#include "sim/director/actor.hpp"

#include <gtest/gtest.h>

#include "shoal/twist_command_t.hpp"
#include "sim/world/world_editor.hpp"
#include "tests/devices/world_fixture.hpp"

namespace {

std::string actor_world(const std::string& actor, const std::string& more = "") {
  return R"(
shoal: 1
physics: {step_s: 0.01}
objects:
  - {name: ground, fixed: true, parts: [{shape: plane}]}
  - {name: cart, position_m: [50, 50, 1], parts: [{shape: box, size_m: [1, 1, 1], mass_kg: 10}]}
)" + more +
         "actors:\n  - {name: ride, object: cart, " + actor + "}\n";
}

sim::Pose cart(const test::TestWorld& test) {
  return test.world.find_object("cart")->base().X_WB();
}

TEST(Actor, IsOnItsPathAtEachOfTenThousandSteps) {
  test::TestWorld test(
      actor_world("path: spline, points: [[0, 0, 1], [6, 0, 1], [6, 6, 2], [0, 5, 1]], speed_mps: 1.7"));
  const sim::ActorConfig& config = test.loaded.config.actors[0];
  const sim::Path path = config.make_path();
  for (int i = 0; i < 10000; ++i) {
    test.world.step();
    const double gone_m = 1.7 * sim::to_seconds(test.world.now());
    const double u = gone_m - path.length() * std::floor(gone_m / path.length());
    ASSERT_LT((cart(test).translation() - path.pose_at(u).translation()).norm(), 1e-9) << i;
    ASSERT_TRUE(cart(test).linear().isApprox(path.pose_at(u).linear(), 1e-9)) << i;
  }
}

TEST(Actor, ThatBouncesComesTheSameWayBack) {
  test::TestWorld test(actor_world("points: [[0, 0, 1], [4, 0, 1]], speed_mps: 1, ends: reverse"));
  test.run_for(5);
  EXPECT_NEAR(cart(test).translation().x(), 3, 1e-9);
  test.run_for(4);  // 9 m of 8 there and back
  EXPECT_NEAR(cart(test).translation().x(), 1, 1e-9);
}

TEST(Actor, WaitsForItsTimeAndStopsAtTheEnd) {
  test::TestWorld test(actor_world("points: [[0, 0, 1], [4, 0, 1]], speed_mps: 1, ends: stop, start_s: 2"));
  test.run_for(2);
  EXPECT_EQ(cart(test).translation().x(), 0);
  test.run_for(1);
  EXPECT_NEAR(cart(test).translation().x(), 1, 1e-9);
  test.run_for(10);
  EXPECT_NEAR(cart(test).translation().x(), 4, 1e-12);
}

TEST(Actor, PushesWhatStandsInItsWayAndIsNotPushed) {
  test::TestWorld test(actor_world("points: [[0, 0, 0.51], [4, 0, 0.51]], speed_mps: 1, ends: stop",
                                   "  - {name: crate, position_m: [2, 0, 0.25], "
                                   "parts: [{shape: box, size_m: [0.5, 0.5, 0.5], mass_kg: 500}]}\n"));
  test.run_for(6);
  EXPECT_NEAR(cart(test).translation().x(), 4, 1e-9);
  // The front of the cart ends at 4.5 m, and the crate reaches 0.25 m farther at least.
  EXPECT_GT(test.world.find_object("crate")->base().X_WB().translation().x(), 4.7);
}

TEST(Actor, OfADoorOpensForAVehicleThatComesNear) {
  const std::string door = R"(
  - {name: door, position_m: [3, 0, 0.6], parts: [{shape: box, size_m: [0.1, 2, 1], mass_kg: 20}]}
)";
  test::TestWorld test(test::rover_world(R"(        - {name: drive, type: differential_drive, left_joint: left,
           right_joint: right, wheel_radius_m: 0.1, track_m: 0.5, max_torque_Nm: 20}
)",
                                         door) +
                       R"(
zones:
  - {name: doorstep, shape: box, position_m: [2, 0, 0], size_m: [2, 4, 4]}
actors:
  - {name: slide, object: door, points: [[3, 0, 0.6], [3, 2.5, 0.6]], rpy_deg: [0, 0, 0], speed_mps: 2.5,
     ends: stop, starts: waiting}
events:
  - {name: open, when: any enters doorstep, do: [{actor: {name: slide, command: forward}}]}
  - {name: shut, when: any leaves doorstep, do: [{actor: {name: slide, command: back}}]}
)");
  const auto door_y = [&] { return test.world.find_object("door")->base().X_WB().translation().y(); };
  test.run_for(1);
  EXPECT_EQ(door_y(), 0);
  for (int i = 0; i < 80; ++i) {
    shoal::twist_command_t ahead{};
    ahead.forward_mps = 0.8;
    test.send("r1.drive.cmd", ahead);
    test.run_for(0.1);
    if (i == 32) {
      EXPECT_NEAR(door_y(), 2.5, 1e-9);
    }
  }
  // It went through: 8 s at about 0.8 m/s, the door in between at 3 m; and the door is shut again.
  EXPECT_GT(test.world.vehicles()[0]->X_WV().translation().x(), 4);
  EXPECT_NEAR(door_y(), 0, 1e-9);
}

TEST(Actor, LeadsWhatComesInPlaceOfItsObjectAndRefusesWhatCannotBeLed) {
  test::TestWorld test(
      "shoal: 1\nphysics: {step_s: 0.01, gravity_mps2: 0}\nobjects: [{name: lift, parts: [{shape: box, mass_kg: "
      "1}]}]\nactors: [{name: up, object: lift, points: [[0, 0, 0], [0, 0, 9]], speed_mps: 1}]\n");
  test.run_for(1);
  test.world.editor().remove_object("lift");
  test.run_for(0.1);
  sim::ObjectConfig other = test.loaded.config.objects.front();
  other.bodies.front().kinematic = false;
  other.fixed = true;
  EXPECT_THROW(test.world.editor().add_object(other, "lift", sim::Pose::Identity()), sim::ConfigError);
  other.fixed = false;
  test.world.editor().add_object(other, "lift", sim::Pose::Identity());
  test.run_for(0.9);
  EXPECT_NEAR(test.world.find_object("lift")->base().X_WB().translation().z(), 2, 1e-9);  // 1 m/s for 2 s
}

}  // namespace
