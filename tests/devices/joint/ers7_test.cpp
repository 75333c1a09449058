// SPDX-License-Identifier: BSD-3-Clause
// Limits and masses of the ERS-7 of vehicles/, and that it stands and moves.

#include <gtest/gtest.h>

#include <map>

#include "tests/devices/joint/ers7_fixture.hpp"

namespace test::ers7 {
namespace {

using sim::Pose;
using sim::Vector3d;

TEST(Ers7, HasTheAnchorsStopsLimitsAndSpeedsOfTheSheet) {
  const Dog dog;
  constexpr double rounded_rad = 0.6e-5, rounded_radps = 0.6e-3;  // five and three decimals in the file
  for (const auto& row : axes) {
    SCOPED_TRACE(row.name);
    const auto& servo = servo_params(dog.config(), row.name);
    const sim::JointAxisConfig& axis = axis_of(dog.config(), row.name);
    EXPECT_TRUE(joint_of(dog.config(), servo.joint).anchor_m.isApprox(Vector3d(row.at_mm.data()) / 1000, 1e-9));
    EXPECT_EQ(axis.axis, Vector3d(row.along.data()));
    // A joint must not start at its stop: half a degree more.
    EXPECT_NEAR(axis.low_stop.value(), (row.low_stop == 0 ? -0.5 : row.low_stop) / degrees, rounded_rad);
    EXPECT_NEAR(axis.high_stop.value(), (row.high_stop == 0 ? 0.5 : row.high_stop) / degrees, rounded_rad);
    EXPECT_NEAR(servo.low.value(), row.low / degrees, rounded_rad);
    EXPECT_NEAR(servo.high.value(), row.high / degrees, rounded_rad);
    EXPECT_GE(servo.low.value(), axis.low_stop.value());
    EXPECT_LE(servo.high.value(), axis.high_stop.value());
    if (row.frame_deg > 0) {
      EXPECT_NEAR(servo.max_velocity, row.frame_deg / degrees / 0.008, rounded_radps);
    }
    const sim::ConfigNode* alias = named(dog.config().devices, row.name).source->find("alias");
    EXPECT_EQ(alias == nullptr ? "none" : alias->scalar, row.locator);
    const auto& built = dynamic_cast<const devices::JointServo&>(*dog.vehicle().find_device(row.name)->actuator());
    EXPECT_EQ(built.low(), servo.low.value());
    EXPECT_EQ(built.high(), servo.high.value());
  }
}

/// Masses of Webots' model.txt; 0.01 kg of its head are in the jaw.
TEST(Ers7, HasTheMassesOfItsFile) {
  const Dog dog;
  const std::map<std::string, double> masses_kg = {{"torso", 0.613},    {"neck", 0.015},     {"head", 0.19},
                                                   {"jaw", 0.01},       {"ear_l", 0.005},    {"ear_r", 0.005},
                                                   {"lf_upper", 0.123}, {"lf_lower", 0.073}, {"tail", 0.006}};
  for (const auto& [name, mass_kg] : masses_kg) EXPECT_NEAR(dog.vehicle().body(name).mass_kg(), mass_kg, 1e-9) << name;
  double sum_kg = 0;
  for (const auto& [name, body] : dog.vehicle().bodies()) sum_kg += body->mass_kg();
  EXPECT_NEAR(sum_kg, 1.628, 1e-9);
  EXPECT_NEAR(dog.vehicle().base().p_BC().z(), -0.02, 1e-4);
  EXPECT_NEAR(dog.vehicle().body("lf_lower").p_BC().z(), -0.04, 1e-3);
  EXPECT_NEAR(dog.vehicle().body("lh_lower").p_BC().z(), -0.04, 1e-3);
}

TEST(Ers7Seed, HasTheBodiesMassesAndAxesOfTheThesis) {
  const Dog seed("ers7_seed", ""), dog;
  ASSERT_EQ(seed.vehicle().bodies().size(), 11u);
  for (const auto& [name, body] : seed.vehicle().bodies())
    EXPECT_NEAR(body->mass_kg(), name == "torso" ? 0.6 : 0.1, 1e-9) << name;
  int servos = 0;
  for (const auto& row : axes) {
    if (seed.vehicle().find_device(row.name) == nullptr) continue;
    ++servos;
    EXPECT_EQ(servo_params(seed.config(), row.name).low, servo_params(dog.config(), row.name).low);
    EXPECT_EQ(servo_params(seed.config(), row.name).high, servo_params(dog.config(), row.name).high);
    EXPECT_EQ(axis_of(seed.config(), row.name).axis, axis_of(dog.config(), row.name).axis);
  }
  EXPECT_EQ(servos, 15);
  for (const sim::JointConfig& joint : seed.config().joints)
    EXPECT_EQ(joint.anchor_m, joint_of(dog.config(), joint.name).anchor_m) << joint.name;
}

/// In free space each axis goes to both software limits and back, one after the other: no part is in its way.  A leg
/// swings with its flap at 60 degrees, beside the other one.
TEST(Ers7, ReachesBothLimitsOfEachAxis) {
  test::TestWorld dog(
      "shoal: 1\nphysics: {step_s: 0.002, gravity_mps2: 0, solver: step}\nvehicles:\n  - {name: dog, file: " +
      test_support::source_path("vehicles/ers7.yaml") + ", parameters: {camera_hz: 0.1}}\n");
  const sim::Vehicle& vehicle = *dog.world.find_vehicle("dog");
  const auto expect_reached = [&](const std::string& name, double angle_deg) {
    shoal::joint_servo_command_t command{};
    command.position = angle_deg / degrees;
    dog.send("dog." + name + ".cmd", command);
    dog.run_for(1.2);  // the slowest, a leg from 130 to -115 degrees, takes 0.88 s
    const auto& servo = servo_params(vehicle.config(), name);
    EXPECT_NEAR(vehicle.joint(servo.joint).position(servo.axis) * degrees, angle_deg, 0.1) << name;
  };
  for (const auto& row : axes) {
    const std::string name = row.name;
    const bool swings = name.ends_with("swing");
    if (swings) expect_reached(name.substr(0, 3) + "flap", 60);
    for (const double angle_deg : {row.low, row.high, std::clamp(0.0, row.low, row.high)})
      expect_reached(name, angle_deg);
    if (swings) expect_reached(name.substr(0, 3) + "flap", 0);
  }
}

/// Straight legs: front 147.14 mm from J1 to the sole, 69.0 mm ahead; rear 148.18 mm, 60.5 mm behind: 0.46 deg nose
/// down, 147.7 mm at the origin, less 0.5 mm that contacts sink in.
TEST(Ers7, StandsStill) {
  for (const char* world : {"ers7_studio", "ers7_field", "ers7_seed_studio"}) {
    SCOPED_TRACE(world);
    DogIn dog(world);
    dog.run_for(1);
    const Pose settled = dog.vehicle().X_WV();
    EXPECT_NEAR(dog.pitch_deg(), 0.46, 0.1);
    EXPECT_NEAR(settled.translation().z(), 0.1472, 0.0005);
    double worst_deg = 0;
    while (dog.world.now() < sim::from_seconds(16)) {
      dog.world.step();
      worst_deg = std::max(worst_deg, dog.tilt_deg());
    }
    EXPECT_LT(worst_deg, 2);
    EXPECT_LT((dog.vehicle().X_WV().translation() - settled.translation()).norm(), 0.0005);
  }
}

/// Sony's pose has the knees at 30 degrees: soles 141.0 mm below the front J1 and 146.0 mm below the rear one, 197.6 mm
/// apart: 1.45 degrees nose down.
TEST(Ers7, TakesSonysStandingPose) {
  DogIn dog("ers7_studio");
  for (const char* leg : {"lf", "lh", "rf", "rh"}) dog.command(std::string(leg) + "_knee", 30);
  dog.run_for(3);
  EXPECT_NEAR(dog.pitch_deg(), 1.45, 0.1);
  EXPECT_NEAR(dog.vehicle().X_WV().translation().z(), 0.1436, 0.001);
  for (const char* leg : {"lf", "lh", "rf", "rh"})
    EXPECT_NEAR(dog.vehicle().joint(std::string(leg) + "_knee").position() * degrees, 30, 0.2);
}

}  // namespace
}  // namespace test::ers7
