// SPDX-License-Identifier: BSD-3-Clause
#include "tools/shoal/motion/motion_output.hpp"

#include <gmock/gmock.h>

#include "sim/motion/motion.hpp"
#include "tests/tools/shoal/motion/leg_files.hpp"
#include "tools/command_line/checks.hpp"

namespace {

using command_line::UsageError;
using testing::HasSubstr;

TEST(MotionOutput, SaysWhatAMotionHas) {
  const test::LegFiles files;
  EXPECT_EQ(tools::content_text(sim::load_motion(files.motion("bend", test::bend))), "1.000 s, 1 joint, 2 keys");
  const std::string lit =
      files.write("lit.yaml",
                  "shoal: 1\nmotion: lit\nlights: [lamp]\nkeys: [{at_s: 0.25, joints: {knee: 0, rod: 0, lamp: 1}}]\n"
                  "sounds: [{at_s: 0.1, sound: bark}, {at_s: 0.2, sound: bark}]\n");
  EXPECT_EQ(tools::content_text(sim::load_motion(lit)), "0.250 s, 2 joints, 1 light, 1 key, 2 sounds");
}

TEST(MotionOutput, AnOperationIsTheCommandWithoutItsFiles) {
  CLI::App command("", "retime");
  std::string file, output;
  double at_s = 0;
  bool overwrite = false, is_loud = false;
  std::vector<std::string> joints;
  command.add_option("FILE", file);
  command.add_option("--output", output);
  command.add_option("--at", at_s);
  command.add_option("--joints", joints)->delimiter(',');
  command.add_flag("--loud", is_loud);
  tools::add_overwrite_option(command, overwrite);
  command.parse("wave.yaml --output b.yaml --at 0.5 --joints hip,knee --loud --overwrite");
  EXPECT_EQ(tools::operation_of(command), "retime --at 0.5 --joints hip,knee --loud");
}

TEST(MotionOutput, AnExistingFileIsReplacedOnlyWhenThatWasAskedFor) {
  const test::LegFiles files;
  EXPECT_NO_THROW(tools::check_new_file(files.path("new.yaml"), false));
  EXPECT_THAT([&] { tools::check_new_file(files.path("leg.yaml"), false); },
              testing::ThrowsMessage<UsageError>(HasSubstr("leg.yaml' exists; --overwrite replaces it")));
  EXPECT_NO_THROW(tools::check_new_file(files.path("leg.yaml"), true));
  EXPECT_THAT([&] { tools::check_new_file(files.path("new.csv"), false); },
              testing::ThrowsMessage<UsageError>(HasSubstr("must not end in .csv")));
  EXPECT_THROW(tools::check_new_file(files.path("no/such/folder.yaml"), true), std::runtime_error);
}

TEST(MotionOutput, ATableThatIsNotOfTheMotionIsNotReplacedUnasked) {
  const test::LegFiles files;
  const std::string path = files.motion("bend", test::bend);
  EXPECT_NO_THROW(tools::check_frames(path, false));
  files.write("bend.csv", "measured\n");
  EXPECT_THAT([&] { tools::check_frames(path, false); },
              testing::ThrowsMessage<UsageError>(HasSubstr("bend.csv' exists and does not belong to '")));
  EXPECT_NO_THROW(tools::check_frames(path, true));
}

}  // namespace
