// SPDX-License-Identifier: BSD-3-Clause
#include "sim/world/world_checks.hpp"

#include <gmock/gmock.h>

#include <limits>

#include "shoal/helm_command_t.hpp"
#include "shoal/waypoints_command_t.hpp"
#include "sim/vehicle/vehicle.hpp"
#include "sim/world/world_state.hpp"
#include "tests/devices/navigation/immersed_sensor_fixture.hpp"
#include "tests/devices/world_fixture.hpp"
#include "tests/sim/medium/log_capture.hpp"

namespace {

using testing::HasSubstr;

/// Water with its surface at 2 m, and these objects.
std::string fault_at(const std::string& objects, double depth_m, const Eigen::Vector2d& p_W = {0, 0}) {
  test::TestWorld test("shoal: 1\nmedium: {water: {surface_m: 2}}\nobjects: [" + objects + "]\n");
  return sim::depth_fault(test.world, p_W, depth_m);
}

const std::string plane_at_40_m = "{name: bottom, fixed: true, position_m: [0, 0, -38], parts: [{shape: plane}]}";

TEST(PlanCheck, ADepthBelowZeroIsInTheAir) {
  EXPECT_EQ(fault_at("", -15), "depth -15 m is in the air: depths are positive downwards");
  EXPECT_EQ(fault_at("", 0), "");
  EXPECT_EQ(fault_at("", 15), "");
}

TEST(PlanCheck, FindsAPlaceBelowAPlane) {
  EXPECT_EQ(fault_at(plane_at_40_m, 55), "depth 55 m is below the bottom, which is at 40 m there");
  EXPECT_EQ(fault_at(plane_at_40_m, 39.9), "");
}

TEST(PlanCheck, FindsAPlaceBelowTerrainAtItsOwnHeight) {
  // A slope of 10 deg through (0, 0, -20).
  const std::string slope =
      "{name: bottom, fixed: true, position_m: [0, 0, -20], parts: [{shape: terrain, terrain: {source: slope, "
      "angle_deg: 10, size_m: [100, 100], cell_m: 1}}]}";
  EXPECT_EQ(fault_at(slope, 21.9), "");
  EXPECT_THAT(fault_at(slope, 22.1), HasSubstr("which is at 22 m there"));
}

TEST(PlanCheck, FindsAPlaceInASolidAndNotUnderAPierOrAShip) {
  const auto box = [](const std::string& keys, double height_m) {
    return "{name: box, " + keys + ", position_m: [0, 0, " + std::to_string(height_m) +
           "], parts: [{shape: box, size_m: [10, 10, 4], mass_kg: 1}]}";
  };
  EXPECT_EQ(fault_at(box("fixed: true", -20), 21), "depth 21 m is below the bottom, which is at 20 m there");
  EXPECT_EQ(fault_at(box("fixed: true", -20), 21, {6, 0}), "");
  EXPECT_EQ(fault_at(box("fixed: true", 0) + ", " + plane_at_40_m, 21), "");
  EXPECT_EQ(fault_at(box("fixed: false", -20), 21), "");
}

/// What `check` says of an AUV at 10 m with these keys of its autopilot, over a plane at 40 m.
std::string warnings_of_autopilot(const std::string& keys) {
  const test_support::LogCapture log;
  test::TestWorld test(
      "shoal: 1\nphysics: {step_s: 0.01}\nmedium: {water: {surface_m: 2}}\nobjects: [" + plane_at_40_m +
      "]\nvehicles:\n  - name: v\n    file: remus100_survey.yaml\n    position_m: [0, 0, -8]\n    overrides:\n      " +
      keys + "\n");
  return log.text();
}

TEST(PlanCheck, WarnsOfTheDepthsOfAnAutopilot) {
  const auto lawnmower = [](const std::string& depth) {
    return "devices.autopilot.lawnmower: {corner_m: [0, 0], length_m: 50, width_m: 20, spacing_m: 10, speed_mps: 1.5" +
           depth + "}";
  };
  EXPECT_EQ(warnings_of_autopilot(lawnmower(", depth_m: 15")), "");
  EXPECT_EQ(warnings_of_autopilot(lawnmower(", altitude_m: 5")), "");
  // Once, and not for each of the six points.
  EXPECT_EQ(
      warnings_of_autopilot(lawnmower(", depth_m: -15")),
      "worlds/test.yaml:10:36: vehicle 'v': device 'autopilot': 'lawnmower': depth -15 m is in the air: depths are "
      "positive downwards\n");
  EXPECT_THAT(warnings_of_autopilot(lawnmower(", depth_m: 55")),
              HasSubstr("'lawnmower': depth 55 m is below the bottom, which is at 40 m there"));
  EXPECT_THAT(warnings_of_autopilot("devices.autopilot.hold: {depth_m: -15}"),
              HasSubstr("'hold': depth -15 m is in the air"));
  EXPECT_THAT(warnings_of_autopilot("devices.autopilot.waypoints: [{at_m: [5, 0], speed_mps: 1, depth_m: 55}]"),
              HasSubstr("'waypoints': depth 55 m"));
}

TEST(PlanCheck, WarnsOfARouteThatBeginsWithoutASpeed) {
  const std::string stands = "begins without a speed: the vehicle stands still until a command gives one";
  EXPECT_THAT(warnings_of_autopilot("devices.autopilot.waypoints: [{at_m: [5, 0]}, {at_m: [9, 0], speed_mps: 1}]"),
              HasSubstr("'waypoints' " + stands));
  EXPECT_THAT(warnings_of_autopilot("devices.autopilot.lawnmower: {corner_m: [0, 0], altitude_m: 5}"),
              HasSubstr("'lawnmower' " + stands));
  EXPECT_EQ(warnings_of_autopilot(
                "devices.autopilot.hold: {speed_mps: 1}\n      devices.autopilot.waypoints: [{at_m: [5, 0]}]"),
            "");
}

/// How many warnings a craft gets that is in open water and carries these.
std::size_t warnings_with(const std::string& devices) {
  test::TestWorld test(R"(
shoal: 1
medium: {water: {}}
vehicles:
  - name: auv
    position_m: [0, 0, -2]
    model:
      shoal: 1
      vehicle: auv
      bodies: [{name: hull, parts: [{shape: sphere, radius_m: 0.1, density_kgpm3: 1025}]}]
      devices: [{name: push, type: body_wrench}, )" +
                       devices + "]\n");
  return sim::bottom_warnings(test.world).size();
}

TEST(BottomCheck, IsForCraftThatLookForTheBottom) {
  for (const std::string type : {"dvl", "altimeter", "sonar", "multibeam", "side_scan", "imaging_sonar"})
    EXPECT_EQ(warnings_with("{name: it, type: " + type + "}"), 1u) << type;
  for (const std::string type : {"gps", "imu", "pressure", "ctd", "water_speed", "ahrs"})
    EXPECT_EQ(warnings_with("{name: it, type: " + type + "}"), 0u) << type;
}

TEST(BottomCheck, IsForAutopilotsThatKeepAnAltitude) {
  const auto warnings = [](const std::string& keys) {
    return warnings_with(
        "{name: thruster, type: thruster, command: thrust_N, max: 20, min: -20}, "
        "{name: pilot, type: autopilot, thrusters: [thruster], " +
        keys + "}");
  };
  EXPECT_EQ(warnings("hold: {depth_m: 3}"), 0u);
  EXPECT_EQ(warnings("hold: {altitude_m: 3}"), 1u);
  EXPECT_EQ(warnings("waypoints: [{at_m: [10, 0], depth_m: 3}]"), 0u);
  EXPECT_EQ(warnings("waypoints: [{at_m: [10, 0], depth_m: 3}, {at_m: [20, 0], altitude_m: 3}]"), 1u);
  EXPECT_EQ(warnings("lawnmower: {corner_m: [0, 0], altitude_m: 5}"), 1u);
}

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

/// A program waits for the sensors, unless `is_awaited` is false.
std::vector<std::string> ended(const test::LoadedTestWorld& test, bool is_awaited = true) {
  return sim::end_warnings(test.world, [is_awaited](const std::string&) { return is_awaited; });
}

/// The fixture's device has a rate, which this replaces.
std::string slower(std::string yaml) {
  const std::string rate = "rate_hz: 100, phase_s: 0, ";
  yaml.erase(yaml.find(rate), rate.size());
  return yaml;
}

/// The end of a run with one device at a depth of 10 m over a bottom at 30 m.
std::vector<std::string> end_of(const std::string& device, double run_s = 61,
                                const std::string& position_m = "[0, 0, -10]") {
  test::TestWorld test(
      slower(test::marine_world("rate_hz: 2, phase_s: 0, " + device, position_m, test::bottom_at(-30))));
  test.run_for(run_s);
  return ended(test);
}

TEST(EndCheck, NamesASensorThatNeverHadLockOrFix) {
  // First samples at 0.5 s, for that at 0 s comes before the first step.
  EXPECT_THAT(end_of("type: dvl, altitude_max_m: 5"), ElementsAre("device 'r1/s': no bottom lock in 60.5 s"));
  EXPECT_THAT(end_of("type: gps"), ElementsAre("device 'r1/s': no fix under water in 60.5 s"));
  EXPECT_THAT(end_of("type: altimeter, range_max_m: 5"), ElementsAre("device 'r1/s': no echo of the bottom in 60.5 s"));
  EXPECT_THAT(end_of("type: usbl"), ElementsAre("device 'r1/s': no answer of a transponder in 60.5 s"));
  EXPECT_THAT(end_of("type: lbl"), ElementsAre("device 'r1/s': no answer of a transponder in 60.5 s"));
  EXPECT_THAT(end_of("type: range_beacon"), ElementsAre("device 'r1/s': no beacon in range in 60.5 s"));
}

TEST(EndCheck, IsSilentAboutSensorsThatHadOneAndInTheFirstMinute) {
  EXPECT_THAT(end_of("type: dvl"), IsEmpty());
  EXPECT_THAT(end_of("type: altimeter"), IsEmpty());
  EXPECT_THAT(end_of("type: gps", 61, "[0, 0, 0.2]"), IsEmpty());
  EXPECT_THAT(end_of("type: range_beacon, beacons: [{name: b, position_m: [5, 0, 1]}]", 61, "[0, 0, 1]"), IsEmpty());
  EXPECT_THAT(end_of("type: range_beacon, beacon_only: true"), IsEmpty());
  EXPECT_THAT(end_of("type: dvl, altitude_max_m: 5", 59), IsEmpty());
}

TEST(EndCheck, TakesItForUsualThatAGpsUnderWaterHasNoFixUnlessAProgramWaits) {
  test::TestWorld test(slower(test::marine_world("rate_hz: 2, type: gps")));
  test.run_for(61);
  EXPECT_THAT(ended(test, false), IsEmpty());
  EXPECT_EQ(ended(test).size(), 1u);
}

TEST(EndCheck, DoesNotCountTheTimeInWhichASensorIsOff) {
  test::TestWorld test(slower(test::marine_world("rate_hz: 2, phase_s: 0, type: gps")));
  test.run_for(59);
  test.world.vehicles().front()->systems().powered = false;
  test.run_for(10);
  EXPECT_THAT(ended(test), IsEmpty());
}

TEST(EndCheck, RemembersALockThatWasLost) {
  test::TestWorld test(slower(test::marine_world("rate_hz: 2, type: gps", "[0, 0, 0.2]")));
  test.run_for(1);
  const sim::Bytes at_surface = test.world.state().snapshot();
  test.world.editor().move_vehicle("r1", sim::make_pose({0, 0, -10}, sim::Vector3d::Zero()));
  test.run_for(70);
  EXPECT_THAT(ended(test), IsEmpty());
  // So does a run that continues from a snapshot.
  test::TestWorld other(slower(test::marine_world("rate_hz: 2, type: gps", "[0, 0, 0.2]")));
  other.world.state().restore(at_surface);
  other.world.editor().move_vehicle("r1", sim::make_pose({0, 0, -10}, sim::Vector3d::Zero()));
  other.run_for(70);
  EXPECT_THAT(ended(other), IsEmpty());
}

/// A ball of 2 cm radius that flies at a plate of 20 mm.
struct Flight {
  std::vector<std::string> warnings;
  double end_m;
};

struct FlyingBall : test::TestWorld {
  FlyingBall(double speed_mps, double step_s, double start_m)
      : TestWorld("shoal: 1\nphysics: {step_s: " + std::to_string(step_s) +
                  ", gravity_mps2: 0}\nobjects:\n  - {name: plate, fixed: true, parts: [{shape: box, size_m: "
                  "[0.02, 1, 1]}]}\n  - {name: ball, position_m: [" +
                  std::to_string(start_m) + ", 0, 0], parts: [{shape: sphere, radius_m: 0.02, mass_kg: 0.1}]}\n"),
        ball(world.find_object("ball")->base()) {
    ball.set_velocity_W({speed_mps, 0, 0}, sim::Vector3d::Zero());
  }
  sim::Body& ball;
};

Flight flight(double speed_mps, double step_s, double start_m, double time_s) {
  FlyingBall test(speed_mps, step_s, start_m);
  test.run_for(time_s);
  return {ended(test), test.ball.p_WB().x()};
}

std::vector<std::string> end_of_flight(double speed_mps, double step_s, double start_m = -0.5) {
  return flight(speed_mps, step_s, start_m, 0.04).warnings;
}

/// The rule of docs/reference/known_limits.md: v h < d/2 + r = 30 mm.
TEST(EndCheck, ABallPassesThroughAPlateOnlyWhereItIsWarnedOf) {
  constexpr double step_s = 0.01;
  // At -0.05 m it is not in the plate yet, after one step of 0.1 m not any more.
  EXPECT_GT(flight(10, step_s, -0.05, 0.1).end_m, 0.03);
  for (double start_m = -0.06; start_m < -0.031; start_m += 0.003)
    EXPECT_LT(flight(2.9, step_s, start_m, 0.1).end_m, 0) << start_m;
}

TEST(EndCheck, NamesABodyThatMovesFurtherThanItsSizeInAStep) {
  EXPECT_THAT(end_of_flight(10, 0.01),
              ElementsAre(HasSubstr("it moves 0.1 m in a step, further than its size of 0.04 m, and may pass through "
                                    "what is thin; use a 'step_s' below 0.004 (at 0.00 s)")));
  EXPECT_THAT(end_of_flight(10, 0.01).front(), HasSubstr("body 'ball"));
  EXPECT_THAT(end_of_flight(3.9, 0.01), IsEmpty());  // 39 mm
  EXPECT_THAT(end_of_flight(10, 0.003), IsEmpty());  // 30 mm
}

TEST(EndCheck, IsSilentAboutAFastBodyThatIsFarFromEverything) {
  EXPECT_THAT(end_of_flight(-10, 0.01, -1000), IsEmpty());
}

TEST(EndCheck, NamesItAgainAfterARewindToBefore) {
  FlyingBall test(10, 0.01, -0.5);
  const sim::Bytes start = test.world.state().snapshot();
  test.run_for(0.04);
  const std::vector<std::string> first = ended(test);
  ASSERT_EQ(first.size(), 1u);
  test.world.state().restore(start);
  EXPECT_THAT(ended(test), IsEmpty());
  test.run_for(0.04);
  EXPECT_EQ(ended(test), first);
}

/// The size counts along the motion: a rod of 1 m may go 10 cm endwise.
TEST(EndCheck, MeasuresABodyAlongItsMotion) {
  const auto warnings = [](const sim::Vector3d& v_W) {
    test::TestWorld test(
        "shoal: 1\nphysics: {step_s: 0.01, gravity_mps2: 0}\nobjects:\n  - {name: wall, fixed: true, position_m: [0, "
        "0, "
        "-0.2], parts: [{shape: box, size_m: [9, 9, 0.1]}]}\n  - {name: rod, parts: [{shape: box, size_m: [1, 0.02, "
        "0.02], mass_kg: 0.1}]}\n");
    test.world.find_object("rod")->base().set_velocity_W(v_W, sim::Vector3d::Zero());
    test.run_for(0.03);
    return ended(test).size();
  };
  EXPECT_EQ(warnings({10, 0, 0}), 0u);
  EXPECT_EQ(warnings({0, 10, 0}), 1u);
}

constexpr double unchanged = std::numeric_limits<double>::quiet_NaN();

/// The end of 1 s in which the autopilot of an AUV gets a command.
template <typename Message>
std::vector<std::string> end_of_command(const Message& command) {
  test::TestWorld test(
      "shoal: 1\nphysics: {step_s: 0.01}\nmedium: {water: {}}\nobjects: [{name: bottom, fixed: true, position_m: [0, "
      "0, "
      "-40], parts: [{shape: plane}]}]\nvehicles: [{name: v, file: remus100_survey.yaml, position_m: [0, 0, -10]}]\n");
  test.send("v.autopilot.cmd", command);
  test.run_for(1);
  return ended(test);
}

TEST(EndCheck, NamesACommandToAPlaceInTheAirOrBelowTheBottom) {
  EXPECT_THAT(
      end_of_command(shoal::helm_command_t{0, 1, unchanged, -15, unchanged}),
      ElementsAre("device 'v/autopilot': it was commanded to a position whose depth -15 m is in the air: depths "
                  "are positive downwards (at 0.00 s)"));
  EXPECT_THAT(end_of_command(shoal::helm_command_t{0, 1, unchanged, 15, unchanged}), IsEmpty());
  shoal::waypoints_command_t route{0, 1, {50}, {0}, {55}, 1.5, 0};
  EXPECT_THAT(end_of_command(route), ElementsAre(HasSubstr("depth 55 m is below the bottom, which is at 40 m there")));
  route.depth_m = {20};
  EXPECT_THAT(end_of_command(route), IsEmpty());
}

TEST(EndCheck, NamesACommandedRouteWithoutASpeed) {
  shoal::waypoints_command_t route{0, 1, {50}, {0}, {20}, unchanged, 0};
  EXPECT_THAT(end_of_command(route),
              ElementsAre("device 'v/autopilot': it was commanded to follow a route, and had no speed (at 0.00 s)"));
}

}  // namespace
