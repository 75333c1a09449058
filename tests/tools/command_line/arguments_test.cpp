// SPDX-License-Identifier: BSD-3-Clause
#include "tools/command_line/arguments.hpp"

#include <gtest/gtest.h>

#include "tools/command_line/checks.hpp"
#include "tools/command_line/help.hpp"

namespace {

using namespace command_line;
using Words = std::vector<std::string>;

/// A program with the kinds of options and commands that there are.
struct App {
  CLI::App app{"A program.", "prog"};
  double number = 0;
  std::string place, file, out, title = "none";
  std::vector<std::string> sets;
  bool quiet = false, plots = true;

  App() {
    app.require_subcommand(1);
    CLI::App* run = app.add_subcommand("run", "Run it");
    run->add_option("WORLD", place, "world file");
    run->add_option("--duration", number, "how long")->type_name("S")->check(number_from(-10, 1e9));
    run->add_option("--record", file, "log")->type_name("FILE");
    run->add_option("--title", title, "of the run")->type_name("TITLE");
    run->add_option("--set", sets, "a value")->type_size(1)->allow_extra_args(false);
    run->add_flag("--quiet", quiet, "no words");
    run->add_flag_callback(
        "--no-plots", [this] { plots = false; }, "no images");
    CLI::App* log = app.add_subcommand("log", "Look into it");
    log->require_subcommand(1);
    log->add_subcommand("info", "What it is")->add_option("LOG", place, "log")->required();
    log->add_subcommand("csv", "A table")->add_option("--out", out, "file")->required();
  }
};

std::string wrong(const Words& words) {
  App app;
  return read_arguments(app.app, words).wrong;
}

TEST(Arguments, NamesWhatIsUnknownAndWhatWasMeant) {
  EXPECT_EQ(wrong({"rum"}), "unknown command 'rum'; did you mean 'run'?");
  EXPECT_EQ(wrong({"zzzzzz"}), "unknown command 'zzzzzz'; known commands: run, log");
  EXPECT_EQ(wrong({"a.yaml"}), "unknown command 'a.yaml'; did you mean 'prog run a.yaml'?");
  EXPECT_EQ(wrong({"log", "inof"}), "unknown command 'inof'; did you mean 'info'?");
  EXPECT_EQ(wrong({"run", "--durration", "3"}), "unknown option '--durration'; did you mean '--duration'?");
  EXPECT_EQ(wrong({"run", "--durration=3"}), "unknown option '--durration'; did you mean '--duration'?");
  EXPECT_EQ(wrong({"run", "-duration", "3"}), "unknown option '-duration'; did you mean '--duration'?");
  EXPECT_EQ(wrong({"run", "--dur", "3"}), "unknown option '--dur'; did you mean '--duration'?");
  EXPECT_EQ(wrong({"run", "--frobnicate"}), "unknown option '--frobnicate'");
  EXPECT_EQ(wrong({"--quiet"}), "unknown option '--quiet'");
  EXPECT_EQ(wrong({"run", "a", "b"}), "unexpected argument 'b'; it follows WORLD");
  EXPECT_EQ(wrong({"log", "csv", "x"}), "unexpected argument 'x'; it takes options only");
}

TEST(Arguments, MustBeThereAndOnlyOnce) {
  EXPECT_EQ(wrong({}), "needs a command: run or log");
  EXPECT_EQ(wrong({"log"}), "needs a command: info or csv");
  EXPECT_EQ(wrong({"log", "info"}), "LOG is required");
  EXPECT_EQ(wrong({"log", "csv"}), "--out is required");
  EXPECT_EQ(wrong({"run", "--duration"}), "--duration needs a value: --duration S");
  EXPECT_EQ(wrong({"run", "--record", "--quiet"}), "--record needs a value: --record FILE; '--quiet' follows it");
  EXPECT_EQ(wrong({"run", "--duration", "1", "--duration=2"}), "--duration is given twice");
  EXPECT_EQ(wrong({"run", "--quiet=yes"}), "--quiet takes no value, got 'yes'");
  EXPECT_EQ(wrong({"run", ""}), "WORLD must not be empty");
  EXPECT_EQ(wrong({"run", "--record", ""}), "--record must not be empty");
  EXPECT_EQ(wrong({"run", "--quiet", "--quiet", "--set", "a=1", "--set", "b=2"}), "");
}

TEST(Arguments, StayOnOneLineAndCommandNoTerminal) {
  EXPECT_EQ(wrong({"ru\n\x1b[31m"}), "unknown command 'ru\\n\\x1b[31m'; known commands: run, log");
  EXPECT_EQ(wrong({"run", "--größe"}), "unknown option '--größe'");
  EXPECT_LT(wrong({std::string(1'000'000, 'x')}).size(), 200u);
}

TEST(Arguments, ReachTheOptionsAsTheyWereGiven) {
  const auto parsed = [](const Words& words, const auto& look) {
    App app;
    Arguments arguments = read_arguments(app.app, words);
    ASSERT_EQ(arguments.wrong, "");
    app.app.parse(std::move(arguments.for_cli11));
    look(app);
  };
  parsed({"run", "--duration", "-4.5", "w"}, [](const App& app) {
    EXPECT_EQ(app.number, -4.5);
    EXPECT_EQ(app.place, "w");
  });
  parsed({"run", "--set", "x=-1,2", "w", "--record", "-"}, [](const App& app) {
    EXPECT_EQ(app.sets, Words{"x=-1,2"});
    EXPECT_EQ(app.file, "-");
  });
  parsed({"run", "--title=", "w"}, [](const App& app) {
    EXPECT_EQ(app.title, "");
    EXPECT_EQ(app.place, "w");  // CLI11 alone would take it for the value of --title
  });
  parsed({"run", "--record=--odd", "--", "--quiet"}, [](const App& app) {
    EXPECT_EQ(app.file, "--odd");
    EXPECT_EQ(app.place, "--quiet");
    EXPECT_FALSE(app.quiet);
  });
  parsed({"run", "++"}, [](const App& app) { EXPECT_EQ(app.place, "++"); });
  parsed({"run", "run", "--no-plots"}, [](const App& app) {
    EXPECT_EQ(app.place, "run");
    EXPECT_FALSE(app.plots);
  });
}

TEST(Arguments, AskForHelpInEveryPlace) {
  for (const Words& words :
       {Words{"run", "--help"}, {"run", "--frob", "--help"}, {"run", "-h", "a", "b"}, {"help", "run"}}) {
    App app;
    const Arguments arguments = read_arguments(app.app, words);
    EXPECT_TRUE(arguments.help);
    EXPECT_EQ(command_path(*arguments.command), "prog run");
  }
}

TEST(Checks, SayRuleAndValue) {
  EXPECT_EQ(number_from(0, 1e9)("-1"), "must be from 0 to 1e9, got '-1'");
  for (const char* text : {"nan", "inf", "", "x", "1x", " 1"}) EXPECT_NE(number_from(0, 1e9)(text), "") << text;
  for (const char* text : {"0", "+1", "1e9", "1E3", ".5"}) EXPECT_EQ(number_from(0, 1e9)(text), "") << text;
  EXPECT_EQ(whole_from(1, 4)("2.5"), "must be a whole number from 1 to 4, got '2.5'");
  EXPECT_EQ(one_of({"lcm", "none"})("lmc"), "must be lcm or none, got 'lmc'; did you mean 'lcm'?");
  EXPECT_EQ(seed()("-1"), "must be a whole number from 0 to 9223372036854775807, got '-1'");
  EXPECT_EQ(setting()("=3"), "must be PATH=VALUE, such as run.seed=3, got '=3'");
}

TEST(Checks, PrintBoundsAsPeopleWriteThem) {
  EXPECT_EQ(bound_text(0), "0");
  EXPECT_EQ(bound_text(1e9), "1e9");
  EXPECT_EQ(bound_text(1e5), "100000");
  EXPECT_EQ(bound_text(1e12), "1e12");
  EXPECT_EQ(bound_text(1e-6), "1e-6");
  EXPECT_EQ(bound_text(-60), "-60");
}

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
