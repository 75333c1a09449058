// SPDX-License-Identifier: BSD-3-Clause
// Lengths, shapes and kinematics of the ERS-7 of vehicles/ against Sony's sheet.

#include <gtest/gtest.h>

#include <map>
#include <tuple>

#include "sim/random/random.hpp"
#include "tests/devices/joint/ers7_fixture.hpp"

namespace test::ers7 {
namespace {

using sim::Pose;
using sim::Vector3d;

/// Center of the ball of a foot, with the knee at an angle and the hip at zero.
Vector3d ball_at(const sim::VehicleConfig& config, const std::string& leg, double knee_deg) {
  const sim::JointConfig& knee = joint_of(config, leg + "_knee");
  const Vector3d straight =
      body_of(config, leg + "_lower").position_m + part_of(config, leg + "_lower", "ball").position_m;
  const Eigen::AngleAxisd turned(knee_deg / degrees, knee.axis1.axis.normalized());
  return knee.anchor_m + turned * (straight - knee.anchor_m);
}

/// The lengths of the figures of section 1.1, with the knees at 30 degrees as drawn.  0.5 mm: of the drawing's fit.
TEST(Ers7, HasTheLengthsOfSonysDrawing) {
  const Dog dog;
  const sim::VehicleConfig& config = dog.config();
  const auto anchor = [&](const char* joint) { return joint_of(config, joint).anchor_m; };
  const Vector3d front = ball_at(config, "lf", 30), rear = ball_at(config, "lh", 30);
  const double radius_m = part_of(config, "lf_lower", "ball").radius_m;
  const Vector3d camera = named(config.devices, "camera").position_m,
                 face = named(config.devices, "head_near").position_m;
  const Vector3d mouth = anchor("mouth") - anchor("head");
  const sim::PartConfig& ear = part_of(config, "ear_l", "flap");
  const double ear_y = body_of(config, "ear_l").position_m.y() + ear.position_m.y() + ear.size_m.y() / 2;
  const std::vector<std::tuple<const char*, double, double>> lengths_mm = {
      {"J1 front to rear", anchor("lf_hip").x() - anchor("lh_hip").x(), 130},
      {"J1 to knee, down", anchor("lf_hip").z() - anchor("lf_knee").z(), 69.5},
      {"J1 to knee, ahead", anchor("lf_knee").x() - anchor("lf_hip").x(), 9},
      {"knee to knee", anchor("lf_knee").x() - anchor("lh_knee").x(), 148},
      {"front knee over the ground", anchor("lf_knee").z() - front.z() + radius_m, 71.5},
      {"rear knee over the ground", anchor("lh_knee").z() - rear.z() + radius_m, 76.5},
      {"front paw ahead of J1", front.x() - anchor("lf_hip").x(), 37.3},
      {"rear paw behind J1", anchor("lh_hip").x() - rear.x(), 30.3},
      {"front paw ahead of its knee", front.x() - anchor("lf_knee").x(), 28.3},
      {"rear paw behind its knee", anchor("lh_knee").x() - rear.x(), 21.3},
      {"paws apart", 2 * front.y(), 134.4},
      {"tilt1 ahead of J1", anchor("neck").x() - anchor("lf_hip").x(), 2.5},
      {"tilt1 over J1", anchor("neck").z() - anchor("lf_hip").z(), 19.5},
      {"tilt1 to tilt2", anchor("head").z() - anchor("neck").z(), 80},
      {"camera ahead of tilt2", camera.x(), 81.06},
      {"camera below tilt2", -camera.z(), 14.6},
      {"mouth ahead of tilt2", mouth.x(), 40},
      {"mouth below tilt2", -mouth.z(), 17.5},
      {"distance sensor ahead of tilt2", face.x(), 76.9},
      {"ears, outside", 2 * ear_y, 125},
  };
  for (const auto& [what, length_m, drawn_mm] : lengths_mm) EXPECT_NEAR(length_m * 1000, drawn_mm, 0.5) << what;
}

/// Measured by the team rUNSWift: a front leg rolls on a circle of 65 mm about (40, -40) mm from its knee, and a rear
/// one touches at its toe.  Capsules 14.6 degrees apart are at most 52.6 mm (1 - cos 7.3 deg) = 0.43 mm inside of the
/// circle; the sphere of the knee leaves it by 0.2 mm.
TEST(Ers7, HasTheArcOfItsForearmsAndTheToeOfItsRearLegs) {
  const Dog dog;
  for (double towards_deg = 209; towards_deg > 165; towards_deg -= 1) {
    const Vector3d towards(std::cos(towards_deg / degrees), 0, std::sin(towards_deg / degrees));
    double reached_m = 0;  // all axes of these parts lie along y
    for (const char* name : {"ball", "cowl1", "cowl2", "cowl3", "knee"}) {
      const sim::PartConfig& part = part_of(dog.config(), "lf_lower", name);
      reached_m = std::max(reached_m, towards.dot(part.position_m) + part.radius_m);
    }
    const double circle_m = towards.dot(Vector3d(0.04, 0, -0.04)) + 0.065;
    EXPECT_GT(reached_m, circle_m - 0.00045) << towards_deg;
    EXPECT_LT(reached_m, circle_m + 0.0002) << towards_deg;
  }
  const sim::PartConfig& toe = part_of(dog.config(), "lh_lower", "toe");
  EXPECT_NEAR(toe.position_m.x() + toe.radius_m, 0.035, 1e-6);
  EXPECT_NEAR(toe.position_m.z(), -0.05, 1e-6);
}

/// The bodies are put where the table has them; the physics then measures the angles of the table at its joints and,
/// as they fit together, moves nothing: in a step of 1 us a joint corrects a part of an error of its anchor or axis.
TEST(Ers7, HasTheKinematicsOfTheTableInTenThousandPostures) {
  Dog dog("ers7", "self_collision: false, devices.camera.rate_hz: 0.1");
  sim::Random random(1, "postures");
  double worst_mm = 0, worst_rad = 0;
  std::map<std::string, Pose> expected;
  const auto put = [&](const std::array<double, axes.size()>& angles_deg) {
    const auto moved = moved_by(angles_deg);
    expected = {{"torso", Pose::Identity()}};
    for (std::size_t i = 0; i < axes.size(); ++i) {
      if (*axes[i].moves == 0) continue;
      Pose X_WV = Pose::Identity();
      for (int row = 0; row < 3; ++row) {
        for (int column = 0; column < 3; ++column)
          X_WV.linear()(row, column) = moved[i][static_cast<std::size_t>(row)][static_cast<std::size_t>(column)];
        X_WV.translation()[row] = moved[i][static_cast<std::size_t>(row)][3] / 1000;
      }
      const sim::BodyConfig& body = body_of(dog.config(), axes[i].moves);
      expected[body.name] = X_WV * sim::make_pose(body.position_m, body.rpy_rad);
    }
    ASSERT_EQ(expected.size(), dog.vehicle().bodies().size());
    for (const auto& [name, body] : dog.vehicle().bodies()) {
      body->set_pose(expected.at(name));
      body->set_velocity_W(Vector3d::Zero(), Vector3d::Zero());
    }
    dog.world.step();
  };
  for (int posture = 0; posture < 10000; ++posture) {
    random.begin_step(posture);
    std::array<double, axes.size()> angles_deg{};
    for (std::size_t i = 0; i < axes.size(); ++i)
      angles_deg[i] = axes[i].low_stop + (axes[i].high_stop - axes[i].low_stop) * random.uniform();
    put({});  // joints count turns: no jump may be longer than half of one
    put(angles_deg);
    // Compare positions and angles.
    for (const auto& [name, body] : dog.vehicle().bodies())
      worst_mm = std::max(worst_mm, (body->X_WB().translation() - expected.at(name).translation()).norm() * 1000);
    for (std::size_t i = 0; i < axes.size(); ++i) {
      const auto& servo = servo_params(dog.config(), axes[i].name);
      const double angle_rad = dog.vehicle().joint(servo.joint).position(servo.axis);
      worst_rad =
          std::max(worst_rad, std::abs(std::remainder(angle_rad - angles_deg[i] / degrees, 2 * std::numbers::pi)));
    }
  }
  EXPECT_LT(worst_mm, 0.01);
  EXPECT_LT(worst_rad, 1e-5);  // 2 um at the camera, 0.19 m from the neck
}

TEST(Ers7, HasLeftAndRightLegsThatMirrorEachOther) {
  const Dog dog;
  const auto mirrored = [](const Vector3d& v) { return Vector3d(v.x(), -v.y(), v.z()); };
  for (const std::string body : {"f_upper", "f_lower", "h_upper", "h_lower"}) {
    const auto& left = body_of(dog.config(), "l" + body);
    const auto& right = body_of(dog.config(), "r" + body);
    EXPECT_EQ(right.position_m, mirrored(left.position_m));
    ASSERT_EQ(right.parts.size(), left.parts.size());
    for (std::size_t i = 0; i < left.parts.size(); ++i) {
      EXPECT_EQ(right.parts[i].name, left.parts[i].name);
      EXPECT_EQ(right.parts[i].position_m, mirrored(left.parts[i].position_m)) << left.parts[i].name;
      EXPECT_EQ(right.parts[i].mass_kg, left.parts[i].mass_kg);
    }
  }
  for (const std::string servo : {"f_swing", "f_flap", "f_knee", "h_swing", "h_flap", "h_knee"}) {
    // A rotation vector mirrors as -x, y, -z.
    EXPECT_EQ(axis_of(dog.config(), "r" + servo).axis, -mirrored(axis_of(dog.config(), "l" + servo).axis)) << servo;
    EXPECT_EQ(servo_params(dog.config(), "r" + servo).low, servo_params(dog.config(), "l" + servo).low);
    EXPECT_EQ(servo_params(dog.config(), "r" + servo).high, servo_params(dog.config(), "l" + servo).high);
  }
}

}  // namespace
}  // namespace test::ers7
