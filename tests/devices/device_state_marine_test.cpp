// SPDX-License-Identifier: BSD-3-Clause
// What devices in the water and some others must keep over a snapshot; tests/devices/device_state_test.cpp has the
// rest.
#include <limits>

#include "shoal/actuator_command_t.hpp"
#include "shoal/helm_command_t.hpp"
#include "shoal/nmea_sentence_t.hpp"
#include "shoal/twist_command_t.hpp"
#include "sim/physics/physics_world.hpp"
#include "tests/devices/comms/modem_fixture.hpp"
#include "tests/devices/state_fixture.hpp"

namespace {

constexpr double nothing = std::numeric_limits<double>::quiet_NaN();
/// An error that lasts from sample to sample, in each of its slow parts.
const std::string slow_error = "{bias_std: 0.1, random_walk_std: 0.05, gauss_markov_std: 0.1, gaussian_std: 0.02}";

void command(test::TappedWorld& to, const std::string& device, double value) {
  shoal::actuator_command_t message{};
  message.value = value;
  to.send(device + ".cmd", message);
}

TEST(DeviceState, ARoverAndWhatItSeesContinueAfterARestore) {
  const std::string devices =
      "        - {name: drive, type: differential_drive, left_joint: left, right_joint: right, wheel_radius_m: 0.1, "
      "track_m: 0.5, max_acceleration_mps2: 0.5}\n"
      "        - {name: odometry, type: odometry, left_joint: left, right_joint: right, truth: true, noise: " +
      slow_error +
      "}\n"
      "        - {name: encoder, type: wheel_encoder, joints: [left, right], missed_ticks: 0.1, truth: true, noise: " +
      slow_error +
      "}\n"
      "        - {name: beacon, type: range_beacon, rate_hz: 20, bearing: true, elevation: true, beacon_dropout: 0.3, "
      "beacons: [{name: tower, position_m: [20, 3, 5]}], position_m: [0, 0, 1], range_noise: " +
      slow_error + ", bearing_noise: " + slow_error +
      "}\n"
      "        - {name: swarm, type: swarm_position, rate_hz: 20, absolute: true, position_m: [0, 0, 1], "
      "relative_noise: " +
      slow_error + ", absolute_noise: " + slow_error +
      "}\n"
      "        - {name: scan, type: lidar, rate_hz: 7, beams: 20, intensities: true, position_m: [0, 0, 1], noise: " +
      slow_error +
      "}\n"
      "        - {name: cloud, type: lidar3d, rate_hz: 3, rings: 4, columns: 90, position_m: [0, 0, 1.2], "
      "range_std_m: 0.02}\n";
  const std::string box =
      ", model: {shoal: 1, vehicle: box, bodies: [{name: b, position_m: [0, 0, 0.2], parts: [{shape: box, size_m: "
      "[0.4, 0.4, 0.4], mass_kg: 5}]}], devices: [{name: b, type: range_beacon, beacon_only: true}]}}\n";
  const std::string yaml = test::rover_world(devices) + "  - {name: near, position_m: [1, 6, 0]" + box +
                           "  - {name: far, position_m: [8, 2, 0]" + box;
  test::SavedRun run(yaml, [](test::TappedWorld& to, int step) {
    if (step == 20) to.send("r1.drive.cmd", shoal::twist_command_t{0, 0.6, 0.4});
    if (step == 700) to.send("r1.drive.cmd", shoal::twist_command_t{0, -0.2, -1});
  });
  // The head of the scanner turns in 333 steps: begun, about to end, and in the middle.
  run.expect_restored_worlds_go_on_alike({30, 330, 505}, 700);
}

TEST(DeviceState, ASonarThatHasLeftTheWaterKnowsWhatTheWaterWasLike) {
  const std::string sonar = ", frequency_kHz: 200, tvg: 40log, range_max_m: 20";
  const std::string devices =
      "{name: side, type: side_scan, rate_hz: 20, rays: 20, bins: 16, floor_dB: 40" + sonar +
      "}, {name: ahead, type: sonar, rate_hz: 20, noise: " + slow_error + sonar +
      "}, {name: swath, type: multibeam, rate_hz: 20, beams: 8, noise: " + slow_error + sonar +
      "}, {name: speed, type: water_speed, rate_hz: 50, speed_noise: " + slow_error +
      "}, {name: pressure, type: pressure, rate_hz: 50, pressure_noise: " + slow_error +
      ", temperature_noise: " + slow_error +
      "}, {name: leak, type: leak, rated_depth_m: 0.3, rate_hz: 50, water_noise: " + slow_error + "}";
  const std::string yaml =
      "shoal: 1\nphysics: {step_s: 0.01, gravity_mps2: 0}\nobjects: [{name: bottom, fixed: true, position_m: [0, 0, "
      "-5], parts: [{shape: plane}]}]\nmedium: {water: {surface_m: 0, profile: [{depth_m: 0, temperature_C: 20, "
      "salinity_psu: 30}, {depth_m: 5, temperature_C: 10, salinity_psu: 36}]}}\nvehicles:\n  - {name: v, position_m: "
      "[0, 0, -0.5], model: {shoal: 1, vehicle: box, bodies: [{name: hull, hydrodynamics: {model: none}, parts: "
      "[{shape: box, size_m: [0.1, 0.1, 0.1], mass_kg: 1}]}], devices: [" +
      devices + "]}}\n";
  test::SavedRun run(yaml, [](test::TappedWorld& to, int step) {
    if (step != 0) return;
    for (const auto& [name, body] : to.world.find_vehicle("v")->bodies())
      body->set_velocity_W({0.3, 0, 1}, {0, 0, 0.1});
  });
  // It comes through the surface after 50 steps.
  run.expect_restored_worlds_go_on_alike({33, 77}, 60);
}

TEST(DeviceState, ASonarThatIsChangedBetweenPingsHasAnEmptyImage) {
  const std::string yaml =
      "shoal: 1\nphysics: {step_s: 0.01, gravity_mps2: 0}\nobjects: [{name: bottom, fixed: true, position_m: [0, 0, "
      "-5], parts: [{shape: plane}]}]\nmedium: {water: {}}\nvehicles:\n  - {name: v, position_m: [0, 0, -2], model: "
      "{shoal: 1, vehicle: box, bodies: [{name: hull, hydrodynamics: {model: none}, parts: [{shape: box, size_m: [0.1, "
      "0.1, 0.1], mass_kg: 1}]}], devices: [{name: side, type: side_scan, rate_hz: 5, phase_s: 0, rays: 20, bins: 16, "
      "floor_dB: 40, frequency_kHz: 200, range_max_m: 20}, {name: tilt, type: inclinometer, rate_hz: 50}]}}\n"
      "events: [{name: change, at: 0.55, do: [{set: {device: v/side, values: {floor_dB: 30}}}]}]\n";
  // Restored between a ping and the change, it continues to after the change and before the next ping at 0.6 s.
  test::SavedRun run(yaml);
  run.expect_restored_worlds_go_on_alike({52}, 6);
}

TEST(DeviceState, PingsAndAnswersOnTheirWayArriveAfterARestore) {
  const auto transponder = [](const std::string& network) {
    return "{name: t, type: transponder, rate_hz: 5, turnaround_s: 0.2, network: " + network + "}";
  };
  const std::string asking =
      "{name: usbl, type: usbl, network: a, rate_hz: 20, ping_period_s: 0.7, answer_dropout: 0.2, range_noise: " +
      slow_error + ", azimuth_noise: " + slow_error + ", elevation_noise: " + slow_error +
      "}, {name: lbl, type: lbl, network: b, rate_hz: 20, ping_period_s: 1.1, answer_dropout: 0.2, frequency_Hz: "
      "40000, "
      "time_noise: {random_walk_std: 1.0e-4, gaussian_std: 1.0e-5}}";
  const std::string yaml = test::modem_sea({{"asking", "[0, 0, -20]", asking},
                                            {"a1", "[300, 0, -20]", transponder("a")},
                                            {"a2", "[0, 450, -30]", transponder("a")},
                                            {"b1", "[200, 100, -20]", transponder("b, frequency_Hz: 40000")},
                                            {"b2", "[-500, 0, -25]", transponder("b, frequency_Hz: 40000")}});
  test::SavedRun run(yaml);
  // While pings are on their way, answers are, and both have come to some.
  run.expect_restored_worlds_go_on_alike({10, 35, 73, 120, 261}, 300);
}

TEST(DeviceState, MessagesInTheQueuesOfModemsAreSentAfterARestore) {
  const std::string radio =
      "{name: radio, type: modem, data_rate_bps: 100, range_m: 1000, rate_hz: 3, loss_probability: "
      "0.3}";
  const std::string yaml = test::modem_sea({{"a", "[0, 0, 5]", radio}, {"b", "[30, 0, 5]", radio}});
  test::SavedRun run(yaml, [](test::TappedWorld& to, int step) {
    // 5 s of air time in the queue.
    if (step != 5) return;
    for (const char* text : {"the first of all", "and the second", "a third", "number four", "five", "six", "seven"})
      to.send("a.radio.cmd", test::bytes_to(text));
    to.send("b.radio.cmd", test::bytes_to("something back", "a"));
  });
  run.expect_restored_worlds_go_on_alike({6, 100, 333, 402}, 300);
}

TEST(DeviceState, AMicromodemContinuesInTheMiddleOfACycle) {
  const auto modem = [](int address) {
    return "{name: modem, type: micromodem, rate_hz: 10, address: " + std::to_string(address) + "}";
  };
  const std::string yaml = test::modem_sea(
      {{"a", "[0, 0, -20]", modem(1)}, {"b", "[750, 0, -20]", modem(2)}, {"c", "[-300, 0, -20]", modem(3)}});
  test::SavedRun run(yaml, [](test::TappedWorld& to, int step) {
    const auto host = [&](const std::string& vehicle, const std::string& sentence) {
      shoal::nmea_sentence_t message{};
      message.sentence = sentence;
      to.send(vehicle + ".modem.cmd", message);
    };
    if (step == 3) host("a", "$CCCFG,SRC,1"), host("b", "$CCCFG,DTO,3"), host("b", "$CCCLK,2020,1,2,3,4,5");
    if (step == 10) host("a", "$CCCYC,0,1,2,2,1,3");
    if (step == 20) host("a", "$CCTXD,1,2,1,0a0b0c");
    if (step == 30) host("a", "$CCTXD,1,2,1,0d");
    if (step == 40) host("a", "$CCTXD,1,2,0,0e");
    if (step == 200) host("b", "$CCCYC,0,3,2,0,0,1");  // it asks c for data, which does not come
    if (step == 1500) host("c", "$CCMPC,3,1");
    if (step == 1505) host("c", "what is not a sentence");
  });
  // Frames gathered; a packet in the water; the answer awaited; a ping.
  run.expect_restored_worlds_go_on_alike({25, 35, 130, 420, 1550}, 900);
}

TEST(DeviceState, AMicromodemContinuesWithAnotherAddressAndATimeThatWaitsForThePulse) {
  const std::string modem = "{name: modem, type: micromodem, rate_hz: 10, revision: 2.0.26038, address: ";
  const std::string yaml = test::modem_sea({{"a", "[0, 0, -20]", modem + "1, lbl: {transponders: [b]}}"},
                                            {"b", "[750, 0, -20]", modem + "2}, {name: beacon, type: transponder}"}});
  test::SavedRun run(yaml, [](test::TappedWorld& to, int step) {
    const auto host = [&](const std::string& vehicle, const std::string& sentence) {
      shoal::nmea_sentence_t message{};
      message.sentence = sentence;
      to.send(vehicle + ".modem.cmd", message);
    };
    if (step == 3) host("a", "$CCCFG,ALL,0"), host("a", "$CCCFG,SRC,9"), host("a", "$CCCFG,SNV,1");
    if (step == 10) host("a", "$CCTMS,2031-01-01T00:00:00Z,1");
    if (step == 120) host("a", "$CCPGT,26000,28,1f,2000,25000,1,0,0,0,2000,0");
    if (step == 400) host("b", "$CCMPC,2,9");
    if (step == 1300) host("a", "$CCTMQ,0");
  });
  // Before the pulse; between ping and answer; a ping to the other address.
  run.expect_restored_worlds_go_on_alike({20, 150, 420}, 900);
}

TEST(DeviceState, MarineActuatorsContinueAfterARestore) {
  const std::string yaml = R"(shoal: 1
physics: {step_s: 0.01}
medium: {water: {surface_m: 0}, wind: {speed_mps: 6, from_compass_deg: 250}}
vehicles:
  - name: boat
    model:
      shoal: 1
      vehicle: boat
      bodies: [{name: hull, parts: [{shape: box, size_m: [2, 1, 0.5], density_kgpm3: 400}]}]
      devices:
        - {name: screw, type: thruster, position_m: [-1, 0.2, -0.2], lag_s: 0.7, ahead: 60, full_power_W: 100}
        - {name: sail, type: sail, position_m: [0, 0, 1.2], area_m2: 0.5, rate_degps: 20}
        - {name: weight, type: moving_mass, mass_kg: 20, rate_mps: 0.01}
        - {name: noise, type: noise_source, position_m: [0, 0, -0.2], kind: pulses, period_s: 0.3}
        - {name: hum, type: noise_source, position_m: [0, 0, -0.2], level_dB: 120}
        - {name: battery, type: battery, capacity_Wh: 10}
        - {name: imu, type: imu, rate_hz: 20}
  - name: naive
    position_m: [-10, -10, -5]
    model:
      shoal: 1
      vehicle: naive
      bodies: [{name: hull, kinematic: true, parts: [{shape: sphere, radius_m: 0.2, mass_kg: 1}]}]
      devices: [{name: drive, type: naive_drive}, {name: imu, type: imu, rate_hz: 20}]
)";
  test::SavedRun run(yaml, [](test::TappedWorld& to, int step) {
    if (step == 5) {
      command(to, "boat.screw", 0.8);
      command(to, "boat.sail", 0.4);
      command(to, "boat.weight", 0.04);
      to.send("naive.drive.cmd", shoal::helm_command_t{0, 1.5, 2, 12, nothing});
    }
    if (step == 150) command(to, "boat.hum", 0), command(to, "boat.noise", 0), command(to, "boat.sail", 1);
  });
  run.expect_restored_worlds_go_on_alike({20, 140, 180}, 200);
}

}  // namespace
