// SPDX-License-Identifier: BSD-3-Clause
#include <gmock/gmock.h>

#include <filesystem>
#include <fstream>

#include "tests/project_paths.hpp"
#include "tests/system/shoal_program.hpp"

namespace {

using namespace system_test;
using testing::ContainsRegex;
using testing::HasSubstr;

Ended acoustics(std::vector<std::string> arguments) {
  arguments.insert(arguments.begin(), "acoustics");
  return run_shoal(arguments);
}

TEST(AcousticsCommand, PrintsTheBudgetOfALink) {
  const Ended ended = acoustics({"--range", "1500", "--set", "acoustics.absorption.model=thorp", "--packet",
                                 "fsk:80:32", "--set", "medium.water.sound_speed_mps=1500"});
  ASSERT_EQ(ended.exit_code, 0) << ended.errors;
  // closed_forms.csv acoustic_link: 47.6 + 9.2 = 56.8 dB; 38.5 dB; 53.6 dB.
  EXPECT_THAT(ended.output, ContainsRegex("spreading +-47.6 dB"));
  EXPECT_THAT(ended.output, ContainsRegex("absorption +-9.2 dB"));
  EXPECT_THAT(ended.output, ContainsRegex("noise per hertz +38.5 dB"));
  EXPECT_THAT(ended.output, ContainsRegex("signal over noise +53.6 dB"));
  EXPECT_THAT(ended.output, ContainsRegex("travel time +1.0000 s"));
  EXPECT_THAT(ended.output, ContainsRegex("fsk +80 +32 +3.200 +70.6 +0 +1.0000 +1.0000"));
}

TEST(AcousticsCommand, TakesPlacesInAWorld) {
  const ScratchFolder folder;
  std::ofstream(folder.file("sea.yaml")) << "shoal: 1\nmedium: {water: {sound_speed_mps: 1480}}\n"
                                         << "acoustics: {spreading: {factor: 2}}\n";
  const Ended ended = acoustics({folder.file("sea.yaml"), "--from", "0,0,-10", "--to", "300,0,-410"});
  ASSERT_EQ(ended.exit_code, 0) << ended.errors;
  EXPECT_THAT(ended.output, HasSubstr("20 log10(500.0 m)"));
  EXPECT_THAT(ended.output, ContainsRegex("travel time +0.3378 s"));
}

TEST(AcousticsCommand, TakesNoVehicleForTheBottom) {
  const ScratchFolder folder;
  const auto budget = [&](const std::string& more, const char* water_depth_m = nullptr) {
    write_file(folder.file("sea.yaml"),
               "shoal: 1\nmedium: {water: {}}\nacoustics: {multipath: {max_bounces: 1, bottom: {loss_dB: 1}}}\n"
               "objects: [{name: bottom, fixed: true, position_m: [0, 0, -50], parts: [{shape: plane}]}]\n" +
                   more);
    std::vector<std::string> arguments{folder.file("sea.yaml"), "--from", "-100,0,-10", "--to", "100,0,-10"};
    if (water_depth_m != nullptr) arguments.insert(arguments.end(), {"--water-depth", water_depth_m});
    const Ended ended = acoustics(arguments);
    EXPECT_EQ(ended.exit_code, 0) << ended.errors;
    return ended.output;
  };
  const std::string above_the_bottom = budget("");
  EXPECT_EQ(
      budget("vehicles: [{name: auv, file: " + source("vehicles/remus100.yaml") + ", position_m: [0, 0, -20]}]\n"),
      above_the_bottom);
  EXPECT_EQ(budget("", "50"), above_the_bottom);
  EXPECT_NE(budget("", "20"), above_the_bottom);
}

TEST(AcousticsCommand, PrintsATableOverRange) {
  const Ended ended = acoustics({"--ranges", "500:2000:500", "--micromodem"});
  ASSERT_EQ(ended.exit_code, 0) << ended.errors;
  EXPECT_THAT(ended.output, testing::StartsWith("range_m,travel_time_s,level_dB,noise_dB,snr_dB,delivered_fsk_80_32"));
  for (const char* row : {"\n500,", "\n1000,", "\n1500,", "\n2000,"}) EXPECT_THAT(ended.output, HasSubstr(row));
}

TEST(AcousticsCommand, DrawsAnImage) {
  const ScratchFolder folder;
  const Ended ended = acoustics({"--ranges", "500:2000:500", "--image", folder.file("link.png")});
  ASSERT_EQ(ended.exit_code, 0) << ended.errors;
  EXPECT_GT(std::filesystem::file_size(folder.file("link.png")), 1000u);
}

TEST(AcousticsCommand, ShowsTheLinkThatItsPageShows) {
  const Ended ended = acoustics({source("worlds/coop_underwater.yaml"), "--from", "boat1/modem", "--to", "boat2/modem",
                                 "--packet", "psk:500:64"});
  EXPECT_EQ(ended.exit_code, 0) << ended.errors;
  EXPECT_THAT(ended.output, ContainsRegex("psk +500 +64"));
}

TEST(AcousticsCommand, DrawsRaysWhereSoundBends) {
  const ScratchFolder folder;
  const Ended ended = acoustics(
      {source("worlds/coop_underwater.yaml"), "--depth", "2", "--range", "800", "--rays", folder.file("rays.png")});
  ASSERT_EQ(ended.exit_code, 0) << ended.errors;
  EXPECT_GT(std::filesystem::file_size(folder.file("rays.png")), 10000u);
  const Ended straight = acoustics({"--rays", folder.file("none.png")});
  EXPECT_EQ(straight.exit_code, 2);
  EXPECT_THAT(straight.errors, HasSubstr("sound travels along straight lines in this world"));
}

TEST(AcousticsCommand, ChecksTheClosedForms) {
  const Ended ended =
      acoustics({"--closed-forms", test_support::source_path("tests/fidelity/reference/closed_forms.csv")});
  ASSERT_EQ(ended.exit_code, 0) << ended.errors;
  EXPECT_THAT(ended.output, HasSubstr("| ambient_noise_wenz_coates |"));
  const ScratchFolder folder;
  std::ofstream(folder.file("off.csv")) << "header\nabsorption_thorp,f_kHz=1,alpha,1,dB/km,0.001,rel,\n";
  EXPECT_EQ(acoustics({"--closed-forms", folder.file("off.csv")}).exit_code, 1);
}

TEST(AcousticsCommand, SaysWhatIsWrong) {
  const auto error_of = [](std::vector<std::string> arguments) {
    const Ended ended = acoustics(std::move(arguments));
    EXPECT_EQ(ended.exit_code, 2) << ended.errors;
    return ended.errors;
  };
  EXPECT_THAT(error_of({"--packet", "ask:80:32"}), HasSubstr("must be modulation:bit/s:bytes"));
  EXPECT_THAT(error_of({"--ranges", "5000:100:10"}), HasSubstr("must be from:to:step"));
  EXPECT_THAT(error_of({"--ranges", "1:1e7:0.001"}), HasSubstr("10000 steps at most"));
  EXPECT_THAT(error_of({"--from", "auv1/modem", "--to", "0,0,-5"}), HasSubstr("'auv1/modem'"));
  EXPECT_THAT(error_of({"--from", "0,0,-5"}), HasSubstr("needs --to"));
  EXPECT_THAT(error_of({"--level", "nan"}), HasSubstr("must be from -100 to 300"));
  EXPECT_THAT(error_of({"--set", "acoustics.spreading.factor=9"}), HasSubstr("'factor' must be >= 0 and <= 4, got 9"));
  EXPECT_THAT(error_of({test_support::source_path("worlds/minimal.yaml")}), HasSubstr("no water"));
  EXPECT_THAT(error_of({"--bandwidth", "60000"}),
              HasSubstr("must be less than twice the frequency of 25000 Hz, got 60000"));
}

TEST(AcousticsCommand, NeedsWaterAtBothEnds) {
  const ScratchFolder folder;
  std::ofstream(folder.file("sea.yaml"))
      << "shoal: 1\nmedium: {water: {}}\nobjects:\n"
         "  - {name: bottom, fixed: true, position_m: [0, 0, -30], parts: [{shape: "
         "plane}]}\n"
         "  - {name: rock, fixed: true, position_m: [50, 0, -20], parts: [{shape: box, "
         "size_m: [10, 10, 10]}]}\n"
         "  - {name: jetty, fixed: true, position_m: [90, 0, 0], parts: [{shape: box, "
         "size_m: [10, 10, 2]}]}\n";
  const auto to = [&](const std::string& place) {
    return acoustics({folder.file("sea.yaml"), "--from", "0,0,-5", "--to", place});
  };
  for (const auto& [place, error] :
       {std::pair{"100,0,-40", "--to: is in the ground at 100,0,-40"},
        {"50,0,-20", "--to: is in the ground at 50,0,-20"},
        {"100,0,1", "--to: is in the air at 100,0,1: the surface is at z = 0.00 m there"}}) {
    EXPECT_EQ(to(place).exit_code, 2) << place;
    EXPECT_THAT(to(place).errors, HasSubstr(error));
  }
  EXPECT_EQ(to("90,0,-5").exit_code, 0) << "below the jetty";
}

}  // namespace
