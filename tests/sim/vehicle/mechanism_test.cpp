// SPDX-License-Identifier: BSD-3-Clause
#include "sim/vehicle/mechanism.hpp"

#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "tests/devices/world_fixture.hpp"
#include "tests/project_paths.hpp"

// Objects of several bodies; those of vehicles are in vehicle_test.cpp and in the tests of devices.

namespace {

using testing::HasSubstr;

constexpr double g_mps2 = 9.80665, step_s = 0.005;

/// 20 kg on three castors, whose wheels of 0.5 kg and 4 cm trail by 5 cm and have a rolling resistance of 5 %.
const std::string stool = R"(
  - name: stool
    position_m: [1, 2, 0]
    bodies:
      - {name: seat, position_m: [0, 0, 0.3], parts: [{shape: box, size_m: [0.4, 0.4, 0.1], mass_kg: 20}]}
      - {name: fork1, position_m: [0.3, 0, 0.08], parts: &fork [{shape: box, size_m: [0.04, 0.04, 0.04], mass_kg: 0.3}]}
      - {name: fork2, position_m: [-0.2, 0.2, 0.08], parts: *fork}
      - {name: fork3, position_m: [-0.2, -0.2, 0.08], parts: *fork}
      - name: wheel1
        position_m: [0.25, 0, 0.04]
        parts: &wheel [{shape: cylinder, radius_m: 0.04, length_m: 0.03, rpy_deg: [90, 0, 0], mass_kg: 0.5,
          material: wheel}]
      - {name: wheel2, position_m: [-0.25, 0.2, 0.04], parts: *wheel}
      - {name: wheel3, position_m: [-0.25, -0.2, 0.04], parts: *wheel}
    joints:
      - {name: pivot1, type: hinge, bodies: [seat, fork1], axis: [0, 0, 1]}
      - {name: pivot2, type: hinge, bodies: [seat, fork2], axis: [0, 0, 1]}
      - {name: pivot3, type: hinge, bodies: [seat, fork3], axis: [0, 0, 1]}
      - {name: axle1, type: hinge, bodies: [fork1, wheel1], axis: [0, 1, 0]}
      - {name: axle2, type: hinge, bodies: [fork2, wheel2], axis: [0, 1, 0]}
      - {name: axle3, type: hinge, bodies: [fork3, wheel3], axis: [0, 1, 0]}
)";

const std::string door = R"(
  - name: door
    position_m: [5, 0, 0]
    rpy_deg: [0, 0, 90]
    bodies:
      - {name: panel, position_m: [0, 0.4, 1.05], parts: [{shape: box, size_m: [0.04, 0.8, 2], mass_kg: 20}]}
      - {name: handle, position_m: [0.05, 0.7, 1], parts: [{shape: box, size_m: [0.02, 0.1, 0.02], mass_kg: 0.3}]}
    joints:
      - {name: hinge, type: hinge, bodies: [panel, world], anchor_m: [0, 0, 0], axis: [0, 0, 1], high_stop: 1.5,
         damping: 8}
      - {name: latch, type: hinge, bodies: [panel, handle], anchor_m: [0.05, 0.65, 1], axis: [1, 0, 0],
         low_stop: -0.6, high_stop: 0}
)";

std::string world_of(const std::string& objects, const std::string& more = "") {
  return R"(
shoal: 1
physics: {step_s: 0.005}
materials: [{name: wheel}]
contacts: [{between: [wheel, any], friction: 0.9, rolling_friction_m: 0.002}]
objects:
  - {name: ground, fixed: true, parts: [{shape: plane}]}
)" + objects +
         more;
}

const sim::WorldObject& object(const test::TestWorld& test, const std::string& name) {
  return *test.world.find_object(name);
}

TEST(Mechanism, OnCastorsRollsAsItsMassAndItsRollingResistanceSay) {
  test::TestWorld test(world_of(stool));
  test.run_for(1);
  const sim::Mechanism& rolls = object(test, "stool");
  EXPECT_NEAR(rolls.X_WV().translation().x(), 1, 1e-4);  // it stands
  constexpr double mass_kg = 20 + 3 * (0.3 + 0.5), radius_m = 0.04, force_N = 40;
  // A wheel of inertia m r^2 / 2 adds half its mass; its rolling resistance is a torque of 2 mm times its load.
  constexpr double effective_kg = mass_kg + 3 * 0.5 / 2;
  constexpr double resistance_N = mass_kg * g_mps2 * 0.002 / radius_m;
  constexpr int steps = 200;
  for (int i = 0; i < steps; ++i) {
    // At the height of the axles, where it shifts the load least.
    sim::Vector3d at_W = rolls.base().p_WB();
    at_W.z() = radius_m;
    rolls.base().add_force_W({force_N, 0, 0}, at_W);
    test.world.step();
  }
  const double speed_mps = (force_N - resistance_N) / effective_kg * steps * step_s;
  EXPECT_NEAR(rolls.base().v_WB_W().x(), speed_mps, 0.01 * speed_mps);
  const double from_m = rolls.base().p_WB().x();
  // All wheels roll without slip, and the castors keep their direction.
  for (const char* axle : {"axle1", "axle2", "axle3"})
    EXPECT_NEAR(rolls.joint(axle).velocity(), speed_mps / radius_m, 0.02 * speed_mps / radius_m) << axle;
  EXPECT_NEAR(rolls.joint("pivot1").position(), 0, 0.01);
  // It coasts down by the resistance alone, and stays.
  test.run_for(speed_mps * effective_kg / resistance_N + 1);
  const double coasted_m = speed_mps * speed_mps * effective_kg / resistance_N / 2;
  EXPECT_NEAR(rolls.base().p_WB().x() - from_m, coasted_m, 0.02 * coasted_m);
  const double stands_m = rolls.base().p_WB().x();
  test.run_for(60);
  EXPECT_NEAR(rolls.base().p_WB().x(), stands_m, 1e-4);
}

TEST(Mechanism, CastorsTurnRoundWhenItIsPulledBack) {
  test::TestWorld test(world_of(stool));
  const sim::Mechanism& rolls = object(test, "stool");
  for (int i = 0; i < 600; ++i) {
    rolls.base().add_force_W({-40, 3, 0}, rolls.base().p_WB());
    test.world.step();
  }
  for (const char* pivot : {"pivot1", "pivot2", "pivot3"})
    EXPECT_NEAR(std::abs(rolls.joint(pivot).position()), std::numbers::pi, 0.3) << pivot;
}

TEST(Mechanism, ADoorTurnsByItsPushOverItsDamping) {
  test::TestWorld test(world_of(door));
  const sim::Mechanism& turns = object(test, "door");
  // I w' = T - d w, so that d times the angle is the integral of T when it stands again, also in implicit Euler.
  constexpr double torque_Nm = 12, damping = 8;
  constexpr int steps = 100;
  for (int i = 0; i < steps; ++i) {
    turns.base().add_torque_W({0, 0, torque_Nm});
    test.world.step();
  }
  test.run_for(20);  // the inertia is 4.3 kg m^2 + 0.15 kg m^2: 37 time constants
  EXPECT_NEAR(turns.joint("hinge").position(), torque_Nm * steps * step_s / damping, 1e-4);
}

TEST(Mechanism, ADoorStopsAtItsStopAndItsHandleHangsAtIts) {
  test::TestWorld test(world_of(door));
  const sim::Mechanism& turns = object(test, "door");
  for (int i = 0; i < 1000; ++i) {
    turns.base().add_torque_W({0, 0, 30});
    test.world.step();
  }
  EXPECT_NEAR(turns.joint("hinge").position(), 1.5, 0.01);
  // Its frame is at the hinge: it turns on its place.
  EXPECT_NEAR(sim::yaw_of(turns.X_WV().linear()), std::numbers::pi / 2 + 1.5, 0.01);
  EXPECT_LT((turns.X_WV().translation() - sim::Vector3d(5, 0, 0)).norm(), 0.002);
  EXPECT_NEAR(turns.joint("latch").position(), -0.6, 0.01);
}

TEST(Mechanism, ADrawerIsHeldByItsFrictionAndStopsAtItsStops) {
  test::TestWorld test(world_of(R"(
  - name: cabinet
    bodies:
      - {name: case, position_m: [0, 0, 0.3], parts: [{shape: box, size_m: [0.5, 0.5, 0.6], mass_kg: 40}]}
      - {name: drawer, position_m: [0, 0, 0.4], parts: [{shape: box, size_m: [0.4, 0.4, 0.1], mass_kg: 4}]}
    joints:
      - {name: slide, type: slider, bodies: [case, drawer], axis: [0, 1, 0], low_stop: 0, high_stop: 0.35,
         motor_max_force: 5}
)"));
  const sim::Mechanism& cabinet = object(test, "cabinet");
  const auto pull_for = [&](double force_N, int steps) {
    for (int i = 0; i < steps; ++i) {
      cabinet.body("drawer").add_force_W({0, force_N, 0}, cabinet.body("drawer").p_WB());
      test.world.step();
    }
    return cabinet.joint("slide").position();
  };
  EXPECT_NEAR(pull_for(4, 200), 0, 1e-6);
  // (15 N - 5 N) / 4 kg for 60 steps; semi-implicit Euler.  The case has its weight on the ground.
  EXPECT_NEAR(pull_for(15, 60), 2.5 * step_s * step_s * 60 * 61 / 2, 2e-4);
  EXPECT_NEAR(pull_for(15, 400), 0.35, 1e-3);
  EXPECT_NEAR(pull_for(-15, 400), 0, 1e-3);
  EXPECT_NEAR(cabinet.base().p_WB().y(), 0, 1e-3);
}

TEST(Mechanism, BodiesOfAnObjectHaveItsNameAndTheirOwn) {
  test::TestWorld test(world_of(stool + door));
  EXPECT_EQ(object(test, "stool").base().name(), "stool/seat");
  EXPECT_EQ(object(test, "stool").body("wheel2").name(), "stool/wheel2");
  EXPECT_EQ(object(test, "stool").joint("axle2").name(), "stool/axle2");
  EXPECT_LT((object(test, "stool").body("wheel2").p_WB() - sim::Vector3d(0.75, 2.2, 0.04)).norm(), 1e-12);
  // In the object's frame, which is turned.
  EXPECT_LT((object(test, "door").body("handle").p_WB() - sim::Vector3d(5 - 0.7, 0.05, 1)).norm(), 1e-12);
  EXPECT_TRUE(test.world.physics().find_part(object(test, "stool").group(), "wheel2/1").has_value());
}

TEST(Mechanism, ComesByCountAndByEventsAndGoes) {
  std::string late = stool;
  late.replace(late.find("name: stool"), 11, "name: late\n    present: false");
  std::string many = stool;
  many.replace(many.find("name: stool"), 11, "name: many\n    count: 3\n    placement: {pattern: line, spacing_m: 4}");
  test::TestWorld test(world_of(late + many, R"(
events:
  - {name: come, at: 1, do: [{add: {object: late, position_m: [9, 9, 0]}}]}
  - name: more
    at: 1
    do:
      - add: {object: {name: flap, position_m: [0, -9, 1], bodies: [{name: leaf, parts: [{shape: box, mass_kg: 1}]}],
          joints: [{name: pin, bodies: [leaf, world], anchor_m: [0, 0, 0.5]}]}}
  - {name: go, at: 2, do: [{remove: late}, {remove: many2}]}
)"));
  EXPECT_EQ(test.world.find_object("late"), nullptr);
  // In line, 4 m apart about the entry's position.
  EXPECT_LT((object(test, "many3").X_WV().translation() - sim::Vector3d(5, 2, 0)).norm(), 1e-12);
  test.run_for(1.5);
  EXPECT_LT((object(test, "late").X_WV().translation() - sim::Vector3d(9, 9, 0)).norm(), 1e-3);
  EXPECT_NEAR(object(test, "flap").base().p_WB().z(), 1, 1e-3);  // it hangs
  const auto bodies = [&] {
    return std::count_if(test.world.physics().bodies().begin(), test.world.physics().bodies().end(),
                         [](const auto& body) { return body != nullptr; });
  };
  const auto before = bodies();
  test.run_for(1);
  EXPECT_EQ(test.world.find_object("late"), nullptr);
  EXPECT_EQ(before - bodies(), 14);
}

TEST(Mechanism, IsMovedAsItIsAndAtRest) {
  test::TestWorld test(world_of(stool + door));
  const sim::Mechanism& rolls = object(test, "stool");
  const sim::Mechanism& turns = object(test, "door");
  for (int i = 0; i < 100; ++i) {
    rolls.base().add_force_W({40, 0, 0}, rolls.base().p_WB());
    turns.base().add_torque_W({0, 0, 20});
    test.world.step();
  }
  const double wheel_rad = rolls.joint("axle1").position(), door_rad = turns.joint("hinge").position();
  const sim::Pose X_VF = rolls.X_WV().inverse() * rolls.body("fork2").X_WB();
  const sim::Pose X_WV = sim::make_pose({-3, 4, 0.001}, {0, 0, 1});
  test.world.editor().move_object("stool", X_WV);
  test.world.editor().move_object("door", sim::make_pose({0, -5, 0}, {0, 0, -1}));
  EXPECT_EQ(rolls.base().v_WB_W(), sim::Vector3d::Zero());
  EXPECT_TRUE(rolls.X_WV().isApprox(X_WV, 1e-12));
  EXPECT_TRUE((X_WV.inverse() * rolls.body("fork2").X_WB()).isApprox(X_VF, 1e-12));
  EXPECT_NEAR(rolls.joint("axle1").position(), wheel_rad, 1e-12);
  // The hinge is where the door is, with the angle of before.
  test.run_for(0.1);
  EXPECT_NEAR(turns.joint("hinge").position(), door_rad, 1e-4);  // its handle still swings
  turns.base().add_torque_W({0, 0, -2000});
  test.run_for(1);
  EXPECT_LT((turns.X_WV().translation() - sim::Vector3d(0, -5, 0)).norm(), 0.002);
  EXPECT_LT(turns.joint("hinge").position(), door_rad - 0.5);
}

TEST(Mechanism, OfOneBodyIsMovedWithItsJointToTheWorld) {
  test::TestWorld test(world_of(R"(
  - name: sign
    position_m: [0, 0, 3]
    bodies: [{name: board, parts: [{shape: box, size_m: [1, 0.1, 1], mass_kg: 1}]}]
    joints: [{name: hangs, type: fixed, bodies: [board, world]}]
)"));
  test.run_for(0.1);
  test.world.editor().move_object("sign", sim::make_pose({1000, 0, 3}, {0, 0, 0}));
  test.run_for(0.5);
  EXPECT_LT((object(test, "sign").X_WV().translation() - sim::Vector3d(1000, 0, 3)).norm(), 1e-3);
}

TEST(Mechanism, ThatIsLedIsNotFlungByATurnInItsPlace) {
  test::TestWorld test(
      world_of(R"(
  - name: pair
    position_m: [0, 0, 3]
    bodies:
      - {name: base, parts: [{shape: box, size_m: [0.5, 0.5, 0.1], mass_kg: 5}]}
      - {name: top, position_m: [0, 0, 0.2], parts: [{shape: box, size_m: [0.4, 0.4, 0.1], mass_kg: 1}]}
    joints: [{name: swivel, type: hinge, bodies: [base, top], axis: [0, 0, 1]}]
)",
               "actors: [{name: lead, object: pair, points: [[0, 0, 3], [9, 0, 3]], speed_mps: 0.5}]\n"));
  test.run_for(0.5);
  const sim::Pose X_WV = object(test, "pair").X_WV();
  test.world.editor().move_object("pair", X_WV * sim::make_pose({0, 0, 0}, {0, 0, 1.5}));
  test.run_for(1);
  EXPECT_NEAR(object(test, "pair").joint("swivel").position(), 0, 1e-6);
}

TEST(Mechanism, IsLedByAnActorWithItsWheelsRolling) {
  test::TestWorld test(world_of(stool, R"(
actors: [{name: pull, object: stool, points: [[1, 2, 0], [4, 2, 0]], speed_mps: 0.5, ends: stop}]
)"));
  const sim::Mechanism& led = object(test, "stool");
  test.run_for(4);
  EXPECT_LT((led.X_WV().translation() - sim::Vector3d(3, 2, 0)).norm(), 1e-9);
  for (const char* axle : {"axle1", "axle2", "axle3"}) EXPECT_NEAR(led.joint(axle).velocity(), 0.5 / 0.04, 0.2) << axle;
  // Moved away it returns, as a whole.
  test.world.editor().move_object("stool", sim::make_pose({-8, -8, 0}, {0, 0, 0}));
  test.run_for(0.5);
  EXPECT_LT((led.X_WV().translation() - sim::Vector3d(3.25, 2, 0)).norm(), 1e-9);
  EXPECT_NEAR((led.body("wheel1").p_WB() - led.X_WV().translation()).norm(), std::hypot(0.25, 0.04), 1e-3);
}

TEST(Mechanism, TouchesAsOneObject) {
  test::TestWorld test(world_of(stool +
                                    "  - {name: ball, position_m: [1.42, 2, 0.05], parts: [{shape: sphere, radius_m: "
                                    "0.05, mass_kg: 0.1}]}\n",
                                "events: [{name: hit, when: stool touches ball, do: [{gravity_mps2: 5}]}]\n"));
  const sim::Mechanism& rolls = object(test, "stool");
  for (int i = 0; i < 200; ++i) {
    rolls.base().add_force_W({40, 0, 0}, rolls.base().p_WB());
    test.world.step();
  }
  EXPECT_EQ(test.world.physics().gravity_mps2(), 5);  // a wheel has met it
}

/// The rover of the office opens the door, which shuts behind it, pushes a chair and the trolley, and shuts the drawer.
TEST(Mechanism, OfTheOfficeDoesAsItsWorldSays) {
  test::LoadedTestWorld test(test_support::source_path("worlds/office.yaml"));
  const auto object = [&](const std::string& name) -> const sim::Mechanism& { return *test.world.find_object(name); };
  test.run_for(1);
  const auto place = [&](const std::string& name) { return sim::Vector3d(object(name).X_WV().translation()); };
  const sim::Vector3d chair1 = place("chair1"), chair2 = place("chair2"), trolley = place("trolley");
  double opened_rad = 0;
  while (test.world.now() < std::chrono::seconds(40)) {
    test.world.step();
    opened_rad = std::max(opened_rad, object("door").joint("hinge").position());
  }
  EXPECT_GT(opened_rad, 1);
  EXPECT_NEAR(object("door").joint("hinge").position(), 0, 0.01);
  EXPECT_NEAR(object("cabinet").joint("slide").position(), -0.3, 0.001);
  EXPECT_GT((place("chair1") - chair1).norm(), 0.5);
  EXPECT_GT((place("trolley") - trolley).norm(), 0.3);
  EXPECT_LT((place("chair2") - chair2).norm(), 1e-4);  // nothing met it: it rests
}

TEST(Mechanism, OfARequestHasTheLimitsOfTheWorld) {
  test::TestWorld test(world_of("", "limits: {bodies_per_vehicle: 6}\n"));
  sim::Diagnostics diagnostics;
  const auto action = sim::parse_config_text(
      "add: {object: {name: chain, bodies: [{name: a}, {name: b}, {name: c}, {name: d}, {name: e}, {name: f}, {name: "
      "g}]}}",
      "request", diagnostics);
  try {
    test.world.editor().run_action(action);
    FAIL() << "it was added";
  } catch (const sim::ConfigError& error) {
    EXPECT_THAT(error.what(), HasSubstr("at most 6 bodies in an object are allowed"));
  }
}

TEST(Mechanism, OfTheFileComesBackAlsoIfItIsLargerThanTheLimits) {
  test::TestWorld test(world_of(stool, R"(
limits: {bodies_per_vehicle: 2}
events: [{name: change, at: 0.1, do: [{remove: stool}, {add: stool}]}]
)"));
  test.run_for(0.2);
  EXPECT_EQ(object(test, "stool").bodies().size(), 7u);
}

TEST(Mechanism, OfARequestHasNoMoreJointsThanParts) {
  test::TestWorld test(world_of("", "limits: {parts: 3}\n"));
  std::string joints;
  for (int i = 0; i < 4; ++i) joints += "{name: j" + std::to_string(i) + ", type: fixed, bodies: [a, b]}, ";
  sim::Diagnostics diagnostics;
  const auto action = sim::parse_config_text(
      "add: {object: {name: knot, bodies: [{name: a, parts: [{shape: box, mass_kg: 1}]}, {name: b, parts: [{shape: "
      "box, mass_kg: 1}]}], joints: [" +
          joints + "]}}",
      "request", diagnostics);
  try {
    test.world.editor().run_action(action);
    FAIL() << "it was added";
  } catch (const sim::ConfigError& error) {
    EXPECT_THAT(error.what(), HasSubstr("at most 3 joints in an object are allowed"));
  }
}

}  // namespace
