// SPDX-License-Identifier: BSD-3-Clause
#include "devices/joint/joint_drive.hpp"

#include <gmock/gmock.h>

#include <cmath>
#include <limits>
#include <numbers>
#include <ostream>

#include "shoal/joint_settings_t.hpp"
#include "shoal/joint_state_t.hpp"
#include "sim/vehicle/mounted_device.hpp"
#include "tests/devices/state_fixture.hpp"
#include "tests/devices/world_fixture.hpp"

namespace {

constexpr double nan_ = std::numeric_limits<double>::quiet_NaN();
constexpr double infinity = std::numeric_limits<double>::infinity();
constexpr double mass_kg = 2, side_m = 0.3;
constexpr double inertia_kgm2 = mass_kg * side_m * side_m / 6;  // of a cube about any axis through its middle

/// A cube without weight whose middle is joined to a base that is as good as fixed.
constexpr const char* strong = ", max_velocity: 1000, max_force: 1.0e+6";
std::string rig(const std::string& joint, const std::string& drive = strong) {
  return R"(
shoal: 1
physics: {step_s: 0.001, gravity_mps2: 0}
vehicles:
  - name: rig
    model:
      shoal: 1
      vehicle: rig
      bodies:
        - {name: base, parts: [{shape: box, size_m: [1, 1, 1], mass_kg: 1.0e+9}]}
        - {name: cube, position_m: [2, 0, 0], parts: [{shape: box, size_m: [0.3, 0.3, 0.3], mass_kg: 2}]}
      joints:
        - {name: j, bodies: [base, cube], anchor_m: [2, 0, 0], )" +
         joint + R"(}
      devices:
        - {name: drive, type: joint_drive, joint: j)" +
         drive + "}\n";
}

struct Rig : test::TestWorld {
  explicit Rig(const std::string& joint, const std::string& drive = strong) : TestWorld(rig(joint, drive)) {}
  void set(int axis, double velocity, double max_force = nan_, double low_stop = nan_, double high_stop = nan_) {
    shoal::joint_settings_t message{};
    message.axis = static_cast<std::int8_t>(axis);
    message.velocity = velocity;
    message.max_force = max_force;
    message.low_stop = low_stop;
    message.high_stop = high_stop;
    send("rig.drive.cmd", message);
  }
  const sim::Joint& joint() const { return world.find_vehicle("rig")->joint("j"); }
  std::int64_t refused() const { return world.counts().bad_messages; }
};

/// Each axis of each type of joint.
struct DrivenAxis {
  const char* name;
  const char* joint;
  int axis;
  double inertia;  ///< what a force or a torque has to move
};
void PrintTo(const DrivenAxis& axis, std::ostream* out) {
  *out << "axis " << axis.axis << " of {" << axis.joint << "}";
}

constexpr const char* hinge2_keys = "type: hinge2, axis: [0, 0, 1], axis2: {axis: [0, 1, 0]}";
constexpr const char* universal_keys = "type: universal, axis: [0, 0, 1], axis2: {axis: [0, 1, 0]}";
const DrivenAxis axes_with_stops[] = {
    {"Hinge", "type: hinge, axis: [0, 1, 0]", 0, inertia_kgm2},
    {"Slider", "type: slider, axis: [0, 1, 0]", 0, mass_kg},
    {"Hinge2Steering", hinge2_keys, 0, inertia_kgm2},
    {"Universal0", universal_keys, 0, inertia_kgm2},
    {"Universal1", universal_keys, 1, inertia_kgm2},
    {"BallX", "type: ball, motor: true", 0, inertia_kgm2},
    {"BallY", "type: ball, motor: true", 1, inertia_kgm2},
    {"BallZ", "type: ball, motor: true", 2, inertia_kgm2},
};

/// The wheel of a hinge2 has no stops.
const DrivenAxis free_wheel = {"Hinge2Wheel", hinge2_keys, 1, inertia_kgm2};

std::string name_of(const testing::TestParamInfo<DrivenAxis>& info) {
  return info.param.name;
}

class EveryDrivenAxis : public testing::TestWithParam<DrivenAxis> {};
INSTANTIATE_TEST_SUITE_P(JointDrive, EveryDrivenAxis, testing::ValuesIn(axes_with_stops), name_of);
INSTANTIATE_TEST_SUITE_P(JointDriveOfAWheel, EveryDrivenAxis, testing::Values(free_wheel), name_of);

class EveryAxisWithStops : public testing::TestWithParam<DrivenAxis> {};
INSTANTIATE_TEST_SUITE_P(JointDrive, EveryAxisWithStops, testing::ValuesIn(axes_with_stops), name_of);

TEST_P(EveryDrivenAxis, ReachesItsVelocityAndCountsTheWay) {
  Rig rig(GetParam().joint);
  const int axis = GetParam().axis;
  rig.set(axis, 0.8);
  rig.run_for(1);
  // The motor is a constraint; 1e-6: its softness, cfm 1e-9 of a torque.  The way: there from the first step on.
  EXPECT_NEAR(rig.joint().velocity(axis), 0.8, 1e-6);
  EXPECT_NEAR(rig.joint().position(axis), 0.8, 1e-3);
  rig.set(axis, -0.3);
  rig.run_for(1);
  EXPECT_NEAR(rig.joint().velocity(axis), -0.3, 1e-6);
  EXPECT_NEAR(rig.joint().position(axis), 0.5, 2e-3);
}

TEST_P(EveryDrivenAxis, GivesNoMoreThanItsForce) {
  Rig rig(GetParam().joint);
  const int axis = GetParam().axis;
  const double force = 0.7 * GetParam().inertia;  // 0.7 rad/s^2, or m/s^2
  rig.set(axis, 1000, force);
  rig.run_for(1);
  EXPECT_NEAR(rig.joint().velocity(axis), 0.7, 1e-5);
  // Semi-implicit Euler: a t (t + dt) / 2.
  EXPECT_NEAR(rig.joint().position(axis), 0.7 * 1.001 / 2, 1e-5);
  rig.set(axis, nan_, 0);
  rig.run_for(1);
  EXPECT_NEAR(rig.joint().velocity(axis), 0.7, 1e-5) << "without force it continues";
}

TEST_P(EveryAxisWithStops, HoldsThemAndMovesThemWhileItRuns) {
  Rig rig(GetParam().joint);
  const int axis = GetParam().axis;
  rig.set(axis, 0.5, 5 * GetParam().inertia, -0.1, 0.2);
  rig.run_for(2);
  // It comes with 0.5 rad/s, at most 0.5e-3 too far, of which the stop takes back a fifth in each step.
  EXPECT_NEAR(rig.joint().position(axis), 0.2, 1e-6);
  rig.set(axis, nan_, nan_, nan_, 0.6);
  rig.run_for(2);
  EXPECT_NEAR(rig.joint().position(axis), 0.6, 1e-6);
  rig.set(axis, -0.5);
  rig.run_for(3);
  EXPECT_NEAR(rig.joint().position(axis), -0.1, 1e-6) << "the stop that was not named stays";
  rig.set(axis, nan_, nan_, -infinity, infinity);
  rig.run_for(1);
  // No stops: from rest with 5 rad/s^2 to 0.5 rad/s in 0.1 s, and on (semi-implicit Euler, as above).
  EXPECT_NEAR(rig.joint().position(axis), -(0.1 + 5 * 0.1 * 0.101 / 2 + 0.5 * 0.9), 1e-5);
  EXPECT_EQ(rig.refused(), 0);
}

TEST_P(EveryAxisWithStops, LeavesThemAtItsVelocity) {
  Rig rig(GetParam().joint);
  const int axis = GetParam().axis;
  // In a step its force makes it 5 rad/s (m/s) faster.
  rig.set(axis, 0.5, 5000 * GetParam().inertia, -0.1, 0.2);
  rig.run_for(1);
  ASSERT_NEAR(rig.joint().position(axis), 0.2, 1e-6);
  for (const double velocity : {-0.3, 0.4, -0.3}) {
    rig.set(axis, velocity);
    for (int i = 0; i < 1500; ++i) {
      rig.world.step();
      ASSERT_LE(std::abs(rig.joint().velocity(axis)), std::abs(velocity) + 1e-6) << velocity << " in step " << i;
    }
    EXPECT_NEAR(rig.joint().position(axis), velocity < 0 ? -0.1 : 0.2, 1e-6);
  }
}

TEST_P(EveryAxisWithStops, HoldsThemNearHalfATurn) {
  Rig rig(GetParam().joint);
  const int axis = GetParam().axis;
  for (const double sign : {1.0, -1.0}) {
    // With 50 rad/s it comes up to 0.05 rad too far: beyond half a turn.
    rig.set(axis, 50 * sign, 5e4 * GetParam().inertia, -3.14, 3.14);
    rig.run_for(1);
    EXPECT_NEAR(rig.joint().position(axis), 3.14 * sign, 1e-6);
    rig.set(axis, -1 * sign);
    rig.run_for(1);
    EXPECT_NEAR(rig.joint().position(axis), 2.14 * sign, 2e-3);
  }
}

TEST_P(EveryAxisWithStops, AStopThatIsSetBehindItPushesItBack) {
  Rig rig(GetParam().joint);
  const int axis = GetParam().axis;
  rig.set(axis, 0, 0, nan_, -0.2);
  rig.run_for(0.001);
  EXPECT_NEAR(rig.joint().position(axis), -0.04, 1e-4);  // a fifth of the error in a step: the world's erp
  rig.run_for(0.01);
  EXPECT_LT(rig.joint().position(axis), -0.2);  // without a motor it continues with the speed it got
}

TEST(JointDrive, TurnsABallAboutThreeAxesAtOnce) {
  Rig rig("type: ball, motor: true");
  rig.set(0, 0.2);
  rig.set(1, -0.3);
  rig.set(2, 0.5);
  rig.run_for(1);
  // The base stands still, so that a constant angular velocity gives its product with time as rotation vector.
  const double rates[] = {0.2, -0.3, 0.5};
  for (int axis = 0; axis < 3; ++axis) {
    EXPECT_NEAR(rig.joint().velocity(axis), rates[axis], 1e-6);
    EXPECT_NEAR(rig.joint().position(axis), rates[axis], 2e-3);
  }
}

TEST(JointDrive, AxesOfABallAreThoseOfTheVehicleHoweverItStands) {
  std::string turned = rig("type: ball, motor: true");
  turned.replace(turned.find("  - name: rig\n"), 14, "  - name: rig\n    rpy_deg: [20, -40, 130]\n");
  test::TestWorld test(turned);
  shoal::joint_settings_t message{};
  message.axis = 1;
  message.velocity = 0.5;
  message.max_force = message.low_stop = message.high_stop = nan_;
  test.send("rig.drive.cmd", message);
  test.run_for(1);
  const sim::Vehicle& vehicle = *test.world.find_vehicle("rig");
  const sim::Vector3d w_V = vehicle.X_WV().linear().transpose() * vehicle.body("cube").w_WB_W();
  EXPECT_NEAR((w_V - sim::Vector3d(0, 0.5, 0)).norm(), 0, 1e-6);
  EXPECT_NEAR(vehicle.joint("j").position(1), 0.5, 1e-3);
}

TEST(JointDrive, ABallToTheWorldCountsTheMovingBody) {
  std::string text = rig("type: ball, motor: true");
  text.replace(text.find("[base, cube]"), 12, "[cube, world]");
  test::TestWorld test(text);
  shoal::joint_settings_t message{};
  message.axis = 2;
  message.velocity = 0.5;
  message.max_force = 1;
  message.low_stop = nan_;
  message.high_stop = 0.25;
  test.send("rig.drive.cmd", message);
  test.run_for(0.3);
  EXPECT_NEAR(test.world.find_vehicle("rig")->body("cube").w_WB_W().z(), 0.5, 1e-6);
  test.run_for(1);
  EXPECT_NEAR(test.world.find_vehicle("rig")->joint("j").position(2), 0.25, 1e-6);
}

TEST(JointDrive, ReportsTheTorqueOfABallsMotor) {
  Rig rig("type: ball, motor: true", "}\n        - {name: state, type: joint_state, rate_hz: 100, phase_s: 0");
  test::Listener<shoal::joint_state_t> state(rig, "rig.state");
  rig.set(1, 1000, 0.02);
  rig.run_for(0.5);
  const shoal::joint_state_t last = state.last();
  EXPECT_THAT(last.joint_name, testing::ElementsAre("j", "j/1", "j/2"));
  EXPECT_NEAR(last.joint_effort[0], 0, 1e-6);
  EXPECT_NEAR(last.joint_effort[1], 0.02, 1e-6);
  EXPECT_NEAR(last.joint_effort[2], 0, 1e-6);
}

TEST(JointDrive, SetsAllItsAxesAtOnceAndLeavesTheOthers) {
  Rig rig(universal_keys, std::string(strong) + ", axes: [1]");
  rig.set(-1, 0.4);
  rig.run_for(0.5);
  EXPECT_EQ(rig.joint().motor_velocity(0), 0);
  EXPECT_NEAR(rig.joint().velocity(1), 0.4, 1e-6);
  rig.set(0, 0.4);
  rig.run_for(0.1);
  EXPECT_EQ(rig.refused(), 1);
  EXPECT_EQ(rig.joint().motor_velocity(0), 0);
}

TEST(JointDrive, CutsCommandsToItsLimits) {
  Rig rig("type: hinge", ", max_velocity: 3, max_force: 4");
  rig.set(0, 100, 100);
  rig.run_for(0.01);
  EXPECT_EQ(rig.joint().motor_velocity(), 3);
  EXPECT_EQ(rig.joint().motor_max_force(), 4);
}

TEST(JointDrive, BrakesOrCoastsWhenItsCommandsEnd) {
  for (const bool coast : {false, true}) {
    Rig rig("type: hinge", std::string(", max_force: 100, watchdog_s: 0.2, safe: ") + (coast ? "coast" : "stop"));
    rig.set(0, 2, 0.5);
    rig.run_for(1);
    EXPECT_NEAR(rig.joint().velocity(), coast ? 2 : 0, 1e-6);
    EXPECT_EQ(rig.joint().motor_max_force(), coast ? 0 : 100);
    rig.set(0, 1, 0.5);  // and it executes again
    rig.run_for(0.15);
    EXPECT_NEAR(rig.joint().velocity(), 1, 1e-6);
  }
}

TEST(JointDrive, RefusesBadCommandsAndContinues) {
  Rig rig("type: hinge");
  rig.set(0, 0.5, 3, -1, 1);
  rig.run_for(0.01);
  const struct {
    int axis;
    double velocity, max_force, low_stop, high_stop;
  } bad[] = {
      {1, 0.1, 1, nan_, nan_},    {-2, 0.1, 1, nan_, nan_},        {0, infinity, nan_, nan_, nan_},
      {0, nan_, -1, nan_, nan_},  {0, nan_, infinity, nan_, nan_}, {0, 9, 9, 2, nan_},
      {0, 9, 9, 0.5, 0.4},        {0, 9, 9, nan_, 12.6},           {0, 9, 9, infinity, nan_},
      {0, 9, 9, nan_, -infinity},
  };
  std::int64_t count = 0;
  for (const auto& each : bad) {
    rig.set(each.axis, each.velocity, each.max_force, each.low_stop, each.high_stop);
    rig.run_for(0.01);
    EXPECT_EQ(rig.refused(), ++count);
    EXPECT_EQ(rig.joint().motor_velocity(), 0.5);
    EXPECT_EQ(rig.joint().motor_max_force(), 3);
  }
  rig.run_for(3);
  EXPECT_NEAR(rig.joint().position(), 1, 1e-6) << "the stops are as they were";
}

TEST(JointDrive, TheWheelOfAHinge2HasNoStops) {
  Rig rig(hinge2_keys);
  rig.set(1, 0.5, nan_, -1, 1);
  rig.run_for(0.1);
  EXPECT_EQ(rig.refused(), 1);
  EXPECT_EQ(rig.joint().motor_velocity(1), 0);
}

/// Saved on its way, at a stop, and after the stop was moved.
TEST(JointDrive, MotorsAndStopsOutlastASnapshot) {
  for (const char* joint :
       {"type: ball, motor: true", hinge2_keys, universal_keys, "type: hinge", "type: slider, axis: [0, 1, 0]"}) {
    SCOPED_TRACE(joint);
    const std::string state = "}\n        - {name: state, type: joint_state, rate_hz: 100, phase_s: 0";
    const bool has_two = Rig(joint).joint().axes() > 1;
    test::SavedRun run(rig(joint, strong + state), [has_two](test::TappedWorld& world, int step) {
      shoal::joint_settings_t message{0, 0, 0.5, 3, nan_, nan_};
      if (step == 0) world.send("rig.drive.cmd", message);
      message = {0, 0, nan_, nan_, -0.1, 0.2};
      if (step == 250) world.send("rig.drive.cmd", message);
      message = {0, 0, nan_, nan_, nan_, 0.4};
      if (step == 600) world.send("rig.drive.cmd", message);
      message = {0, 1, 0.3, 2, nan_, nan_};
      if (step == 300 && has_two) world.send("rig.drive.cmd", message);
    });
    // At its stop after 400 and 1000 steps; what was saved before it had any is restored last there.
    run.expect_restored_worlds_go_on_alike({601, 450, 200, 0}, 500);
  }
}

TEST(JointDrive, SaysWhatIsWrongWithItsParameters) {
  using test::error_of_world;
  using testing::HasSubstr;
  EXPECT_THAT(error_of_world(rig("type: ball")), HasSubstr("joint 'j' is a ball without 'motor: true'"));
  EXPECT_THAT(error_of_world(rig("type: fixed")), HasSubstr("joint 'j' is fixed and has no axis"));
  EXPECT_THAT(error_of_world(rig("type: hinge", ", axes: [1]")), HasSubstr("joint 'j' has no axis 1, it has 1"));
  EXPECT_THAT(error_of_world(rig("type: hinge", ", axes: [0, 0]")), HasSubstr("'axes' names axis 0 twice"));
  EXPECT_THAT(error_of_world(rig("type: hinge", ", axes: [0.5]")), HasSubstr("'axes' must be whole numbers, got 0.5"));
  EXPECT_THAT(error_of_world(rig("type: hinge, motor: true")),
              HasSubstr("'motor' is for a ball; the axes of a hinge have theirs without it"));
  EXPECT_THAT(error_of_world(rig("type: ball, motor: true", "}\n        - {name: servo, type: joint_servo, joint: j")),
              HasSubstr("joint 'j' is a ball joint; a device of type joint_drive moves it"));
}

}  // namespace
