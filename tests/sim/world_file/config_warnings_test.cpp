// SPDX-License-Identifier: BSD-3-Clause
#include "sim/world_file/config_warnings.hpp"

#include <gmock/gmock.h>

#include "tests/devices/world_fixture.hpp"
#include "tests/sim/medium/log_capture.hpp"

namespace {

using testing::HasSubstr;

/// What is warned of while a world is read; not what only building it shows.
std::string warnings_of_file(const std::string& yaml) {
  const test_support::LogCapture log;
  sim::load_world_text(yaml, "worlds/test.yaml", test::LoadedTestWorld::with_messages({}));
  return log.text();
}

std::string world(const std::string& devices, const std::string& more = "") {
  return "shoal: 1\nphysics: {step_s: 0.01}\nrun: {duration_s: 300}\n"
         "vehicles:\n  - name: r1\n    model:\n      shoal: 1\n      vehicle: box\n"
         "      bodies: [{name: hull, parts: [{shape: box, mass_kg: 1}]}]\n"
         "      devices:\n" +
         devices + more;
}

TEST(ConfigWarnings, ReportARateAboveThatOfTheSteps) {
  EXPECT_EQ(warnings_of_file(world("        - {name: imu, type: imu, rate_hz: 300}\n")),
            "worlds/test.yaml:11:43: vehicle 'r1': device 'imu': 'rate_hz' of 300 Hz is above the step rate: it "
            "becomes 100 Hz with 'step_s' 0.01\n");
}

TEST(ConfigWarnings, ReportBodiesThatNoJointsConnect) {
  const auto bodies = [](const std::string& joints) {
    return "bodies: [{name: seat, parts: [{shape: box, mass_kg: 1}]}, {name: foot, parts: [{shape: box, mass_kg: 1}]},"
           " {name: cup, parts: [{shape: box, mass_kg: 1}]}]\n    joints: [" +
           joints + "]\n";
  };
  const auto chair = [&](const std::string& joints) {
    return warnings_of_file("shoal: 1\nobjects:\n  - name: chair\n    " + bodies(joints));
  };
  const std::string joined = "{name: a, bodies: [seat, foot]}";
  EXPECT_EQ(chair(joined),
            "worlds/test.yaml:4:112: object 'chair': body 'cup': no joints connect it with body 'seat': "
            "it moves on its own\n");
  // By way of another body, or of the world.
  EXPECT_EQ(chair(joined + ", {name: b, bodies: [cup, foot]}"), "");
  EXPECT_EQ(chair(joined + ", {name: b, bodies: [cup, world]}, {name: c, bodies: [foot, world]}"), "");
  // The check of vehicles and objects is one.
  EXPECT_THAT(warnings_of_file("shoal: 1\nvehicles:\n- name: v1\n  model:\n    shoal: 1\n    " + bodies(joined)),
              HasSubstr("vehicle 'v1': body 'cup': no joints connect it with body 'seat'"));
  EXPECT_THAT(chair(joined + ", {name: b, type: fixed, bodies: [cup, foot], low_stop: 0}"),
              HasSubstr("object 'chair': joint 'b': 'low_stop' has no effect on a fixed joint"));
}

TEST(ConfigWarnings, ReportBodiesOfAnObjectThatAnEventAdds) {
  EXPECT_EQ(warnings_of_file("shoal: 1\nevents:\n- name: deliver\n  at: 1\n  do:\n"
                             "  - add: {object: {name: chair, bodies: [{name: seat, parts: [{shape: box, mass_kg: 1}]},"
                             " {name: foot, parts: [{shape: box, mass_kg: 1}]}]}}\n"),
            "worlds/test.yaml:6:91: event 'deliver': action 1: object 'chair': body 'foot': no joints connect it with "
            "body 'seat': it moves on its own\n");
}

TEST(ConfigWarnings, ReportHydrodynamicsOfAnObjectInADryWorld) {
  EXPECT_THAT(warnings_of_file("shoal: 1\nobjects:\n- name: float\n  bodies:\n  - name: hull\n"
                               "    parts: [{shape: box, mass_kg: 1}]\n"
                               "    hydrodynamics: {mass_kg: 10, inertia_kgm2: [1, 1, 1], volume_m3: 0.01}\n"),
              HasSubstr("object 'float': it has hydrodynamics, but the world has no 'medium: water:'"));
}

TEST(ConfigWarnings, AreSilentAboutTheRateOfTheSteps) {
  EXPECT_EQ(warnings_of_file(world("        - {name: imu, type: imu, rate_hz: 100}\n")), "");
  EXPECT_EQ(warnings_of_file(world("        - {name: imu, type: imu, rate_hz: every_step}\n")), "");
}

TEST(ConfigWarnings, ReportAUsualRateAboveThatOfTheSteps) {
  std::string yaml = world("        - {name: imu, type: imu}\n");
  yaml.replace(yaml.find("0.01"), 4, "0.02");
  EXPECT_THAT(warnings_of_file(yaml),
              HasSubstr("worlds/test.yaml:11:11: vehicle 'r1': device 'imu': its default rate of 100 Hz is above"));
}

TEST(ConfigWarnings, ReportRatesOfTheWorldAboveThatOfTheSteps) {
  std::string yaml = world("        []\n", "state_rate_hz: 200\n");
  yaml.replace(yaml.find("duration_s: 300"), 15, "track_rate_hz: 1000");
  EXPECT_THAT(warnings_of_file(yaml), HasSubstr("worlds/test.yaml:12:16: 'state_rate_hz' of 200 Hz is above"));
  EXPECT_THAT(warnings_of_file(yaml), HasSubstr("worlds/test.yaml:3:22: run: 'track_rate_hz' of 1000 Hz is above"));
}

TEST(ConfigWarnings, ReportErrorsOfAnglesThatAreMeantInDegrees) {
  const auto compass = [](const std::string& bias_std) {
    return world("        - {name: compass, type: compass, rate_hz: 10, heading_noise: {bias_std: " + bias_std +
                 "}}\n");
  };
  // 3 rad = 171.89 deg.
  EXPECT_THAT(
      warnings_of_file(compass("3")),
      HasSubstr("vehicle 'r1': device 'compass': 'bias_std' of 'heading_noise' is in radians, and 3 of them are "
                "172 degrees\n"));
  EXPECT_EQ(warnings_of_file(compass("0.05")), "");
}

TEST(ConfigWarnings, ReportOnceOfAKindOfVehicle) {
  std::string yaml = world("        - {name: imu, type: imu, rate_hz: 300}\n");
  yaml.replace(yaml.find("    model:"), 10, "    count: 20\n    model:");
  const std::string text = warnings_of_file(yaml);
  EXPECT_EQ(std::count(text.begin(), text.end(), '\n'), 1);
}

TEST(ConfigWarnings, ReportKeysOfReportsOfADeviceThatReportsNothing) {
  EXPECT_EQ(warnings_of_file(world("        - {name: push, type: body_wrench, rate_hz: 10}\n")),
            "worlds/test.yaml:11:52: vehicle 'r1': device 'push': 'rate_hz' has no effect: a device of type "
            "'body_wrench' publishes no reports\n");
}

TEST(ConfigWarnings, ReportAPlaceOfADeviceThatHasNone) {
  EXPECT_EQ(warnings_of_file(world("        - {name: power, type: battery, capacity_Wh: 10, rpy_deg: [0, 0, 90]}\n")),
            "worlds/test.yaml:11:66: vehicle 'r1': device 'power': 'rpy_deg' has no effect on a device of type "
            "'battery'\n");
}

TEST(ConfigWarnings, ReportAnInertiaThatNoSolidHas) {
  const auto warnings = [](const std::string& inertia) {
    std::string yaml = world("        []\n");
    const std::string hull = "{name: hull, ";
    yaml.replace(yaml.find(hull), hull.size(),
                 hull + "hydrodynamics: {model: none, mass_kg: 100, inertia_kgm2: " + inertia + "}, ");
    return warnings_of_file(yaml);
  };
  EXPECT_EQ(warnings("[10, 10, 10]"), "");
  EXPECT_THAT(warnings("[11, 100, 10]"), HasSubstr("vehicle 'r1': body 'hull': no solid has its principal moments"));
  EXPECT_THAT(warnings("[1e-9, 1e-9, 1e-9]"), HasSubstr("less than a tenth of that of a sphere"));
}

std::string warnings_of_joint(const std::string& keys) {
  std::string yaml = world("        []\n");
  const std::string hull = "{name: hull, parts: [{shape: box, mass_kg: 1}]}";
  yaml.replace(yaml.find(hull), hull.size(), hull + ", {name: arm, parts: [{shape: box, mass_kg: 1}]}");
  return warnings_of_file(yaml + "      joints:\n        - {name: j, bodies: [hull, arm], " + keys + "}\n");
}

TEST(ConfigWarnings, ReportKeysOfJointsThatTheirTypeDoesNotHave) {
  const std::string second_axis = ", axis2: {axis: [0, 1, 0], ";
  EXPECT_EQ(warnings_of_joint("type: hinge2" + second_axis + "low_stop: -1}"),
            "worlds/test.yaml:13:91: vehicle 'r1': joint 'j': 'low_stop' has no effect on a hinge2's second axis\n");
  EXPECT_THAT(warnings_of_joint("type: hinge2" + second_axis + "suspension_erp: 0.5}"),
              HasSubstr("'suspension_erp' has no effect on a hinge2's second axis"));
  EXPECT_THAT(warnings_of_joint("type: hinge, suspension_erp: 0.5"),
              HasSubstr("'suspension_erp' has no effect on a hinge\n"));
  EXPECT_THAT(warnings_of_joint("type: slider, erp: 0.5"), HasSubstr("'erp' has no effect on a slider\n"));
  EXPECT_THAT(warnings_of_joint("type: ball, high_stop: 1"),
              HasSubstr("'high_stop' has no effect on a ball without 'motor: true'\n"));
  const std::string of_fixed =
      warnings_of_joint("type: fixed, axis: [1, 0, 0], low_stop: -1, high_stop: 1, cfm: 0.1, damping: 1");
  for (const std::string key : {"axis", "low_stop", "high_stop", "cfm", "damping"})
    EXPECT_THAT(of_fixed, HasSubstr("'" + key + "' has no effect on a fixed joint\n"));
}

TEST(ConfigWarnings, AreSilentAboutTheKeysOfATypeOfJoint) {
  const std::string stops = "low_stop: -1, high_stop: 1, restitution: 0.1, stop_erp: 0.1, stop_cfm: 0.1";
  const std::string motor = "motor_velocity: 1, motor_max_force: 1, cfm: 0.1, fudge_factor: 0.5, damping: 1";
  for (const std::string type : {"hinge", "slider"})
    EXPECT_EQ(warnings_of_joint("type: " + type + ", axis: [1, 0, 0], " + stops + ", " + motor), "");
  EXPECT_EQ(warnings_of_joint("type: universal, axis2: {axis: [0, 1, 0], " + stops + ", " + motor + "}, " + stops), "");
  EXPECT_EQ(warnings_of_joint("type: hinge2, axis2: {axis: [0, 1, 0], motor_max_force: 1}, suspension_erp: 0.5, " +
                              stops + ", " + motor),
            "");
  EXPECT_EQ(warnings_of_joint("type: ball, motor: true, erp: 0.5, " + stops + ", " + motor), "");
  EXPECT_EQ(warnings_of_joint("type: fixed, erp: 0.5"), "");
}

TEST(ConfigWarnings, ReportPlacesAsFarFromTheOriginAsThoseOfAMapInUtm) {
  const auto at = [](const std::string& place, const std::string& more = "") {
    std::string yaml = world("        []\n", more);
    yaml.replace(yaml.find("    model:"), 10, "    position_m: " + place + "\n    model:");
    return warnings_of_file(yaml);
  };
  const std::string objects =
      "objects:\n  - {name: rock, position_m: [326060, 4690000, 0], fixed: true, parts: [{shape: box}]}\n"
      "  - {name: dock, position_m: [326080, 4690000, 0], fixed: true, parts: [{shape: box}]}\n";
  // hypot(326.06, 4690) = 4701.3.
  EXPECT_EQ(at("[326060, 4690000, 0]"),
            "worlds/test.yaml:5:5: vehicle 'r1': it is 4701 km from the world's origin: the world is flat, so that a "
            "GPS there is far above the earth; give coordinates of a map, such as UTM, relative to 'origin'\n");
  EXPECT_THAT(at("[0, 0, 0]", objects),
              HasSubstr("object 'rock': it is 4701 km from the world's origin, and 1 more are as far"));
  EXPECT_EQ(at("[100000, -100000, -6000]"), "");  // 141 km
}

TEST(ConfigWarnings, ReportAMetricOfAChannelOnWhichNoOnePublishes) {
  const std::string gps = "        - {name: gps, type: gps}\n";
  const auto metric = [&](const std::string& channel, const std::string& more = "") {
    return warnings_of_file(world(
        gps, "metrics:\n  - {name: error, type: position_error, vehicle: r1, channel: " + channel + "}\n" + more));
  };
  EXPECT_EQ(metric("r1.estimate"),
            "worlds/test.yaml:13:5: metric 'error': nothing in this world publishes on 'r1.estimate', and it starts no "
            "programs: only one started by hand can\n");
  EXPECT_THAT(metric("r1.gps.truth"), HasSubstr("(device 'gps' needs 'truth: true')"));
  EXPECT_EQ(metric("r1.gps"), "");
  EXPECT_EQ(metric("r1.estimate", "processes: [{name: p, command: [some_program]}]\n"), "");
  EXPECT_EQ(
      metric("r1.estimate",
             "events: [{name: e, at: 1, do: [{publish: {channel: r1.estimate, type: shoal.utime_t, value: {}}}]}]\n"),
      "");
}

TEST(ConfigWarnings, ReportMetricsAndEventsAfterTheEnd) {
  const std::string gps = "        - {name: gps, type: gps}\n";
  EXPECT_THAT(warnings_of_file(world(
                  gps, "metrics: [{name: error, type: position_error, vehicle: r1, channel: r1.gps, from_s: 300}]\n")),
              HasSubstr("'from_s' 300 is not before the end of the run at 300 s: nothing counts"));
  EXPECT_THAT(warnings_of_file(world(gps, "events: [{name: late, at: [310, 320], do: [{log: late}]}]\n")),
              HasSubstr("event 'late': it fires at 310 s, but the run ends at 300 s"));
  EXPECT_EQ(warnings_of_file(world(gps, "events: [{name: some, at: [10, 320], do: [{log: late}]}]\n")), "");
}

TEST(ConfigWarnings, ReportAnEventThatNothingTriggers) {
  const std::string gps = "        - {name: gps, type: gps}\n";
  EXPECT_THAT(warnings_of_file(world(gps, "events: [{name: idle, do: [{log: x}]}]\n")),
              HasSubstr("event 'idle': it has no 'at', 'every' or 'when', and no event triggers it"));
  EXPECT_EQ(warnings_of_file(world(gps,
                                   "events: [{name: idle, do: [{log: x}]}, {name: go, at: 1, do: [{one_of: {choices: "
                                   "[[{trigger: idle}]]}}]}]\n")),
            "");
}

TEST(ConfigWarnings, AreOfWhatComesAfterTheEndOfTheFileAndOfTheCommandLine) {
  const std::string text =
      world("        - {name: gps, type: gps}\n", "events: [{name: late, at: [310], do: [{log: late}]}]\n");
  const auto warnings_of = [&](std::optional<double> duration_s) {
    sim::LoadOptions options = test::LoadedTestWorld::with_messages({});
    options.duration_s = duration_s;
    const test_support::LogCapture log;
    sim::load_world_text(text, "worlds/test.yaml", options);
    return log.text();
  };
  EXPECT_THAT(warnings_of({}), HasSubstr("ends at 300 s"));
  EXPECT_THAT(warnings_of(10), HasSubstr("ends at 300 s")) << "as in the whole run";
  EXPECT_THAT(warnings_of(305), HasSubstr("ends at 305 s"));
  EXPECT_EQ(warnings_of(311), "");
  EXPECT_EQ(warnings_of(0), "") << "without end";
}

TEST(ConfigWarnings, ReportASpreadingThatRaysDoNotHave) {
  const auto text = [](const std::string& acoustics) {
    return warnings_of_file(world("        []\n",
                                  "medium: {water: {surface_m: -9, profile: [{depth_m: 0, sound_speed_mps: 1510}, "
                                  "{depth_m: 20, sound_speed_mps: 1490}]}}\nacoustics: " +
                                      acoustics + "\n"));
  };
  EXPECT_EQ(text("{spreading: {factor: 1.5}}"),
            "worlds/test.yaml:13:24: acoustics: 'spreading' has no effect: in this water sound travels along rays, "
            "whose ray tubes give the spreading; remove it, or set 'propagation: straight'\n");
  EXPECT_THAT(text("{spreading: {transition_range_m: 100}}"), HasSubstr("'spreading' has no effect"));
  EXPECT_EQ(text("{spreading: {factor: 2}}"), "");
  EXPECT_EQ(text("{spreading: {factor: 1.5}, propagation: straight}"), "");
  EXPECT_EQ(text("{}"), "");
}

}  // namespace
