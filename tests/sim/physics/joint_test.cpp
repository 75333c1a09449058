// SPDX-License-Identifier: BSD-3-Clause
#include "sim/physics/joint.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <numbers>

#include "sim/bus/bus.hpp"
#include "sim/state/state_archive.hpp"
#include "tests/sim/physics/gravity.hpp"
#include "tests/sim/physics/small_worlds.hpp"

namespace {

using namespace small_worlds;

using std::numbers::pi;
using test::g;

/// Time between two passages of the lowest point in the same direction.
double pendulum_period(JointType type, double length_m, double amplitude_deg, double step_s) {
  PhysicsConfig config;
  config.step_s = step_s;
  const auto world = make_world(config);
  const int group = world->add_group("pendulum");
  const double amplitude = sim::degrees_to_radians(amplitude_deg);
  const Vector3d p = length_m * Vector3d(std::sin(amplitude), 0, -std::cos(amplitude));
  // A small sphere is almost a point: its own inertia adds 2/5 (r/L)^2 = 4e-7.
  sim::Body& bob = world->add_body(group, body("bob", {sphere(0.001 * length_m, 1)}, p), Pose::Identity());
  world->add_joint(group, joint("pivot", type, {0, 0, 0}, Vector3d::UnitY()), bob, nullptr, Pose::Identity());
  world->close_group(group);
  double last_x = p.x(), first_crossing = -1;
  for (int i = 0;; ++i) {
    world->step(i);
    const double x = bob.X_WB().translation().x();
    if (last_x > 0 && x <= 0) {
      const double crossing = (i + last_x / (last_x - x)) * step_s;
      if (first_crossing >= 0) return crossing - first_crossing;
      first_crossing = crossing;
    }
    last_x = x;
  }
}

// closed_forms.csv pendulum_point_mass: 2 pi sqrt(L/g) / agm(1, cos(amplitude / 2)).
TEST(Pendulum, SmallSwingHasTheClosedFormPeriod) {
  EXPECT_NEAR(pendulum_period(JointType::hinge, 1, 5, 0.001), 2.007364689, 2e-4 * 2.007364689);
  EXPECT_NEAR(pendulum_period(JointType::ball, 1, 5, 0.001), 2.007364689, 2e-4 * 2.007364689);
}
TEST(Pendulum, WideSwingTakesLonger) {
  EXPECT_NEAR(pendulum_period(JointType::hinge, 1, 60, 0.001), 2.153242352, 1e-3 * 2.153242352);
}
TEST(Pendulum, LongPendulumHasTheClosedFormPeriod) {
  EXPECT_NEAR(pendulum_period(JointType::hinge, 2.5, 20, 0.001), 3.196740948, 2e-4 * 3.196740948);
}

TEST(HingeJoint, MotorTurnsTheSecondBodyRightHandedAboutTheAxis) {
  CubePair rig(joint("elbow", JointType::hinge, {1, 0, 0}, Vector3d::UnitY()));
  EXPECT_EQ(rig.joint->axes(), 1);
  rig.joint->set_motor(2, 1000);
  rig.run(50);
  EXPECT_NEAR(rig.joint->velocity(), 2, 1e-6);
  EXPECT_NEAR(rig.joint->position(), 1, 1e-6);
  EXPECT_GT(rig.arm->w_WB_W().y(), 1.9);
}

TEST(HingeJoint, ToAFixedBodyCountsTheSameWay) {
  CubePair rig(joint("elbow", JointType::hinge, {1, 0, 0}, Vector3d::UnitY()), true);
  rig.joint->set_motor(2, 1000);
  rig.run(50);
  EXPECT_NEAR(rig.joint->position(), 1, 1e-6);
  EXPECT_NEAR(rig.arm->w_WB_W().y(), 2, 1e-6);
}

TEST(HingeJoint, ToTheWorldCountsTheMovingBody) {
  const auto world = make_world(weightless());
  const int group = world->add_group("rig");
  sim::Body& fan = world->add_body(group, body("fan", {box({1, 1, 0.1}, 1)}), Pose::Identity());
  sim::Joint& axle =
      world->add_joint(group, joint("axle", JointType::hinge, {0, 0, 0}), fan, nullptr, Pose::Identity());
  world->close_group(group);
  axle.set_motor(3, 1000);
  for (int i = 0; i < 100; ++i) world->step(i);
  EXPECT_NEAR(axle.position(), 3, 1e-6);
  EXPECT_NEAR(fan.w_WB_W().z(), 3, 1e-6);
}

TEST(HingeJoint, PositionContinuesBeyondPi) {
  CubePair rig(joint("wheel", JointType::hinge, {1, 0, 0}, Vector3d::UnitY()));
  rig.joint->set_motor(10, 1000);
  rig.run(1000);
  // A motor without limit of force runs at its speed from the first step.  The finite rotation is exact.
  EXPECT_NEAR(rig.joint->position(), 100, 1e-5);
  rig.joint->set_motor(-10, 1000);
  rig.run(2000);
  EXPECT_NEAR(rig.joint->position(), -100, 1e-3);
}

TEST(HingeJoint, PositionFollowsAWheelThatTurnsMoreThanHalfATurnInAStep) {
  CubePair rig(joint("wheel", JointType::hinge, {1, 0, 0}, Vector3d::UnitY()));
  rig.joint->set_motor(500, 1e6);  // 5 rad in a step
  rig.run(100);
  EXPECT_NEAR(rig.joint->position(), 500, 1e-3);
}

TEST(HingeJoint, MotorIsLimitedByItsForce) {
  CubePair rig(joint("wheel", JointType::hinge, {1, 0, 0}, Vector3d::UnitY()), true);
  rig.joint->set_motor(1000, 0.1);
  rig.run(10);
  const double inertia = 0.2 * 0.2 / 6;
  EXPECT_NEAR(rig.joint->velocity(), 0.1 / inertia * 0.1, 1e-6);  // torque / inertia * time
}

TEST(HingeJoint, StopsHold) {
  JointConfig config = joint("elbow", JointType::hinge, {1, 0, 0}, Vector3d::UnitY());
  config.axis1.low_stop = -0.25;
  config.axis1.high_stop = 0.5;
  CubePair rig(config);
  rig.joint->set_motor(1, 10);
  rig.run(500);
  EXPECT_NEAR(rig.joint->position(), 0.5, 1e-3);
  rig.joint->set_motor(-1, 10);
  rig.run(500);
  EXPECT_NEAR(rig.joint->position(), -0.25, 1e-3);
}

TEST(HingeJoint, EffortIsATorqueOnTheSecondBody) {
  CubePair rig(joint("wheel", JointType::hinge, {1, 0, 0}, Vector3d::UnitY()), true);
  rig.joint->add_effort(0.5);
  rig.run(1);
  EXPECT_NEAR(rig.joint->velocity(), 0.5 / (0.04 / 6) * 0.01, 1e-7);
  rig.run(1);  // an effort lasts one step
  EXPECT_NEAR(rig.joint->velocity(), 0.5 / (0.04 / 6) * 0.01, 1e-7);
}

TEST(SliderJoint, MotorMovesTheSecondBodyAlongTheAxis) {
  for (const bool to_world : {false, true}) {
    CubePair rig(joint("rail", JointType::slider, {0, 0, 0}, Vector3d::UnitX()), to_world);
    rig.joint->set_motor(0.5, 1e4);
    rig.run(100);
    EXPECT_NEAR(rig.joint->position(), 0.5, 1e-5);
    EXPECT_NEAR(rig.joint->velocity(), 0.5, 1e-6);
    EXPECT_NEAR(rig.arm->X_WB().translation().x() - rig.base->X_WB().translation().x(), 1.5, 1e-5);
  }
}

TEST(SliderJoint, StopsHold) {
  JointConfig config = joint("rail", JointType::slider, {0, 0, 0}, Vector3d::UnitX());
  config.axis1.low_stop = -0.1;
  config.axis1.high_stop = 0.2;
  CubePair rig(config);
  rig.joint->set_motor(1, 10);
  rig.run(300);
  EXPECT_NEAR(rig.joint->position(), 0.2, 1e-3);
  rig.joint->set_motor(-1, 10);
  rig.run(300);
  EXPECT_NEAR(rig.joint->position(), -0.1, 1e-3);
}

TEST(SliderJoint, EffortIsAForce) {
  CubePair rig(joint("rail", JointType::slider, {0, 0, 0}, Vector3d::UnitX()), true);
  rig.joint->add_effort(3);
  rig.run(1);
  EXPECT_NEAR(rig.joint->velocity(), 3.0 / 1 * 0.01, 1e-7);
}

TEST(FixedJoint, CarriesTheSecondBody) {
  CubePair rig(joint("weld", JointType::fixed, {0, 0, 0}));
  EXPECT_EQ(rig.joint->axes(), 0);
  rig.base->set_velocity_W({0, 0, 1}, {0, 0, 0});
  rig.arm->set_velocity_W({0, 0, 1}, {0, 0, 0});
  rig.arm->add_force_W({0, 0, -100}, {1, 0, 0});
  rig.run(100);
  const Pose X_base_arm = rig.base->X_WB().inverse() * rig.arm->X_WB();
  EXPECT_TRUE(X_base_arm.isApprox(translation(1, 0, 0), 1e-4)) << X_base_arm.matrix();
}

TEST(BallJoint, KeepsThePointTogetherAndLeavesTheRotationFree) {
  CubePair rig(joint("shoulder", JointType::ball, {0.9, 0, 0}));
  EXPECT_EQ(rig.joint->axes(), 0);
  rig.arm->add_torque_W({0.1, 0.2, 0.3});
  rig.run(200);
  const Vector3d on_base = rig.base->X_WB() * Vector3d(0.9, 0, 0), on_arm = rig.arm->X_WB() * Vector3d(-0.1, 0, 0);
  EXPECT_LT((on_base - on_arm).norm(), 1e-3);
  EXPECT_GT(rig.arm->w_WB_W().norm(), 0.1);
}

TEST(BallJoint, ItsMotorTurnsTheSecondBodyAboutTheAxesOfTheFirst) {
  for (const bool to_fixed : {false, true}) {
    JointConfig config = joint("shoulder", JointType::ball, {1, 0, 0});
    config.motor = true;
    CubePair rig(config, to_fixed);
    ASSERT_EQ(rig.joint->axes(), 3);
    for (int axis = 0; axis < 3; ++axis) rig.joint->set_motor(axis == 1 ? 0.5 : 0, 1000, axis);
    rig.run(100);
    EXPECT_NEAR(rig.joint->velocity(1), 0.5, 1e-3);
    EXPECT_NEAR(rig.joint->position(1), 0.5, 5e-3);
    EXPECT_NEAR(rig.joint->position(0), 0, 1e-3);
    EXPECT_GT(rig.arm->w_WB_W().y(), 0.49);
    rig.joint->set_stops(-0.1, 0.2, 1);
    rig.run(100);
    EXPECT_NEAR(rig.joint->position(1), 0.2, 1e-6);
    rig.joint->set_motor(0, 0, 1);
    rig.joint->set_stops(std::nullopt, std::nullopt, 1);
    rig.joint->add_effort(0.01, 1);
    rig.run(1);
    EXPECT_NEAR(rig.joint->velocity(1), 0.01 * 0.01 / (1 * 0.2 * 0.2 / 6), 1e-3);  // torque * step / inertia
  }
}

TEST(BallJoint, ABodyThatIsMovedTakesItsTurnedBallAlong) {
  PhysicsConfig config = weightless();
  const auto world = make_world(config);
  const int group = world->add_group("rig");
  sim::Body& arm = world->add_body(group, body("arm", {box({0.2, 0.2, 0.2}, 1)}, {1, 0, 0}), Pose::Identity());
  JointConfig ball = joint("shoulder", JointType::ball, {1, 0, 0});
  ball.motor = true;
  sim::Joint& shoulder = world->add_joint(group, ball, arm, nullptr, Pose::Identity());
  world->close_group(group);
  for (int axis = 0; axis < 3; ++axis) shoulder.set_motor(axis == 2 ? 0.5 : 0, 1000, axis);
  shoulder.set_stops(-0.1, 0.5, 2);  // it comes to the upper one
  for (int i = 0; i < 200; ++i) world->step(i);
  world->move_group(group, sim::make_pose({5, 6, 7}, {0.3, -0.2, 1}), false);
  EXPECT_EQ(shoulder.motor_velocity(2), 0.5);
  world->step(200);
  EXPECT_NEAR(shoulder.velocity(2), 0, 1e-6) << "it is at its stop";
  shoulder.set_stops(-0.1, std::nullopt, 2);
  for (int axis = 0; axis < 3; ++axis) shoulder.set_motor(0, 1000, axis);
  for (int i = 201; i < 300; ++i) world->step(i);
  EXPECT_NEAR(shoulder.position(2), 0.5, 6e-3);
  EXPECT_NEAR(shoulder.position(0), 0, 1e-6);
  EXPECT_NEAR(arm.w_WB_W().norm(), 0, 1e-6);
}

sim::Bytes saved(sim::Joint& joint) {
  sim::StateArchive archive = sim::StateArchive::saver();
  archive(joint);
  return archive.take_bytes();
}

void restore(sim::Joint& joint, const sim::Bytes& bytes) {
  sim::StateArchive archive = sim::StateArchive::restorer(bytes);
  archive(joint);
  EXPECT_EQ(archive.bytes_left(), 0u);
}

JointConfig joint_of_type(JointType type) {
  // Along x, where a force does not turn the two.
  JointConfig config = joint("j", type, {1, 0, 0}, type == JointType::slider ? Vector3d::UnitX() : Vector3d::UnitY());
  config.axis2.axis = Vector3d::UnitZ();
  config.motor = type == JointType::ball;
  return config;
}

TEST(RestoredJoint, StandsAtNoStopThatItGotLater) {
  for (const JointType type :
       {JointType::hinge, JointType::slider, JointType::universal, JointType::hinge2, JointType::ball}) {
    SCOPED_TRACE(std::string(word_of(sim::joint_type_words, type)));
    CubePair rig(joint_of_type(type));
    const sim::Bytes before = saved(*rig.joint);
    rig.joint->set_stops(-0.1, 0.2);
    rig.joint->set_motor(0.5, 10);
    rig.run(100);
    EXPECT_NEAR(rig.joint->position(), 0.2, 1e-3);
    restore(*rig.joint, before);
    EXPECT_TRUE(saved(*rig.joint) == before);
    rig.joint->set_motor(0.5, 10);
    rig.run(20);
    EXPECT_NEAR(rig.joint->velocity(), 0.5, 1e-3);
  }
}

TEST(RestoredJoint, HasTheStopsOfItsConfigurationUnlessTheyWereSet) {
  JointConfig config = joint_of_type(JointType::hinge);
  config.axis1.low_stop = -0.1;
  config.axis1.high_stop = 0.2;
  CubePair original(config);
  const sim::Bytes as_configured = saved(*original.joint);
  original.joint->set_stops(-0.1, 0.25);
  const sim::Bytes as_set = saved(*original.joint);
  config.axis1.high_stop = 0.3;
  for (const bool set : {false, true}) {
    CubePair other(config);
    restore(*other.joint, set ? as_set : as_configured);
    other.joint->set_motor(0.5, 10);
    other.run(100);
    EXPECT_NEAR(other.joint->position(), set ? 0.25 : 0.3, 1e-3);
  }
}

TEST(RestoredJoint, MeasuresNoLoadWhereNoneWasMeasured) {
  CubePair rig(joint_of_type(JointType::hinge));
  const sim::Bytes before = saved(*rig.joint);
  rig.joint->measure_load();
  rig.joint->set_motor(0.5, 10);
  rig.run(3);
  const sim::Bytes measured = saved(*rig.joint);
  EXPECT_NE(rig.joint->force_W_N().norm() + rig.joint->torque_W_Nm().norm(), 0);
  const Vector3d torque_Nm = rig.joint->torque_W_Nm();
  restore(*rig.joint, before);
  rig.run(3);
  EXPECT_EQ(rig.joint->torque_W_Nm(), Vector3d(0, 0, 0));
  restore(*rig.joint, measured);
  EXPECT_EQ(rig.joint->torque_W_Nm(), torque_Nm);
  rig.joint->add_effort(0.01);
  rig.run(1);
  EXPECT_NE(rig.joint->effort(), 0);
}

TEST(RestoredJoint, RefusesNumbersThatAreNotFinite) {
  CubePair rig(joint_of_type(JointType::hinge));
  const sim::Bytes good = saved(*rig.joint);
  const double nan_ = std::nan("");
  sim::Bytes bad = good;
  std::memcpy(bad.data() + 1, &nan_, sizeof nan_);  // its position, after the flag of its stops
  sim::StateArchive archive = sim::StateArchive::restorer(bad);
  EXPECT_THROW(archive(*rig.joint), sim::SnapshotError);
}

TEST(JointAtItsStop, IsHeldAgainstALoadThatItsMotorCannotLift) {
  // The load pushes with 3 into the low stop; the motor drives away from it with at most 2, later with at most 4.
  for (const JointType type :
       {JointType::hinge, JointType::slider, JointType::universal, JointType::hinge2, JointType::ball})
    for (const bool to_fixed : {false, true}) {
      if (to_fixed && type == JointType::hinge2) continue;  // it joins two bodies that move
      SCOPED_TRACE(std::string(word_of(sim::joint_type_words, type)));
      JointConfig config = joint_of_type(type);
      config.axis1.low_stop = 0;
      CubePair rig(config, to_fixed);
      const auto run = [&](double max_force, int steps) {
        rig.joint->set_motor(0.5, max_force);
        for (int i = 0; i < steps; ++i) {
          rig.joint->add_effort(-3);
          rig.run(1);
        }
      };
      run(2, 300);
      EXPECT_NEAR(rig.joint->position(), 0, 1e-6);
      EXPECT_NEAR(rig.joint->velocity(), 0, 1e-6);
      run(4, 1);
      EXPECT_LE(rig.joint->velocity(), 0.5 + 1e-6);
      run(4, 100);
      EXPECT_NEAR(rig.joint->velocity(), 0.5, 1e-6);
    }
}

TEST(JointAtItsStop, AChainOfVeryLightLinksIsSolvedExactly) {
  // Links of 0.1 g and 5 mm under their weight, whose motors drive slowly away from their stops.
  for (const double step_s : {0.01, 0.002}) {
    const auto world = make_world(with_step(step_s));
    const int group = world->add_group("finger");
    sim::Body* last = &world->add_body(group, body("palm", {box({0.1, 0.1, 0.1}, 1)}), Pose::Identity(), Motion::fixed);
    std::vector<sim::Joint*> joints;
    for (int i = 0; i < 6; ++i) {
      const Vector3d middle = {0.05 + 0.005 * (i + 0.5), 0, 0};
      sim::Body& link = world->add_body(
          group, body("link" + std::to_string(i), {box({0.005, 0.005, 0.005}, 1e-4)}, middle), Pose::Identity());
      JointConfig config = joint("joint" + std::to_string(i), JointType::hinge, middle - Vector3d(0.0025, 0, 0),
                                 i % 2 == 0 ? Vector3d::UnitY() : Vector3d(0, -1, 0));
      (i % 2 == 0 ? config.axis1.high_stop : config.axis1.low_stop) = 0;
      joints.push_back(&world->add_joint(group, config, *last, &link, Pose::Identity()));
      last = &link;
    }
    world->close_group(group);
    for (int step = 0; step < 100; ++step) {
      for (std::size_t i = 0; i < joints.size(); ++i) joints[i]->set_motor(i % 2 == 0 ? -0.01 : 0.01, 2);
      world->step(step);
      for (const sim::Joint* each : joints) ASSERT_LE(std::abs(each->velocity()), 0.0101) << each->name();
    }
    EXPECT_EQ(world->quick_steps(), 0);
  }
}

TEST(JointAtItsStop, AGripperThatHoldsOnItIsSolvedExactly) {
  // Two fingers of 30 g on the front of a palm, whose servos hold at their stops: velocities of rounding errors.
  const auto world = make_world(with_step(0.002));
  const int group = world->add_group("gripper");
  sim::Body& palm = world->add_body(group, body("palm", {box({0.1, 0.1, 0.1}, 1)}), Pose::Identity());
  world->add_joint(group, joint("mount", JointType::fixed, {0, 0, 0}), palm, nullptr, Pose::Identity());
  std::vector<sim::Joint*> fingers;
  for (const double side : {1.0, -1.0}) {
    const std::string name = side > 0 ? "left" : "right";
    sim::Body& finger =
        world->add_body(group, body(name, {box({0.06, 0.01, 0.02}, 0.03)}, {0.08, 0.04 * side, 0}), Pose::Identity());
    JointConfig config = joint(name, JointType::slider, {0, 0, 0}, {0, -side, 0});
    config.axis1.low_stop = 0;
    fingers.push_back(&world->add_joint(group, config, palm, &finger, Pose::Identity()));
  }
  world->close_group(group);
  for (int step = 0; step < 5000; ++step) {
    for (sim::Joint* finger : fingers) finger->set_motor(-20 * finger->position(), 15);
    world->step(step);
    for (const sim::Joint* finger : fingers) ASSERT_LT(std::abs(finger->velocity()), 1e-6);
  }
  EXPECT_EQ(world->quick_steps(), 0);
}

TEST(JointAtItsStop, TheFudgeFactorIsThePartOfTheForceWithWhichTheMotorLeavesIt) {
  JointConfig config = joint_of_type(JointType::hinge);
  config.axis1.low_stop = 0;
  config.axis1.fudge_factor = 0.25;
  CubePair rig(config, true);
  rig.joint->set_motor(1000, 0.4);
  rig.run(1);
  EXPECT_NEAR(rig.joint->velocity(), 0.25 * 0.4 / (0.04 / 6) * 0.01, 1e-6);  // torque / inertia * time
}

TEST(JointAtItsStop, EqualStopsAreAConstraintThatTheMotorDoesNotMove) {
  JointConfig config = joint_of_type(JointType::hinge);
  config.axis1.low_stop = config.axis1.high_stop = 0;
  CubePair rig(config, true);
  for (const double velocity : {1.0, -1.0}) {
    rig.joint->set_motor(velocity, 100);
    rig.run(100);
    EXPECT_NEAR(rig.joint->position(), 0, 1e-6);
  }
}

TEST(BallJoint, PositionContinuesBeyondHalfATurn) {
  JointConfig config = joint_of_type(JointType::ball);
  CubePair rig(config);
  for (const double rate : {2.0, -2.0}) {
    for (int axis = 0; axis < 3; ++axis) rig.joint->set_motor(axis == 1 ? rate : 0, 1000, axis);
    rig.run(200);
    EXPECT_NEAR(rig.joint->position(1), rate > 0 ? 4 : 0, 0.02);  // its body turns by an approximation of ODE
    EXPECT_NEAR(rig.joint->position(0), 0, 1e-3);
  }
}

TEST(BallJoint, ErpIsTheShareOfItsGapThatAStepCloses) {
  // On its circle of 1 m the arm leaves along the tangent in each step, and the joint takes back a share of the gap:
  // the gap is inversely proportional to that share.
  const auto gap = [](double erp) {
    JointConfig config = joint("tether", JointType::ball, {0, 0, 0});
    config.axis1.erp = erp;
    CubePair rig(config, true);
    rig.arm->set_velocity_W({0, 2, 0}, {0, 0, 2});
    rig.run(200);
    return (rig.arm->X_WB() * Vector3d(-1, 0, 0)).norm();
  };
  EXPECT_GT(gap(0.1), 1e-4);
  EXPECT_NEAR(gap(0.1) / gap(0.8), 8, 0.8);
}

TEST(UniversalJoint, EachAxisHasItsMotor) {
  JointConfig config = joint("cardan", JointType::universal, {1, 0, 0}, Vector3d::UnitY());
  config.axis2.axis = Vector3d::UnitZ();
  for (const int axis : {0, 1}) {
    CubePair rig(config);
    EXPECT_EQ(rig.joint->axes(), 2);
    rig.joint->set_motor(0.5, 1000, axis);
    rig.joint->set_motor(0, 1000, 1 - axis);
    rig.run(100);
    EXPECT_NEAR(rig.joint->position(axis), 0.5, 1e-3) << axis;
    EXPECT_NEAR(rig.joint->velocity(axis), 0.5, 1e-3) << axis;
    EXPECT_NEAR(rig.joint->position(1 - axis), 0, 1e-3) << axis;
    EXPECT_GT(rig.arm->w_WB_W()[axis + 1], 0.4) << axis;
  }
}

TEST(Hinge2Joint, SteersAndRolls) {
  JointConfig config = joint("front", JointType::hinge2, {1, 0, 0}, Vector3d::UnitZ());
  config.axis2.axis = Vector3d::UnitY();
  config.axis1.low_stop = -0.6;
  config.axis1.high_stop = 0.4;
  CubePair rig(config);
  EXPECT_EQ(rig.joint->axes(), 2);
  rig.joint->set_motor(0, 1000, 1);
  rig.joint->set_motor(1, 10, 0);
  rig.run(100);
  EXPECT_NEAR(rig.joint->position(0), 0.4, 0.01);
  EXPECT_NEAR(sim::yaw_of(rig.arm->X_WB().linear()), 0.4, 0.01);
  rig.joint->set_motor(-1, 10, 0);
  rig.run(300);
  EXPECT_NEAR(rig.joint->position(0), -0.6, 0.01);

  CubePair straight(config);
  straight.joint->set_motor(0, 1000, 0);
  straight.joint->set_motor(5, 1000, 1);
  straight.run(200);
  EXPECT_NEAR(straight.joint->position(1), 10, 1e-2);
  EXPECT_NEAR(straight.joint->velocity(1), 5, 1e-3);
  EXPECT_GT(straight.arm->w_WB_W().y(), 4.9);
}

TEST(Joint, WheelWithPositiveSpeedRollsForward) {
  const auto world = make_world({}, {slippery()});
  add_ground(*world);
  Rover rover = add_rover(*world, "rover", Pose::Identity());
  for (sim::Joint* wheel : {rover.left, rover.right}) wheel->set_motor(5, 10);
  for (int i = 0; i < 300; ++i) world->step(i);
  // 3 s at 5 rad/s on wheels of 0.1 m; the start slips by less than 1 %.
  EXPECT_NEAR(rover.chassis->X_WB().translation().x(), 1.5, 0.02);
  EXPECT_NEAR(rover.chassis->X_WB().translation().y(), 0, 1e-6);
  EXPECT_NEAR(rover.left->position(), 15, 0.1);
}

TEST(Joint, PartsOfJoinedBodiesDoNotCollide) {
  // The arm is inside the base, and the group asks for self collision.
  const auto world = make_world(weightless());
  const int group = world->add_group("rig", true);
  sim::Body& base = world->add_body(group, body("base", {box({1, 1, 1}, 1)}), Pose::Identity());
  sim::Body& arm = world->add_body(group, body("arm", {box({1, 1, 1}, 1)}, {0.3, 0, 0}), Pose::Identity());
  world->add_joint(group, joint("weld", JointType::fixed, {0, 0, 0}), base, &arm, Pose::Identity());
  world->close_group(group);
  world->step(0);
  EXPECT_EQ(world->last_step().contacts, 0);
}

TEST(Joint, BetweenFixedBodiesIsAConfigError) {
  const auto world = make_world();
  const int group = world->add_group("rig");
  sim::Body& base = world->add_body(group, body("base", {box({1, 1, 1}, 1)}), Pose::Identity(), Motion::fixed);
  EXPECT_THROW(world->add_joint(group, joint("weld", JointType::hinge, {0, 0, 0}), base, nullptr, Pose::Identity()),
               sim::ConfigError);
}

TEST(BoxPendulum, HasTheClosedFormPeriod) {
  // closed_forms.csv box_pendulum_small: 2 pi sqrt(I / (m g d)), I = m (l^2 + w^2) / 12 + m d^2, d = l / 2.
  const double l = 1.2, d = 0.6, w = 0.1, step_s = 0.001;
  EXPECT_NEAR(2 * pi * std::sqrt(((l * l + w * w) / 12 + d * d) / (g * d)), 1.796144153, 1e-9);
  PhysicsConfig config;
  config.step_s = step_s;
  const auto world = make_world(config);
  const int group = world->add_group("pendulum");
  const Pose X_WV = sim::make_pose({0, 0, 0}, {0, 0.01, 0});
  sim::Body& beam = world->add_body(group, body("beam", {at(box({w, w, l}, 2), {0, 0, -d})}), X_WV);
  sim::Joint& pivot =
      world->add_joint(group, joint("pivot", JointType::hinge, {0, 0, 0}, Vector3d::UnitY()), beam, nullptr, X_WV);
  world->close_group(group);
  double last = pivot.position() + 0.01, first_crossing = -1, period = 0;
  for (int i = 0; i < 5000 && period == 0; ++i) {
    world->step(i);
    const double angle = pivot.position() + 0.01;  // from hanging straight down
    if (last > 0 && angle <= 0) {
      const double crossing = (i + last / (last - angle)) * step_s;
      if (first_crossing >= 0) period = crossing - first_crossing;
      first_crossing = crossing;
    }
    last = angle;
  }
  EXPECT_NEAR(period, 1.796144153, 5e-4 * 1.796144153);
}

}  // namespace
