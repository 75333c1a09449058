#include <gmock/gmock.h>

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
  return run_shoal(arguments, 5 * patience);
}

std::string silent(const std::string& device) {
  return "events=[{name: broken, at: 1, do: [{fault: " + device + ", kind: silent}]}]";
}

TEST(ShippedRules, OfCoopUnderwaterFailWithOneMuteBoat) {
  EXPECT_EQ(whole_run("coop_underwater", {"run.seed=1001"}).exit_code, 0);
  // With these seeds the estimate stays good enough without the boat that nobody hears.
  const std::pair<const char*, const char*> mute[] = {{"boat1", "1001"}, {"boat2", "1001"}};
  for (const auto& [boat, seed] : mute) {
    const Ended ended = whole_run(
        "coop_underwater",
        {"run.seed=" + std::string(seed), "vehicles." + std::string(boat) + ".devices.modem.source_level_dB=0"});
    EXPECT_EQ(ended.exit_code, 1) << boat << ended.errors;
    EXPECT_THAT(ended.output, HasSubstr("FAILED: link.received")) << boat;
  }
}

TEST(ShippedRules, OfCoopLandFailWithOneMuteRoverOrWithoutEstimates) {
  EXPECT_EQ(whole_run("coop_land", {}).exit_code, 0);
  for (const char* rover : {"rover1", "rover2"}) {
    const Ended unheard =
        whole_run("coop_land", {"vehicles." + std::string(rover) + ".devices.modem.loss_probability=1"});
    EXPECT_EQ(unheard.exit_code, 1) << rover << unheard.errors;
    EXPECT_THAT(unheard.output, HasSubstr("FAILED: link.received")) << rover;
    EXPECT_EQ(whole_run("coop_land", {silent(std::string(rover) + "/modem")}).exit_code, 1) << rover;
  }
  const Ended lost = whole_run("coop_land", {silent("rover2/gps")});
  EXPECT_EQ(lost.exit_code, 1) << lost.errors;
  EXPECT_THAT(lost.output, HasSubstr("FAILED: helper2.rms_m"));
  const Ended blind = whole_run("coop_land", {silent("rover3/odometry")});
  EXPECT_EQ(blind.exit_code, 1) << blind.errors;
  EXPECT_THAT(blind.output, HasSubstr("FAILED: cooperative.longest_gap_s"));
}

}  // namespace
