// SPDX-License-Identifier: BSD-3-Clause
#include "tools/shoal/commands/commands.hpp"

#include <gtest/gtest.h>

#include <CLI/CLI.hpp>
#include <cstdlib>

#include "tests/tools/command_line/every_command.hpp"
#include "tests/tools/shoal/called_command.hpp"

namespace {

every_command::Tried tried(const std::string& /*shoal*/, const every_command::Words& arguments) {
  setenv("COLUMNS", "80", 1);
  const test::Called called = test::call_shoal(arguments);
  unsetenv("COLUMNS");
  return {called.exit_code, called.out, called.err};
}

TEST(Commands, AreAllNamedWithADescription) {
  CLI::App app;
  tools::list_commands(app);
  EXPECT_GT(app.get_subcommands({}).size(), 20u);
  for (const CLI::App* command : app.get_subcommands({})) {
    EXPECT_FALSE(command->get_description().empty()) << command->get_name();
    EXPECT_FALSE(command->get_group().empty()) << command->get_name();
  }
  EXPECT_NE(app.get_subcommand("run"), nullptr);
}

TEST(Commands, OfOtherProgramsLeadToThoseOfShoal) {
  EXPECT_EQ(tools::meant_call("topic"), "`shoal spy`");
  EXPECT_EQ(tools::meant_call("run"), "");
  EXPECT_EQ(tools::meant_call(""), "");
}

TEST(Commands, WhatIsMeantIsACommand) {
  CLI::App app;
  tools::list_commands(app);
  for (const char* name : {"play", "plot", "record", "bag", "start", "launch", "sim", "echo", "msg", "validate", "lint",
                           "init", "create", "convert", "video", "screenshot", "benchmark"}) {
    const std::string call = tools::meant_call(name);
    const std::string command = call.substr(7, call.find_first_of(" `", 7) - 7);  // after "`shoal "
    EXPECT_NO_THROW(app.get_subcommand(command)) << call;
  }
}

TEST(Commands, SayOfEachOptionWhatIsWrongWithIt) {
  EXPECT_GT(every_command::expect_that_options_say_what_is_wrong(tried, every_command::all_commands(tried, {"shoal"})),
            150);
}

TEST(Commands, RefuseNumbersOutOfTheRangeOfEachOption) {
  EXPECT_GT(every_command::expect_that_ranges_are_kept(tried, every_command::all_commands(tried, {"shoal"})), 60);
}

}  // namespace
