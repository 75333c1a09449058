// SPDX-License-Identifier: BSD-3-Clause
#include "experiment/drive/drive_mapping.hpp"

#include <gmock/gmock.h>

#include <cmath>

#include "bridges/control/spawned_vehicles.hpp"
#include "experiment/drive/drive_profile.hpp"
#include "shoal/ackermann_command_t.hpp"
#include "shoal/actuator_command_t.hpp"
#include "shoal/helm_command_t.hpp"
#include "shoal/inclination_t.hpp"
#include "shoal/joint_servo_command_t.hpp"
#include "shoal/message_codec.hpp"
#include "shoal/pan_tilt_zoom_command_t.hpp"
#include "shoal/thrust_rudder_elevator_command_t.hpp"
#include "shoal/twist_command_t.hpp"
#include "shoal/wrench_t.hpp"
#include "sim/device/device_registry.hpp"
#include "tests/devices/world_fixture.hpp"
#include "tests/project_paths.hpp"

namespace {

using experiment::DriveKind;
using testing::ElementsAre;

/// A vehicle with these devices: name and type.
experiment::DrivenVehicle vehicle(const std::vector<std::pair<std::string, std::string>>& devices) {
  experiment::DrivenVehicle made{"v", {}};
  for (const auto& [name, type] : devices)
    made.devices.push_back(
        {name, type, "v." + name + ".cmd", sim::DeviceRegistry::instance().find(type)->command_messages});
  return made;
}

const experiment::DriveProfile& profile() {
  static const experiment::DriveProfile profile = experiment::read_drive_profile("");
  return profile;
}

template <typename Message>
Message only(const std::vector<experiment::DriveCommand>& commands, const std::string& channel) {
  EXPECT_EQ(commands.size(), 1u);
  EXPECT_EQ(commands.at(0).channel, channel);
  return shoal::decode<Message>(commands.at(0).payload, shoal::Finite::any);
}

TEST(DriveMapping, CommandsATwistToADrive) {
  experiment::DriveMapping mapping(profile(), vehicle({{"drive", "skid_steer"}}), {});
  EXPECT_EQ(mapping.kind(), DriveKind::twist);
  const auto command =
      only<shoal::twist_command_t>(mapping.commands({{"forward", 0.5}, {"turn", -2}}, 7, {}), "v.drive.cmd");
  EXPECT_EQ(command.utime, 7);
  EXPECT_DOUBLE_EQ(command.forward_mps, 0.5 * profile().twist.forward_mps);
  EXPECT_DOUBLE_EQ(command.turn_radps, -profile().twist.turn_radps);  // clamped to full deflection
  const auto safe = only<shoal::twist_command_t>(mapping.commands({}, 8, {}), "v.drive.cmd");
  EXPECT_EQ(safe.forward_mps, 0);
  EXPECT_EQ(safe.turn_radps, 0);
}

TEST(DriveMapping, SteersACarByItsAngle) {
  experiment::DriveMapping mapping(profile(), vehicle({{"drive", "ackermann_drive"}}), {});
  const auto command =
      only<shoal::ackermann_command_t>(mapping.commands({{"forward", -1}, {"turn", 1}}, 0, {}), "v.drive.cmd");
  EXPECT_DOUBLE_EQ(command.speed_mps, -profile().twist.forward_mps);
  EXPECT_DOUBLE_EQ(command.steering_rad, profile().twist.steering_rad);
}

TEST(DriveMapping, LeadsTheHeadingOfAHelmAndKeepsItWhenTheTurnEnds) {
  experiment::DriveMapping mapping(profile(), vehicle({{"port", "thruster"}, {"autopilot", "autopilot"}}), {});
  EXPECT_EQ(mapping.kind(), DriveKind::helm);
  const auto helm = [&](const experiment::DriveValues& values, double yaw_rad, double depth_m) {
    return only<shoal::helm_command_t>(mapping.commands(values, 0, experiment::DrivePose{yaw_rad, depth_m}),
                                       "v.autopilot.cmd");
  };
  const auto straight = helm({{"forward", 1}}, 0.3, 5);
  EXPECT_DOUBLE_EQ(straight.speed_mps, profile().helm.speed_mps);
  EXPECT_TRUE(std::isnan(straight.heading_rad));
  EXPECT_TRUE(std::isnan(straight.depth_m));
  const auto turning = helm({{"turn", 0.5}, {"dive", 1}}, 0.3, 5);
  EXPECT_DOUBLE_EQ(turning.heading_rad, 0.3 + 0.5 * profile().helm.heading_lead_rad);
  EXPECT_DOUBLE_EQ(turning.depth_m, 5 + profile().helm.depth_lead_m);
  // Once the present heading and depth, then unchanged.
  const auto back = helm({}, 0.6, 6);
  EXPECT_DOUBLE_EQ(back.heading_rad, 0.6);
  EXPECT_DOUBLE_EQ(back.depth_m, 6);
  EXPECT_TRUE(std::isnan(helm({}, 0.7, 7).heading_rad));
}

TEST(DriveMapping, TakesTheKindThatIsAskedFor) {
  experiment::DriveMapping mapping(profile(), vehicle({{"drive", "naive_drive"}}), DriveKind::thrust);
  EXPECT_THAT(mapping.axes(), ElementsAre("forward", "turn", "dive"));
  const auto command = only<shoal::thrust_rudder_elevator_command_t>(
      mapping.commands({{"forward", 1}, {"turn", -0.5}, {"dive", 0.25}}, 0, {}), "v.drive.cmd");
  EXPECT_DOUBLE_EQ(command.thrust, 1);
  EXPECT_DOUBLE_EQ(command.rudder, -0.5);
  EXPECT_DOUBLE_EQ(command.elevator, 0.25);
}

TEST(DriveMapping, MixesThrustersFinsAndWrenches) {
  const experiment::DriveProfile own = experiment::parse_drive_profile(
      "crafts: [{name: cat, devices: [{device: port, forward: 60, turn: -40}, {device: starboard, forward: 60, turn: "
      "40}]}, {name: ball, devices: [{device: w, part: force_x_N, forward: 3}, {device: w, part: torque_z_Nm, turn: "
      "-2}]}]",
      "pad.yaml");
  experiment::DriveMapping cat(own, vehicle({{"port", "thruster"}, {"starboard", "thruster"}}), {});
  EXPECT_EQ(cat.kind(), DriveKind::thrust);
  EXPECT_THAT(cat.axes(), ElementsAre("forward", "turn"));
  const auto commands = cat.commands({{"forward", 0.5}, {"turn", 1}}, 0, {});
  ASSERT_EQ(commands.size(), 2u);
  const auto value = [](const experiment::DriveCommand& command) {
    return shoal::decode<shoal::actuator_command_t>(command.payload, shoal::Finite::required).value;
  };
  EXPECT_DOUBLE_EQ(value(commands[0]), 0.5 * 60 - 40);
  EXPECT_DOUBLE_EQ(value(commands[1]), 0.5 * 60 + 40);
  experiment::DriveMapping ball(own, vehicle({{"w", "body_wrench"}}), {});
  const auto wrench = only<shoal::wrench_t>(ball.commands({{"forward", 1}, {"turn", 1}}, 0, {}), "v.w.cmd");
  EXPECT_DOUBLE_EQ(wrench.force_N[0], 3);
  EXPECT_DOUBLE_EQ(wrench.torque_Nm[2], -2);
}

TEST(DriveMapping, RunsJointsAtAVelocityAndHoldsTheOthers) {
  experiment::DriveMapping mapping(profile(), vehicle({{"waist", "joint_servo"}, {"elbow", "joint_servo"}}), {});
  EXPECT_EQ(mapping.kind(), DriveKind::joints);
  EXPECT_THAT(mapping.axes(), ElementsAre("waist", "elbow"));
  const auto commands = mapping.commands({{"elbow", -1}}, 0, {});
  ASSERT_EQ(commands.size(), 2u);
  const auto command = [](const experiment::DriveCommand& one) {
    return shoal::decode<shoal::joint_servo_command_t>(one.payload, shoal::Finite::required);
  };
  EXPECT_EQ(command(commands[0]).mode, 1);
  EXPECT_EQ(command(commands[0]).velocity, 0);
  EXPECT_DOUBLE_EQ(command(commands[1]).velocity, -profile().joints.velocity);
}

TEST(DriveMapping, PansTiltsAndZoomsACamera) {
  const experiment::DrivenVehicle driven = vehicle({{"pan", "joint_servo"}, {"ptz", "pan_tilt_zoom"}});
  experiment::DriveMapping mapping(profile(), driven, {});
  EXPECT_EQ(mapping.kind(), DriveKind::camera);
  EXPECT_THAT(mapping.axes(), ElementsAre("forward", "turn", "dive"));
  const auto command = only<shoal::pan_tilt_zoom_command_t>(
      mapping.commands({{"forward", -0.5}, {"turn", 1}, {"dive", 0.2}}, 7, {}), "v.ptz.cmd");
  EXPECT_EQ(command.utime, 7);
  EXPECT_TRUE(std::isnan(command.pan_rad) && std::isnan(command.tilt_rad) && std::isnan(command.fov_rad));
  constexpr double deg = 0.017453292519943295;
  EXPECT_DOUBLE_EQ(command.pan_radps, 60 * deg);
  EXPECT_DOUBLE_EQ(command.tilt_radps, -20 * deg);
  EXPECT_DOUBLE_EQ(command.fov_radps, -3 * deg);  // nearer
  const auto safe = only<shoal::pan_tilt_zoom_command_t>(mapping.commands({}, 0, {}), "v.ptz.cmd");
  EXPECT_EQ(safe.pan_radps, 0);
  EXPECT_EQ(safe.tilt_radps, 0);
  EXPECT_EQ(safe.fov_radps, 0);
}

TEST(DriveMapping, DrivesTheSegwayThroughTheProgramThatBalancesIt) {
  const test::LoadedTestWorld segway(test_support::source_path("worlds/segway.yaml"));
  const experiment::DrivenVehicle driven =
      experiment::driven_vehicle(bridges::vehicle_message(*segway.world.find_vehicle("segway1")));
  EXPECT_THAT(experiment::drive_kinds(profile(), driven),
              ElementsAre(DriveKind::twist, DriveKind::tilt, DriveKind::joints));
  experiment::DriveMapping mapping(profile(), driven, {});
  only<shoal::twist_command_t>(mapping.commands({}, 0, {}), "segway1.balance.cmd");
  EXPECT_THAT(experiment::DriveMapping(profile(), driven, DriveKind::joints).axes(),
              ElementsAre("left_motor", "right_motor"));
}

TEST(DriveMapping, TiltsTheSegwayAndStopsItWhenItTiltsNoMore) {
  const test::LoadedTestWorld segway(test_support::source_path("worlds/segway.yaml"));
  const experiment::DrivenVehicle driven =
      experiment::driven_vehicle(bridges::vehicle_message(*segway.world.find_vehicle("segway1")));
  experiment::DriveMapping mapping(profile(), driven, DriveKind::tilt);
  EXPECT_THAT(mapping.axes(), ElementsAre("forward", "turn"));
  // The turn rate first, since a twist ends a tilt.
  const auto commands = mapping.commands({{"forward", -0.5}, {"turn", 1}}, 7, {});
  ASSERT_EQ(commands.size(), 2u);
  const auto turn = shoal::decode<shoal::twist_command_t>(commands[0].payload, shoal::Finite::required);
  EXPECT_EQ(turn.forward_mps, 0);
  EXPECT_EQ(turn.turn_radps, profile().tilt.turn_radps);
  const auto tilt = shoal::decode<shoal::inclination_t>(commands[1].payload, shoal::Finite::required);
  EXPECT_DOUBLE_EQ(tilt.pitch_rad, -0.5 * profile().tilt.tilt_rad);
  EXPECT_EQ(tilt.utime, 7);
  for (const auto& command : commands) EXPECT_EQ(command.channel, "segway1.balance.cmd");
  EXPECT_EQ(only<shoal::twist_command_t>(mapping.commands({}, 0, {}), "segway1.balance.cmd").forward_mps, 0);
}

TEST(DriveMapping, SaysWhatIsPossibleInstead) {
  const auto error = [](const experiment::DrivenVehicle& driven, std::optional<DriveKind> kind) -> std::string {
    try {
      experiment::DriveMapping(profile(), driven, kind);
    } catch (const experiment::DriveError& problem) {
      return problem.what();
    }
    return "";
  };
  EXPECT_EQ(error(vehicle({{"drive", "skid_steer"}}), DriveKind::helm),
            "vehicle 'v' cannot be driven by 'helm', only by: twist, thrust");
  EXPECT_EQ(error(vehicle({{"drive", "skid_steer"}}), DriveKind::tilt),
            "vehicle 'v' cannot be driven by 'tilt', only by: twist, thrust");
  EXPECT_EQ(error(vehicle({{"lidar", "lidar"}}), {}), "vehicle 'v' has no devices by which it can be driven");
}

}  // namespace
