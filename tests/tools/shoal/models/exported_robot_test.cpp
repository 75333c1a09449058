// SPDX-License-Identifier: BSD-3-Clause
#include "tools/shoal/models/exported_robot.hpp"

#include <gmock/gmock.h>

#include <fstream>

#include "sim/world_file/vehicle_loader.hpp"
#include "tests/scratch_folder.hpp"
#include "tests/tools/shoal/called_command.hpp"
#include "tools/shoal/urdf/imported_vehicle.hpp"
#include "tools/shoal/urdf/urdf_reader.hpp"
#include "tools/shoal/urdf/urdf_writer.hpp"

namespace {

using testing::HasSubstr;

sim::VehicleConfig loaded(const test_support::ScratchFolder& folder, const std::string& text) {
  std::ofstream(folder.file("v.yaml")) << text;
  return sim::load_vehicle(folder.file("v.yaml"));
}

tools::RobotDescription exported(const sim::VehicleConfig& vehicle) {
  return tools::exported_robot(vehicle, tools::masses_of(vehicle), "");
}

tools::ImportedVehicle back(const tools::RobotDescription& robot) {
  return tools::vehicle_of(tools::read_urdf(tools::urdf_text(robot), "r.urdf"), "r.urdf");
}

std::string notes_of(const tools::RobotDescription& robot) {
  std::string lines;
  for (const tools::ImportNote& note : robot.notes) lines += note.text + "\n";
  return lines;
}

/// Bodies and joints of a vehicle and of the import of its URDF are the same, in the frame of the vehicle.
void expect_same(const sim::VehicleConfig& vehicle) {
  const std::vector<tools::RobotInertial> masses = tools::masses_of(vehicle);
  const tools::ImportedVehicle import = back(tools::exported_robot(vehicle, masses, ""));
  ASSERT_EQ(import.bodies.size(), vehicle.bodies.size());
  for (std::size_t i = 0; i < vehicle.bodies.size(); ++i) {
    const sim::BodyConfig& body = vehicle.bodies[i];
    SCOPED_TRACE(body.name);
    const auto same = std::find_if(import.bodies.begin(), import.bodies.end(),
                                   [&](const tools::ImportedBody& each) { return each.name == body.name; });
    ASSERT_NE(same, import.bodies.end());
    const sim::Pose X_VB = sim::make_pose(body.position_m, body.rpy_rad);
    EXPECT_NEAR(same->mass_kg, masses[i].mass_kg, 1e-12 * masses[i].mass_kg);
    EXPECT_TRUE((same->X_VB * same->center_of_mass_m).isApprox(X_VB * masses[i].X_LC.translation(), 1e-9));
    const sim::Matrix3d R = X_VB.linear(), S = same->X_VB.linear();
    EXPECT_TRUE((S * same->inertia_kgm2 * S.transpose()).isApprox(R * masses[i].inertia_kgm2 * R.transpose(), 1e-9));
    ASSERT_EQ(same->parts.size(), body.parts.size());
    for (std::size_t k = 0; k < body.parts.size(); ++k) {
      EXPECT_EQ(same->parts[k].shape.shape, body.parts[k].shape);
      EXPECT_TRUE((same->X_VB * same->parts[k].X_BP)
                      .isApprox(X_VB * sim::make_pose(body.parts[k].position_m, body.parts[k].rpy_rad), 1e-9));
      EXPECT_EQ(same->parts[k].shape.color, body.parts[k].color);
    }
  }
  ASSERT_EQ(import.joints.size(), vehicle.joints.size());
  for (const sim::JointConfig& joint : vehicle.joints) {
    SCOPED_TRACE(joint.name);
    const auto same = std::find_if(import.joints.begin(), import.joints.end(),
                                   [&](const tools::ImportedJoint& each) { return each.name == joint.name; });
    ASSERT_NE(same, import.joints.end());
    EXPECT_EQ(same->type, joint.type);
    if (joint.type == sim::JointType::fixed) continue;
    const bool turned = same->first != joint.bodies.front();
    EXPECT_TRUE(same->axis_V.isApprox((turned ? -1 : 1) * joint.axis1.axis.normalized(), 1e-9));
    EXPECT_EQ(same->low_stop.has_value(), joint.axis1.low_stop.has_value());
    EXPECT_NEAR(same->low_stop.value_or(0), joint.axis1.low_stop.value_or(0), 1e-12);
    EXPECT_NEAR(same->damping, joint.axis1.damping, 1e-12);
  }
}

TEST(ExportedRobot, ComesBackAsItWas) {
  for (const char* name : {"bittle", "rover", "pioneer"}) {
    SCOPED_TRACE(name);
    expect_same(sim::load_vehicle("vehicles/" + std::string(name) + ".yaml"));
  }
}

TEST(ExportedRobot, HasItsRootInTheFrameOfTheVehicleAndItsJointsAtTheirAnchors) {
  const test_support::ScratchFolder folder;
  const sim::VehicleConfig vehicle = loaded(
      folder,
      "shoal: 1\nvehicle: v\nbodies:\n"
      "  - {name: a, position_m: [0, 0, 1], parts: [{shape: box, size_m: [1, 1, 1], mass_kg: 2}]}\n"
      "  - {name: b, position_m: [2, 0, 1], rpy_deg: [0, 0, 90], parts: [{shape: sphere, radius_m: 0.1, mass_kg: 1}]}\n"
      "joints: [{name: j, type: hinge, bodies: [b, a], axis: [0, 0, 2], anchor_m: [1, 0, 1], low_stop: -0.5, "
      "high_stop: 1}]\n");
  const tools::RobotDescription robot = exported(vehicle);
  EXPECT_TRUE(robot.links.at(0).inertial->X_LC.translation().isApprox(sim::Vector3d(0, 0, 1)));
  // The joint counts how a moves on b: as seen from a it turns b the other way.
  EXPECT_EQ(robot.joints.at(0).parent, "a");
  EXPECT_TRUE(robot.joints[0].axis_J.isApprox(-sim::Vector3d::UnitZ(), 1e-12));
  EXPECT_TRUE(robot.joints[0].X_PJ.translation().isApprox(sim::Vector3d(1, 0, 1)));
  // The center of b is 1 m from the anchor, along x of the vehicle, which is -y of b.
  EXPECT_TRUE(robot.links.at(1).inertial->X_LC.translation().isApprox(sim::Vector3d(0, -1, 0), 1e-12));
}

TEST(ExportedRobot, SaysWhatUrdfDoesNotHold) {
  const test_support::ScratchFolder folder;
  const sim::VehicleConfig vehicle =
      loaded(folder,
             "shoal: 1\nvehicle: v\nbodies:\n"
             "  - name: a\n    parts: [{shape: box, size_m: [1, 1, 1]}]\n"
             "    hydrodynamics: {mass_kg: 5, inertia_kgm2: [1, 1, 1], frame: frd, center_of_mass_m: [0, 0, 0.1]}\n"
             "  - {name: b, parts: [{shape: sphere, radius_m: 0.1, mass_kg: 1}]}\n"
             "joints: [{name: j, type: ball, bodies: [a, b]}]\n"
             "devices: [{name: imu, type: imu}]\n");
  const tools::RobotDescription robot = exported(vehicle);
  EXPECT_EQ(notes_of(robot),
            "body 'a': forces of the water are not in URDF\njoint 'j' is fixed: URDF has no joint of type ball\n"
            "device 'imu' of type 'imu' is not in URDF\n");
  // Forward-right-down: 0.1 m down.
  EXPECT_TRUE(robot.links.at(0).inertial->X_LC.translation().isApprox(sim::Vector3d(0, 0, -0.1)));
}

TEST(ExportCommand, WritesAUrdfThatTheImportTakes) {
  const test_support::ScratchFolder folder;
  const std::string urdf = folder.file("b.urdf");
  const test::Called called = test::call_shoal({"export", "urdf", "vehicles/bittle.yaml", "--output", urdf});
  EXPECT_EQ(called.exit_code, 0) << called.err;
  EXPECT_THAT(called.out, HasSubstr("robot 'bittle': 10 links, 9 joints\n"));
  const test::Called import = test::call_shoal({"import", "urdf", urdf, "--output", folder.file("b.yaml")});
  EXPECT_EQ(import.exit_code, 0) << import.err;
  EXPECT_THAT(import.out, HasSubstr("10 bodies, 9 joints, 9 servos"));
  EXPECT_THAT(test::call_shoal({"export", "urdf", "vehicles/bittle.yaml", "--output", urdf}).err,
              HasSubstr("already exists; --overwrite replaces it"));
}

}  // namespace
