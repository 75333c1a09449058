// SPDX-License-Identifier: BSD-3-Clause
#include "tools/shoal/motion/format_options.hpp"

#include <gmock/gmock.h>

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

}  // namespace
