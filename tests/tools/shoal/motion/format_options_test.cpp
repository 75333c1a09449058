// SPDX-License-Identifier: BSD-3-Clause
#include "tools/shoal/motion/format_options.hpp"

#include <gmock/gmock.h>

#include <filesystem>

#include "sim/config/diagnostics.hpp"
#include "tests/tools/shoal/motion/leg_files.hpp"

namespace {

using testing::HasSubstr;
using testing::Not;

TEST(FormatOptions, TheFormatsOfAnImportAreThoseThatCanBeRead) {
  const std::string read = tools::formats_text(true), written = tools::formats_text(false);
  for (const motion::MotionFormat& format : motion::motion_formats()) {
    const std::string entry = std::string(format.name) + ", " + format.meaning;
    const bool is_written = format.write != nullptr || format.write_folder != nullptr;
    EXPECT_EQ(read.find(entry) != std::string::npos, format.read != nullptr) << format.name;
    EXPECT_EQ(written.find(entry) != std::string::npos, is_written) << format.name;
  }
}

TEST(FormatOptions, ALossEndsAStrictConversionOnly) {
  tools::FormatArguments arguments;
  arguments.input = "wave.yaml";
  testing::internal::CaptureStderr();
  EXPECT_TRUE(tools::may_lose(arguments, {"notes are not kept"}));
  EXPECT_EQ(testing::internal::GetCapturedStderr(), "wave.yaml: notes are not kept\n");
  arguments.strict = true;
  testing::internal::CaptureStderr();
  EXPECT_TRUE(tools::may_lose(arguments, {}));
  EXPECT_FALSE(tools::may_lose(arguments, {"notes are not kept"}));
  EXPECT_THAT(testing::internal::GetCapturedStderr(), HasSubstr("nothing is written, because of --strict"));
}

TEST(FormatOptions, TheOutputIsNeitherTheInputNorAFileThatExists) {
  const test::LegFiles files;
  tools::FormatArguments arguments;
  arguments.input = files.motion("wave", test::bend);
  const auto refusal = [&](const std::string& path) {
    try {
      tools::check_output(arguments, path);
    } catch (const CLI::ValidationError& error) {
      return std::string(error.what());
    }
    return std::string("none");
  };
  EXPECT_EQ(refusal(files.path("new.csv")), "none");
  EXPECT_THAT(refusal(files.path("leg.yaml")), HasSubstr("exists; --overwrite replaces it"));
  arguments.overwrite = true;
  EXPECT_EQ(refusal(files.path("leg.yaml")), "none");
  EXPECT_THAT(refusal(files.path("./wave.yaml")), HasSubstr("must not be the file that is read"));
}

TEST(FormatOptions, NamesOfJointsAreThoseOfTheVehicleThatTheMotionNames) {
  const test::LegFiles files;
  tools::FormatArguments arguments;
  arguments.input = files.path("wave.yaml");
  EXPECT_EQ(tools::names_for(arguments, "leg").vehicle(), "leg");
  arguments.keep_names = true;
  EXPECT_TRUE(tools::names_for(arguments, "leg").empty());
  arguments.keep_names = false;
  testing::internal::CaptureStderr();
  EXPECT_TRUE(tools::names_for(arguments, "no_such_robot").empty());
  EXPECT_THAT(testing::internal::GetCapturedStderr(), HasSubstr("no file of vehicle 'no_such_robot'"));
}

TEST(VehicleJoints, AJointThatAMotionLeavesOutRestsWhereItParksWithinItsRange) {
  const test::LegFiles files;
  const motion::JointNames names = tools::joint_names_of(files.path("leg.yaml"), "");
  ASSERT_EQ(names.joints().size(), 3u);
  EXPECT_EQ(names.find("maker/knee"), names.find("knee"));
  EXPECT_EQ(names.find("knee")->rest, 0);
  EXPECT_FALSE(names.find("knee")->is_slider);
  EXPECT_EQ(names.find("rod")->rest, 0.1) << "its stop, not the 0.3 m at which it would park";
  EXPECT_TRUE(names.find("rod")->is_slider);
  EXPECT_TRUE(names.find("lamp")->is_light);
}

TEST(VehicleJoints, TheirNamesElsewhereAreInAFileBesideTheVehicle) {
  const test::LegFiles files;
  const std::string lists = "shoal: 1\njoint_names: leg\nlists: [{list: tekkotsu, joints: {knee: ";
  std::filesystem::create_directory(files.path("joint_names"));
  files.write("joint_names/leg.yaml", lists + "KNEE}}]\n");
  const std::string other = files.write("other.yaml", lists + "KNIE}}]\n");
  const auto name = [&](const std::string& names_file) {
    return tools::joint_names_of(files.path("leg.yaml"), names_file).foreign_name("tekkotsu", false, "knee");
  };
  EXPECT_EQ(name(""), "KNEE");
  EXPECT_EQ(name(other), "KNIE");
}

TEST(VehicleJoints, AVehicleWithoutAServoHasNoMotion) {
  const test::LegFiles files;
  const std::string crate = files.write(
      "crate.yaml",
      "shoal: 1\nvehicle: crate\nbodies: [{name: box, parts: [{shape: box, size_m: [1, 1, 1], mass_kg: 1}]}]\n");
  EXPECT_THAT([&] { tools::joint_names_of(crate, ""); },
              testing::ThrowsMessage<sim::ConfigError>(testing::HasSubstr("the vehicle has no joint_servo")));
}

TEST(VehicleJoints, TheVehicleOfAMotionIsBesideItElseAShippedOne) {
  const test::LegFiles files;
  EXPECT_EQ(tools::vehicle_file_of("leg", files.path("bend.yaml")), files.path("leg.yaml"));
  EXPECT_EQ(tools::vehicle_file_of("leg", files.path("leg.yaml")), "") << "a motion is not its own vehicle";
  EXPECT_EQ(std::filesystem::path(tools::vehicle_file_of("ers7", files.path("bend.yaml"))).filename(), "ers7.yaml");
  EXPECT_EQ(tools::vehicle_file_of("no_such_robot", files.path("bend.yaml")), "");
  EXPECT_EQ(tools::vehicle_file_of("", files.path("bend.yaml")), "");
}

}  // namespace
