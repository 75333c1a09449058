// SPDX-License-Identifier: BSD-3-Clause
#include <gmock/gmock.h>

#include <cmath>
#include <cstdlib>
#include <string>

#include "tests/system/shoal_program.hpp"

// The rules of the shipped worlds hold as the worlds are, and fail when a partner or a sensor is dead.

namespace {

using namespace system_test;
using testing::HasSubstr;

/// The whole run with its programs.  Exit code 0: passed; 1: a rule failed.
Ended whole_run(const std::string& world, const std::vector<std::string>& sets) {
  std::vector<std::string> arguments{
      "run", source("worlds/" + world + ".yaml"), "--launch", "--lcm-url", own_url(), "--speed", "max"};
  for (const std::string& set : sets) arguments.insert(arguments.end(), {"--set", set});
  return run_shoal(arguments, 5 * timeout);
}

std::string silent(const std::string& device) {
  return "events=[{name: broken, at: 1, do: [{fault: {device: " + device + ", kind: silent}}]}]";
}

/// As it is where `boat` is empty.
Ended sea_with_mute(const std::string& boat) {
  std::vector<std::string> sets{"run.seed=1001"};
  if (!boat.empty()) sets.push_back("vehicles." + boat + ".devices.modem.source_level_dB=0");
  return whole_run("coop_underwater", sets);
}

/// Value of a figure in the end summary.
double figure_in(const std::string& output, const std::string& name) {
  const std::size_t at = output.find("  " + name + " ");
  return at == std::string::npos ? std::nan("") : std::strtod(output.c_str() + at + name.size() + 2, nullptr);
}

TEST(ShippedRules, OfCoopUnderwaterHold) {
  const Ended ended = sea_with_mute("");
  EXPECT_EQ(ended.exit_code, 0) << ended.output;
  // A packet each 8 s whose fix has 0.3 m, with drifting clock and heading: docs/guides/cooperative_accuracy.md.
  EXPECT_NEAR(figure_in(ended.output, "bound.rms_m"), 0.9, 0.2);
  EXPECT_EQ(figure_in(ended.output, "bound.ranges"), figure_in(ended.output, "link.received"));
}

/// The estimate stays good enough without the boat that no one receives.
TEST(ShippedRules, OfCoopUnderwaterFailWithOneMuteBoat) {
  const Ended ended = sea_with_mute("boat1");
  EXPECT_EQ(ended.exit_code, 1) << ended.errors;
  EXPECT_THAT(ended.output, HasSubstr("FAILED: link.received"));
  EXPECT_THAT(ended.output, HasSubstr("passed: cooperative.rms_m"));
}

TEST(ShippedRules, OfCoopLandFailWithOneMuteRoverOrWithoutEstimates) {
  const std::string minute = "run.duration_s=60";  // they hold for a part of the run, too
  EXPECT_EQ(whole_run("coop_land", {minute}).exit_code, 0);
  const Ended unheard = whole_run("coop_land", {minute, "vehicles.rover2.devices.modem.loss_probability=1"});
  EXPECT_EQ(unheard.exit_code, 1) << unheard.errors;
  EXPECT_THAT(unheard.output, HasSubstr("FAILED: rover3_link.received"));
  const Ended mute = whole_run("coop_land", {minute, silent("rover1/modem")});
  EXPECT_THAT(mute.output, HasSubstr("FAILED: rover3_link.received")) << mute.errors;
  const Ended blind = whole_run("coop_land", {minute, silent("rover3/odometry")});
  EXPECT_THAT(blind.output, HasSubstr("FAILED: cooperative.max_gap_s")) << blind.errors;
}

TEST(ShippedRules, OfCoopLandFailWithAHelperWithoutGps) {
  const Ended lost = whole_run("coop_land", {silent("rover2/gps")});
  EXPECT_EQ(lost.exit_code, 1) << lost.errors;
  EXPECT_THAT(lost.output, HasSubstr("FAILED: helper2.rms_m"));
}

TEST(ShippedRules, OfTheRangerHoldAndFailWithoutEachOfItsSensors) {
  const Ended whole = whole_run("ranger_dock", {});
  EXPECT_EQ(whole.exit_code, 0) << whole.output << whole.errors;
  for (const char* sensor : {"gps", "forward_sonar", "imu"}) {
    const Ended ended = whole_run("ranger_dock", {std::string("vehicles.ranger.devices.") + sensor + ".dropout=1"});
    EXPECT_EQ(ended.exit_code, 1) << sensor << ended.errors;
    EXPECT_THAT(ended.output, HasSubstr("FAILED: berth.time_s")) << sensor;
  }
}

TEST(ShippedRules, OfTheRoversThatAvoidHold) {
  const Ended whole = whole_run("avoid_rovers", {});
  EXPECT_EQ(whole.exit_code, 0) << whole.output << whole.errors;
}

TEST(ShippedRules, OfTheFormationFailWithAMuteLeader) {
  EXPECT_EQ(whole_run("formation", {}).exit_code, 0);
  const Ended mute = whole_run("formation", {"vehicles.leader.devices.modem.source_level_dB=0"});
  EXPECT_EQ(mute.exit_code, 1) << mute.errors;
  EXPECT_THAT(mute.output, HasSubstr("FAILED: place1.rms_m"));
}

}  // namespace
