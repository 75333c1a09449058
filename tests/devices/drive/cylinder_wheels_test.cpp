// SPDX-License-Identifier: BSD-3-Clause
// Vehicles on cylinders and capsules turn as those on spheres: about the middles of their wheels.

#include <gmock/gmock.h>
#include <spdlog/fmt/fmt.h>

#include <cmath>
#include <string>
#include <vector>

#include "devices/drive/two_sided_drive.hpp"
#include "shoal/imu_t.hpp"
#include "sim/vehicle/mounted_device.hpp"
#include "sim/vehicle/vehicle.hpp"
#include "tests/devices/drive/drive_support.hpp"

namespace {

constexpr double steps_s[] = {0.01, 0.005, 0.002};

/// A robot whose wheels have these middles, above the ground by their radius.
struct WheeledRobot {
  std::string tread;  ///< shape and width, such as `shape: cylinder, length_m: 0.06`
  double radius_m = 0.04, wheel_kg = 0.2;
  std::vector<sim::Vector3d> left, right;
  std::string base;  ///< parts of the base, whose frame is that of the vehicle
  std::string drive, more = "";
  std::string ground = "{shape: plane}", contacts = "";

  std::string world(double step_s) const {
    std::string bodies, joints, names[2];
    const std::vector<sim::Vector3d>* sides[] = {&left, &right};
    for (const int side : {0, 1})
      for (const sim::Vector3d& at : *sides[side]) {
        const std::string name = "w" + std::to_string(names[0].size() + names[1].size());
        names[side] += (names[side].empty() ? "" : ", ") + name;
        bodies += fmt::format(
            "        - {{name: {}_wheel, position_m: [{}, {}, {}], parts: [{{{}, radius_m: {}, rpy_deg: [90, 0, 0], "
            "mass_kg: {}}}]}}\n",
            name, at.x(), at.y(), radius_m, tread, radius_m, wheel_kg);
        joints +=
            fmt::format("        - {{name: {0}, type: hinge, bodies: [base, {0}_wheel], axis: [0, 1, 0]}}\n", name);
      }
    const bool one = left.size() == 1;
    return fmt::format(R"(
shoal: 1
physics: {{step_s: {}}}
materials: [{{name: slick}}]
contacts: [{{between: [slick, any], friction: 0}}{}]
objects: [{{name: ground, fixed: true, parts: [{}]}}]
vehicles:
  - name: r1
    model:
      shoal: 1
      vehicle: wheeled
      bodies:
        - {{name: base, parts: [{}]}}
{}      joints:
{}      devices:
        - {{name: drive, type: {}, {}: [{}], {}: [{}], max_torque_Nm: 50{}}}
{})",
                       step_s, contacts, ground, base, bodies, joints, one ? "differential_drive" : "skid_steer",
                       one ? "left_joint" : "left_joints", names[0], one ? "right_joint" : "right_joints", names[1],
                       drive, more);
  }
};

/// `left_joint: [a]` is written as `left_joint: a`.
std::string one_joint(std::string yaml) {
  for (const char* key : {"left_joint: [", "right_joint: ["})
    if (const std::size_t at = yaml.find(key); at != std::string::npos) {
      const std::size_t open = yaml.find('[', at), close = yaml.find(']', at);
      yaml.erase(close, 1).erase(open, 1);
    }
  return yaml;
}

/// Two wheels and a caster that slides.
WheeledRobot two_wheels(const std::string& tread) {
  WheeledRobot robot;
  robot.tread = tread;
  robot.left = {{0, 0.15, 0}};
  robot.right = {{0, -0.15, 0}};
  robot.base =
      "{shape: box, size_m: [0.3, 0.2, 0.1], position_m: [0.03, 0, 0.09], mass_kg: 4}, "
      "{shape: sphere, radius_m: 0.02, position_m: [0.12, 0, 0.02], material: slick}";
  return robot;
}

/// Sizes and masses of the TurtleBot3 Burger (ROBOTIS e-Manual): its rear slides on a small box.
WheeledRobot burger() {
  WheeledRobot robot;
  robot.tread = "shape: cylinder, length_m: 0.018";
  robot.radius_m = 0.033;
  robot.wheel_kg = 0.0285;
  robot.left = {{0, 0.08, 0}};
  robot.right = {{0, -0.08, 0}};
  robot.base =
      "{shape: box, size_m: [0.14, 0.14, 0.143], position_m: [-0.032, 0, 0.08], mass_kg: 0.826}, "
      "{shape: box, size_m: [0.03, 0.009, 0.02], position_m: [-0.081, 0, 0.0101], material: slick}";
  return robot;
}

/// Four wheels at (+-a, +-b) around the middle of the base, with its center of mass beside it.
WheeledRobot four_wheels(double a_m, double b_m, double radius_m, double width_m, double wheel_kg, double base_kg,
                         const std::string& center_m) {
  WheeledRobot robot;
  robot.tread = fmt::format("shape: cylinder, length_m: {}", width_m);
  robot.radius_m = radius_m;
  robot.wheel_kg = wheel_kg;
  robot.left = {{a_m, b_m, 0}, {-a_m, b_m, 0}};
  robot.right = {{a_m, -b_m, 0}, {-a_m, -b_m, 0}};
  robot.base = fmt::format("{{shape: box, size_m: [0.4, 0.3, 0.1], position_m: {}, mass_kg: {}}}", center_m, base_kg);
  return robot;
}

/// Sizes and masses of the descriptions of Clearpath's Jackal and Husky.
WheeledRobot jackal() {
  return four_wheels(0.131, 0.187795, 0.098, 0.04, 0.477, 16.523, "[0.012, 0.002, 0.13]");
}
WheeledRobot husky() {
  return four_wheels(0.256, 0.2854, 0.1651, 0.1143, 2.637, 46.034, "[0, -0.085, 0.22]");
}

struct Turn {
  double rate_radps = 0;
  double radius_m = 0;  ///< of the circle of the vehicle's origin
};

/// What a robot does on the spot, over 8 s after one of getting going.
Turn turn_of(const WheeledRobot& robot, double step_s, double commanded_radps) {
  const test_support::LogCapture log;
  test::TestWorld test(one_joint(robot.world(step_s)));
  test.send("r1.drive.cmd", test::twist(0, commanded_radps));
  test.run_for(1);
  const sim::Vehicle& vehicle = *test.world.find_vehicle("r1");
  double turned_rad = 0, distance_m = 0;
  for (int i = 0; i < 80; ++i) {
    const sim::Pose before = vehicle.X_WV();
    test.run_for(0.1);
    const sim::Pose moved = before.inverse() * vehicle.X_WV();
    turned_rad += sim::yaw_of(moved.linear());
    distance_m += moved.translation().head<2>().norm();
  }
  EXPECT_EQ(log.text(), "");
  return {turned_rad / 8, distance_m / std::abs(turned_rad)};
}

class CylinderWheels : public testing::TestWithParam<double> {};

TEST_P(CylinderWheels, OfAnyWidthTurnARobotAsTheirMiddlesDo) {
  for (const char* tread :
       {"shape: sphere", "shape: cylinder, length_m: 0.01", "shape: cylinder, length_m: 0.03",
        "shape: cylinder, length_m: 0.06", "shape: cylinder, length_m: 0.08", "shape: capsule, length_m: 0.06"})
    EXPECT_NEAR(turn_of(two_wheels(tread), GetParam(), 0.8).rate_radps, 0.8, 0.02 * 0.8) << tread;
}

TEST_P(CylinderWheels, TurnOnABoxAndOnTerrainToo) {
  WheeledRobot robot = two_wheels("shape: cylinder, length_m: 0.06");
  for (const char* ground : {"{shape: box, size_m: [4, 4, 1], position_m: [0, 0, -0.5]}",
                             "{shape: terrain, terrain: {source: slope, size_m: [4, 4], cell_m: 0.1}}"}) {
    robot.ground = ground;
    EXPECT_NEAR(turn_of(robot, GetParam(), 0.8).rate_radps, 0.8, 0.02 * 0.8) << ground;
  }
}

/// They rest up to half a millimeter deep, and roll on their radius all the same.
TEST_P(CylinderWheels, SpheresRollAsFarOnABoxAsOnAPlane) {
  WheeledRobot robot = two_wheels("shape: sphere");
  robot.radius_m = 0.01;
  for (const char* ground : {"{shape: plane}", "{shape: box, size_m: [4, 4, 1], position_m: [0, 0, -0.5]}"}) {
    robot.ground = ground;
    test::TestWorld test(one_joint(robot.world(GetParam())));
    test.send("r1.drive.cmd", test::twist(0.1, 0));
    test.run_for(1);
    const double start_m = test.world.find_vehicle("r1")->X_WV().translation().x();
    test.run_for(4);
    EXPECT_NEAR(test.world.find_vehicle("r1")->X_WV().translation().x() - start_m, 0.4, 0.003 * 0.4) << ground;
  }
}

TEST_P(CylinderWheels, TurnOnSoftGroundToo) {
  WheeledRobot robot = two_wheels("shape: cylinder, length_m: 0.08");
  robot.contacts = ", {between: [any, any], soft_cfm: 1e-5}, {between: [slick, any], friction: 0, soft_cfm: 1e-5}";
  EXPECT_NEAR(turn_of(robot, GetParam(), 0.5).rate_radps, 0.5, 0.02 * 0.5);
}

TEST_P(CylinderWheels, TurnARobotOfTheSizeOfATurtleBot) {
  EXPECT_NEAR(turn_of(burger(), GetParam(), 0.5).rate_radps, 0.5, 0.02 * 0.5);
}

/// A quasi-static balance of Coulomb's friction under the middles of four wheels, with the loads of the center of mass,
/// has 0.3065 rad/s and 0.2678 rad/s at 0.134 m for a track of 2 (b + a^2 / b); the whole lines under the wheels have
/// 0.3054 and 0.2655.
TEST_P(CylinderWheels, OfSkidSteeredRobotsTurnThemAsTheirMiddlesDo) {
  EXPECT_NEAR(turn_of(jackal(), GetParam(), 0.3).rate_radps, 0.3065, 0.02 * 0.3065);
  const Turn of_husky = turn_of(husky(), GetParam(), 0.3);
  EXPECT_NEAR(of_husky.rate_radps, 0.2678, 0.02 * 0.2678);
  EXPECT_NEAR(of_husky.radius_m, 0.134, 0.02 * 0.134);
}

/// In a steady turn at 0.5 m/s and 0.5 rad/s the acceleration of a point on the axle is (0, 0.25) m/s2.
TEST_P(CylinderWheels, LeaveTheReadingsOfAnImuSmooth) {
  WheeledRobot robot = two_wheels("shape: cylinder, length_m: 0.04");
  robot.more = "        - {name: imu, type: imu, position_m: [0, 0, 0.05], rate_hz: 100}\n";
  test::TestWorld test(one_joint(robot.world(GetParam())));
  test.send("r1.drive.cmd", test::twist(0.5, 0.5));
  test.run_for(2);
  test::Listener<shoal::imu_t> imu(test, "r1.imu");
  test.run_for(4);
  double sum = 0, squares = 0, rates = 0;
  const auto readings = imu.take_all();
  ASSERT_GT(readings.size(), 300u);
  for (const shoal::imu_t& reading : readings) {
    sum += reading.linear_acceleration_mps2[0];
    squares += std::pow(reading.linear_acceleration_mps2[0], 2);
    rates = std::max(rates, std::abs(reading.angular_velocity_radps[2] - 0.5));
  }
  const double count = static_cast<double>(readings.size()), mean = sum / count;
  EXPECT_LT(std::sqrt(squares / count - mean * mean), 0.05);
  EXPECT_NEAR(mean, 0, 0.05);
  EXPECT_LT(rates, 0.02 * 0.5);
}

INSTANTIATE_TEST_SUITE_P(Steps, CylinderWheels, testing::ValuesIn(steps_s));

}  // namespace
