// SPDX-License-Identifier: BSD-3-Clause
// What devices keep from step to step: a world that is saved and restored continues bit for bit as it would have.

#include "devices/autopilot/autopilot_route.hpp"
#include "shoal/acoustic_received_t.hpp"
#include "shoal/actuator_command_t.hpp"
#include "shoal/autopilot_command_t.hpp"
#include "shoal/joint_servo_command_t.hpp"
#include "shoal/modem_send_t.hpp"
#include "shoal/station_command_t.hpp"
#include "shoal/twist_command_t.hpp"
#include "shoal/wrench_t.hpp"
#include "tests/devices/comms/modem_fixture.hpp"
#include "tests/devices/joint/arm_fixture.hpp"
#include "tests/devices/marine/marine_fixture.hpp"
#include "tests/devices/state_fixture.hpp"

namespace {

using test::SavedRun;
using test::TappedWorld;

SavedRun file(const std::string& name) {
  return SavedRun([name] { return sim::load_world(name, test::LoadedTestWorld::with_messages({})); });
}

/// Until the first events, and while faults, a gap in the satellites' view and an emergency stop last.
TEST(DeviceState, OfEveryDeviceOnLandOutlastsASnapshot) {
  file("worlds/proving_ground.yaml").expect_restored_worlds_go_on_alike({0, 333, 1711}, 150);
}

TEST(DeviceState, OfEveryDeviceAtSeaOutlastsASnapshot) {
  file("worlds/proving_sea.yaml").expect_restored_worlds_go_on_alike({0, 411, 921}, 150);
}

/// The images are taken in pieces over most of the time between two samples, so that every snapshot cuts one in two.
/// The third image of depth is sampled after 216 steps and the next after 323, 107.5 ms before which the camera was
/// where it was half a step before the snapshot.
TEST(DeviceState, CamerasContinueWithAHalfDoneImage) {
  SavedRun run(
      test::rover_world(
          "        - {name: drive, type: differential_drive, left_joint: left, right_joint: right}\n"
          "        - {name: rolling, type: camera, width: 16, height: 12, rate_hz: 9, readout_s: 0.1, position_m: "
          "[0, 0, 0.4], noise: {gaussian_std: 2}}\n"
          "        - {name: blurred, type: camera, width: 16, height: 12, rate_hz: 9, exposure_time_s: 0.1, "
          "blur_samples: 9, position_m: [0, 0, 0.4], full_well_electrons: 1000, exposure: {auto: true}}\n"
          "        - {name: depth, type: camera, image: depth, width: 16, height: 12, rate_hz: 9.3, phase_s: 0, "
          "readout_s: 0.1075, position_m: [0, 0, 0.4], noise: {gauss_markov_std: 0.1}}\n"
          "        - {name: parts, type: camera, image: segmentation_parts, width: 16, height: 12, rate_hz: 9, "
          "readout_s: 0.1, position_m: [0, 0, 0.4]}\n",
          "  - {name: wall, fixed: true, position_m: [3, 0, 0.5], parts: [{shape: box, size_m: [0.2, 6, 6]}]}\n"),
      [](TappedWorld& world, int step) {
        if (step == 5) world.send("r1.drive.cmd", shoal::twist_command_t{0, 0.4, 0.7});
      });
  run.expect_restored_worlds_go_on_alike({50, 151, 216, 290}, 250);
}

/// A sled that is pushed against a wall and pulled away; its bumper samples seldom, its battery runs empty at the end.
TEST(DeviceState, BumperEmergencyStopAndBatteryRememberWhatTheyFelt) {
  SavedRun run(R"(
shoal: 1
physics: {step_s: 0.001, gravity_mps2: 0}
objects:
  - {name: wall, fixed: true, position_m: [1, 0, 0.5], parts: [{shape: box, size_m: [0.2, 2, 1]}]}
vehicles:
  - name: s
    model:
      shoal: 1
      vehicle: sled
      bodies:
        - {name: base, position_m: [0.6, 0, 0.5], parts: [{shape: box, size_m: [0.5, 0.4, 0.2], mass_kg: 1}]}
      devices:
        - {name: push, type: body_wrench, lag_s: 0.02, power_W: 300}
        - {name: bumper, type: bumper, rate_hz: 13, force_noise: {gaussian_std: 1}}
        - {name: estop, type: estop, stops_on_touch: bumper, rate_hz: 7}
        - {name: battery, type: battery, capacity_Wh: 0.05, rate_hz: 11, voltage_noise: {random_walk_std: 0.1}}
)",
               [](TappedWorld& world, int step) {
                 shoal::wrench_t wrench{};
                 wrench.force_N[0] = step % 200 < 100 ? 40 : -40;
                 if (step % 50 == 0) world.send("s.push.cmd", wrench);
               });
  run.expect_restored_worlds_go_on_alike({71, 157, 303, 599}, 200);
}

TEST(DeviceState, ServosKeepTheirSetPointsAndIntegrals) {
  SavedRun run(
      test::arm_world(
          "        - {name: servo, type: joint_servo, joint: shoulder, control: pid, kp: 200, ki: 100, kd: 20, "
          "integral_limit: 20, max_effort: 60, max_velocity: 2, max_acceleration: 3}\n"
          "        - {name: load, type: joint_load, joint: shoulder, rate_hz: 77}\n"
          "        - {name: state, type: joint_state, rate_hz: 83}\n"
          "        - {name: battery, type: battery, rate_hz: 90}\n"),
      [](TappedWorld& world, int step) {
        if (step % 130 == 0)
          world.send("a1.servo.cmd",
                     shoal::joint_servo_command_t{0, static_cast<std::int8_t>(step / 130 % 4), 0.7, -0.5, 9});
      });
  run.expect_restored_worlds_go_on_alike({60, 200, 333, 450, 530}, 200);
}

TEST(DeviceState, MarineActuatorsAreOnTheirWay) {
  const std::string second_order = "natural_frequency_radps: 9, damping_ratio: 0.4";
  SavedRun run(test::WetBox::yaml(test::wet_device("type: fin, area_m2: 0.1, " + second_order) +
                                      "        - {name: engine, type: buoyancy_engine, lag_s: 0.3, rate_m3ps: 1.0e-3}\n"
                                      "        - {name: push, type: body_wrench, lag_s: 0.4}\n"
                                      "        - {name: battery, type: battery, rate_hz: 90}\n",
                                  "{water: {density_kgpm3: 1000, surface_m: 50}}", 9.8),
               [](TappedWorld& world, int step) {
                 if (step % 90 != 0) return;
                 const double sign = step % 180 == 0 ? 1 : -1;
                 world.send("v.d.cmd", shoal::actuator_command_t{0, sign * 0.3});
                 world.send("v.engine.cmd", shoal::actuator_command_t{0, sign * 2e-4});
                 shoal::wrench_t wrench{};
                 wrench.force_N[0] = 30 * sign;
                 world.send("v.push.cmd", wrench);
               });
  run.expect_restored_worlds_go_on_alike({40, 135, 300}, 200);
}

TEST(DeviceState, AnAutopilotContinuesWithItsRouteItsStationAndItsSums) {
  const auto yaml = [](const std::string& file, const std::string& overrides) {
    return "shoal: 1\nphysics: {step_s: 0.01}\nmedium: {water: {}, current: [{type: constant, velocity_mps: [0, 0.3, "
           "0]}]}\nvehicles:\n  - name: v\n    file: " +
           file + "\n    position_m: [0, 0, -10]\n    overrides:\n" + overrides;
  };
  SavedRun route(
      yaml("remus100_survey.yaml",
           "      devices.autopilot.waypoints: [{at_m: [8, 0], depth_m: 11}, {at_m: [16, 8], speed_mps: 1.2}, "
           "{at_m: [30, 8]}]\n"
           "      devices.autopilot.guidance: {lookahead_m: 5, integral: 0.3, acceptance_radius_m: 2}\n"));
  route.expect_restored_worlds_go_on_alike({5, 655, 1431}, 300);
  SavedRun station(yaml("bluerov2_station.yaml", "      devices.autopilot.rate_hz: 7\n"),
                   [](TappedWorld& world, int step) {
                     if (step == 200) world.send("v.autopilot.cmd", shoal::station_command_t{0, 1, 2, 0.5, 11});
                     if (step == 500) world.send("v.autopilot.cmd", shoal::autopilot_command_t{0, 0});
                     if (step == 700) world.send("v.autopilot.cmd", shoal::autopilot_command_t{0, 1});
                   });
  station.expect_restored_worlds_go_on_alike({150, 333, 601}, 300);
}

/// Messages wait in modems and gateways, sound is under way, and what passed before must not pass again.
TEST(DeviceState, ModemsAndGatewaysKeepWhatWaitsInThem) {
  const std::string radio = "{name: radio, type: modem, range_m: 10000, rate_hz: 3, position_m: [0, 0, 1]}";
  const std::string acoustic =
      "{name: acoustic, type: acoustic_modem, preset: low_rate, rate_hz: 3, synchronous_s: 0.4}";
  SavedRun run(
      test::modem_sea(
          {{"ship", "[500, 0, -0.5]", radio, "clock: {preset: tcxo, offset_s: 0.1}"},
           {"buoy", "[0, 0, -0.5]",
            radio + ", " + acoustic + ", {name: gate, type: gateway, between: [radio, acoustic], delay_s: 0.3}", ""},
           {"auv", "[0, 0, -1500]", acoustic + ", {name: power, type: battery}", ""}}),
      [](TappedWorld& world, int step) {
        if (step % 40 == 0) world.send("ship.radio.cmd", test::bytes_to("dive " + std::to_string(step / 80), "buoy"));
        if (step % 150 == 0) world.send("auv.acoustic.cmd", test::bytes_to("here"));
        if (step == 210)
          for (int i = 0; i < 5; ++i) world.send("auv.acoustic.cmd", test::bytes_to("more"));
      });
  run.expect_restored_worlds_go_on_alike({83, 219, 470}, 300);
}

TEST(DeviceState, SensorsKeepTheirDriftsFiltersAndLastSamples) {
  const std::string noise = "{random_walk_std: 0.1, gauss_markov_std: 0.2, gauss_markov_time_s: 1, gaussian_std: 0.1}";
  SavedRun run(
      test::box_world("        - {name: push, type: body_wrench}\n"
                      "        - {name: imu, type: imu, preset: vn100, bandwidth_Hz: 4, rate_hz: 70}\n"
                      "        - {name: ahrs, type: ahrs, heading_drift_deg_per_h: 900, tilt_noise: " +
                          noise +
                          ", rate_hz: 30}\n"
                          "        - {name: compass, type: compass, tilt_time_s: 0.5, field_noise: " +
                          noise +
                          ", rate_hz: 13}\n"
                          "        - {name: tilt, type: inclinometer, time_constant_s: 0.5, noise: " +
                          noise +
                          ", rate_hz: 13}\n"
                          "        - {name: gps, type: gps, horizontal_noise: " +
                          noise +
                          ", reacquisition_s: 0.2, rate_hz: 17}\n"
                          "        - {name: ctd, type: ctd, pressure_noise: " +
                          noise +
                          ", rate_hz: 9, latency_s: 0.07}\n"
                          "        - {name: dvl, type: dvl, preset: workhorse_600, velocity_noise: " +
                          noise +
                          ", rate_hz: 11}\n"
                          "        - {name: clock, type: clock, rate_hz: 9, truth: true}\n",
                      "{step_s: 0.002}",
                      "medium: {water: {surface_m: -1}}\n"
                      "objects: [{name: bottom, fixed: true, position_m: [0, 0, -8], parts: [{shape: plane}]}]\n"),
      [](TappedWorld& world, int step) {
        shoal::wrench_t wrench{};
        wrench.torque_Nm[step / 40 % 3] = step % 80 < 40 ? 0.1 : -0.1;
        wrench.force_N[0] = step % 100 < 50 ? 3 : -3;
        if (step % 20 == 0) world.send("r1.push.cmd", wrench);
      });
  run.expect_restored_worlds_go_on_alike({57, 303, 444}, 150);
}

TEST(DeviceState, ARouteRefusesAWaypointItDoesNotHave) {
  devices::Route route({10, 0.3, 3});
  route.start({devices::Waypoint{}, devices::Waypoint{}}, true, {0, 0});
  sim::StateArchive saver = sim::StateArchive::saver();
  saver(route);
  const sim::Bytes saved = saver.take_bytes();
  // Behind the index are two numbers of where it came from and the sum of errors: 24 bytes.
  sim::Bytes bad = saved;
  bad[saved.size() - 32] = std::byte{2};
  devices::Route other({10, 0.3, 3});
  sim::StateArchive good = sim::StateArchive::restorer(saved);
  good(other);
  EXPECT_EQ(other.size(), 2u);
  sim::StateArchive restorer = sim::StateArchive::restorer(bad);
  EXPECT_THROW(restorer(other), sim::SnapshotError);
}

}  // namespace
