// SPDX-License-Identifier: BSD-3-Clause
#include "tools/command_line/help.hpp"

#include <gtest/gtest.h>

#include "tests/tools/command_line/arguments_fixture.hpp"
#include "tools/command_line/checks.hpp"
#include "tools/command_line/parse.hpp"

namespace {

using namespace arguments_fixture;
using namespace command_line;

TEST(Help, ListsCommandsByTheirGroups) {
  CLI::App app{"A program.", "prog"};
  for (const auto& [name, group] : {std::pair{"run", "run"}, {"check", "run"}, {"film", "look"}})
    app.add_subcommand(name, "Do it")->group(group);
  const std::string text = help_text(app, 80);
  const std::string groups = "\nCommands to run:\n  run    Do it\n  check  Do it\n\nCommands to look:\n  film  Do it\n";
  EXPECT_NE(text.find(groups), std::string::npos) << text;
  EXPECT_NE(help_text(App().app, 80).find("\nCommands:\n  run  Run it\n  log  Look into it\n"), std::string::npos);
}

TEST(Help, HasNothingOfTheLibraryInside) {
  App app;
  set_help_end(
      *app.app.get_subcommand("run"),
      {{"prog run a.yaml --duration 10 --record some_file.lcm --quiet"}, {{0, "good"}, {129, "bad"}}, {"A note."}});
  EXPECT_EQ(help_text(*app.app.get_subcommand("run"), 50),
            "Usage: prog run [OPTIONS] [WORLD]\n"
            "\n"
            "Run it\n"
            "\n"
            "Arguments:\n"
            "  WORLD  world file\n"
            "\n"
            "Options:\n"
            "  -h, --help     Print this help message and exit\n"
            "  --duration S   how long (from -10 to 1e9)\n"
            "  --record FILE  log\n"
            "  --title TITLE  of the run\n"
            "  --set TEXT     a value (repeatable)\n"
            "  --quiet        no words\n"
            "  --no-plots     no images\n"
            "\n"
            "Example:\n"
            "  prog run a.yaml --duration 10 \\\n"
            "      --record some_file.lcm --quiet\n"
            "\n"
            "Exit codes:\n"
            "  0    good\n"
            "  129  bad\n"
            "\n"
            "A note.\n");
}

}  // namespace
