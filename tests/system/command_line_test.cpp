// SPDX-License-Identifier: BSD-3-Clause
#include <gmock/gmock.h>

#include <algorithm>
#include <filesystem>
#include <functional>
#include <regex>
#include <sstream>

#include "tests/system/on_terminal.hpp"
#include "tests/system/shoal_program.hpp"
#include "tests/tools/command_line/every_command.hpp"

// What every command of every program owes its users: help, errors, widths, pipes.

namespace {

using namespace system_test;
using namespace every_command;
using testing::HasSubstr;
using testing::Not;

const Words programs = {"shoal-coop-rover", "shoal-coop-auv", "shoal-coop-craft", "shoal-coop-station", "shoal-balance",
                        "shoal-ball-chase", "shoal-ball-dog", "shoal-mapper",     "shoal-patrol",       "shoal-ranger",
                        "shoal-nav",        "shoal-nmea",     "shoal-moos",       "shoal-frontseat"};

Ended run_program(const std::string& program, Words arguments, const Words& environment = {}) {
  arguments.insert(arguments.begin(), built(program));
  arguments.insert(arguments.begin(), environment.begin(), environment.end());
  arguments.insert(arguments.begin(), "env");
  Program started(std::move(arguments));
  const int exit_code = started.wait();
  return {exit_code, started.output(), started.errors()};
}

/// By a shell that says of a pipe that its first failure counts.
Ended run_shell(const std::string& line) {
  Program program(
      {"bash", "-c",
       "set -o pipefail; PATH=" + std::filesystem::path(built("shoal")).parent_path().string() + ":$PATH; " + line});
  const int exit_code = program.wait();
  return {exit_code, program.output(), program.errors()};
}

std::size_t max_line(const std::string& text) {
  std::size_t longest = 0;
  for (const std::string& line : lines_of(text)) longest = std::max(longest, line.size());
  return longest;
}

Tried tried(const std::string& program, const Words& arguments) {
  const Ended ended = run_program(program, arguments, {"COLUMNS=80"});
  return {ended.exit_code, ended.output, ended.errors};
}

std::vector<Command> commands_of_all_programs() {
  Words all = programs;
  all.insert(all.begin(), "shoal");
  return all_commands(tried, all);
}

TEST(CommandLine, HelpOfEveryCommandIsInOurWords) {
  const std::vector<Command> commands = commands_of_all_programs();
  EXPECT_GT(commands.size(), 25u);
  static const std::regex inside(
      "FLOAT|\\bU?INT\\b|REQUIRED|TEXT \\.\\.\\.|\\{(true|false)\\}|SUBCOMMAND|Positionals|Needs:|Excludes:|Env:|"
      "[\\w:]+ in \\[|\\[\\d+ - \\d|--help-all|e\\+\\d|=NUMBER|\\(\\)|;;");
  for (const Command& command : commands) {
    std::smatch found;
    EXPECT_FALSE(std::regex_search(command.help, found, inside)) << command.path() << ": '" << found[0] << "'";
    const std::string usage = "Usage: " + command.path() + " ";
    EXPECT_THAT(command.help, testing::StartsWith(usage));
    EXPECT_THAT(command.help, HasSubstr("\nExample")) << command.path();
    EXPECT_THAT(command.help, HasSubstr("\nExit codes:\n  0 ")) << command.path();
    EXPECT_THAT(command.help, HasSubstr("print this help")) << command.path();
    EXPECT_LE(max_line(command.help), 80u) << command.path();
    for (const std::string& option : names_in(command.help, "Options"))
      EXPECT_FALSE(option.ends_with(" TEXT") || option.find(" TEXT  ") != std::string::npos)
          << command.path() << option;
  }
}

TEST(CommandLine, HelpFitsTheWidthThatIsAskedFor) {
  for (const auto& [columns, min] : {std::pair<std::size_t, std::size_t>{50, 40}, {120, 90}}) {
    const Ended ended = run_program("shoal", {"run", "--help"}, {"COLUMNS=" + std::to_string(columns)});
    EXPECT_GT(max_line(ended.output), min);
    for (const std::string& line : lines_of(ended.output))
      EXPECT_TRUE(line.size() <= columns || line.find(' ', line.find_first_not_of(' ')) >= line.size() - 2) << line;
  }
  OnTerminal narrow({"env", "-u", "COLUMNS", built("shoal"), "check", "--help"}, 60, 24);
  EXPECT_EQ(narrow.wait(), 0);
  EXPECT_LE(max_line(narrow.shown()), 61u);  // with the carriage return
  EXPECT_GT(max_line(narrow.shown()), 45u);
}

TEST(CommandLine, EveryExampleOfAHelpIsOneThatTheCommandTakes) {
  for (const Command& command : commands_of_all_programs()) {
    const auto at = command.help.find("\nExample");
    ASSERT_NE(at, std::string::npos);
    std::string text = command.help.substr(at, command.help.find("\nExit codes:") - at);
    text = std::regex_replace(text, std::regex(" \\\\\n +"), " ");
    for (const std::string& example :
         names_in(text, text.find("Examples:") != std::string::npos ? "Examples" : "Example")) {
      // With an option that does not exist the command says so before it does anything: what else it says is wrong with
      // the example.
      const std::string line = example.substr(0, example.find("  #"));
      const std::string cut = line.substr(0, line.find(" > "));
      const Ended ended = run_shell(cut + " --no-such-option");
      EXPECT_EQ(ended.exit_code, 2) << line;
      EXPECT_THAT(ended.errors, HasSubstr("unknown option '--no-such-option'")) << line;
    }
  }
}

TEST(CommandLine, AProgramInThePathIsACommand) {
  const ScratchFolder folder;
  for (const char* name : {"greet", "list"}) {
    const std::string path = folder.file(std::string("shoal-") + name);
    write_file(path, "#!/bin/sh\necho \"of the path:\" \"$@\"\nexit 3\n");
    std::filesystem::permissions(path, std::filesystem::perms::owner_all);
  }
  const std::string here = "PATH=" + folder.file("") + ":$PATH; shoal ";
  const Ended greeted = run_shell(here + "greet --loud Ada");
  EXPECT_EQ(greeted.exit_code, 3);
  EXPECT_EQ(greeted.output, "of the path: --loud Ada\n");
  EXPECT_EQ(run_shell(here + "help greet").output, "of the path: --help\n");
  EXPECT_EQ(run_shell("shoal greet").exit_code, 2);
  // A command of Shoal comes first.
  EXPECT_THAT(run_shell(here + "list worlds").output, Not(HasSubstr("of the path")));
  // The programs beside shoal are commands, too.
  EXPECT_EQ(run_shell("shoal nav --list").output, run_shell("shoal-nav --list").output);
}

TEST(CommandLine, UnknownWordsAreNamedWithWhatWasMeantAndTheRightHelp) {
  const std::string world = source("worlds/minimal.yaml");
  const std::vector<std::pair<Words, std::string>> cases = {
      {{"rum"}, "shoal: unknown command 'rum'; did you mean 'run'?\nSee `shoal --help`.\n"},
      {{"version"}, "shoal: unknown command 'version'; use `shoal --version`\n"},
      {{"play", "a.lcm"},
       "shoal: unknown command 'play'; use `shoal view LOG`, or `shoal replay --play LOG` for programs on a bus\n"},
      {{}, "shoal: needs a command: "},
      {{"log", "inof"}, "shoal log: unknown command 'inof'; did you mean 'info'?\nSee `shoal log --help`.\n"},
      {{"run", world, "--durration", "3"},
       "shoal run: unknown option '--durration'; did you mean '--duration'?\nSee `shoal run --help`.\n"},
      {{"log", "csv", "a.lcm", "b", "c"},
       "shoal log csv: unexpected argument 'c'; it follows CHANNEL\nSee `shoal log csv --help`.\n"},
      {{"run"}, "shoal run: needs either a WORLD or --from FILE\nSee `shoal run --help`.\n"},
      {{"run", world, "--bus", "can"}, "shoal run: --bus: must be lcm or none, got 'can'\nSee `shoal run --help`.\n"},
      {{"run", world, "--duration", "abc"},
       "shoal run: --duration: must be from 1e-6 to 1e9, or forever, got 'abc'\nSee `shoal run --help`.\n"},
      {{"run", world, "--duration", "0"},
       "shoal run: --duration: must be from 1e-6 to 1e9, or forever, got '0'\nSee `shoal run --help`.\n"},
      {{"run", world, "--speed", "0"},
       "shoal run: --speed: must be from 0.001 to 1e6, or max, got '0'\nSee `shoal run --help`.\n"},
      {{"run", world, "--set", "nonsense"},
       "shoal run: --set: must be PATH=VALUE, such as run.seed=3, got 'nonsense'\n"},
      {{"describe"}, "shoal describe: needs a NAME"},
      {{"describe", "lider"}, "shoal describe: unknown name 'lider'; did you mean 'lidar'?\n"},
      {{"describe", "lidar", "--page", "devices"}, "shoal describe: "},
      {{"snap", world, "--out", "a.png", "--eye", "1,2,3"}, "shoal snap: --eye needs --look\n"},
      {{"control", "paus"}, "shoal control: unknown request 'paus'; did you mean 'pause'?\n"},
  };
  for (const auto& [arguments, error] : cases) {
    const Ended ended = run_shoal(arguments);
    EXPECT_EQ(ended.exit_code, 2) << error;
    EXPECT_THAT(ended.errors, testing::StartsWith(error));
    EXPECT_EQ(lines_of(ended.errors).size(), 2u) << ended.errors;
    EXPECT_EQ(ended.output, "");
  }
}

TEST(CommandLine, AWorldThatIsGivenForALogIsAnErrorWithTheRightCommand) {
  const Ended ended = run_shoal({"view", "minimal"});
  EXPECT_EQ(ended.exit_code, 2);
  EXPECT_EQ(ended.errors,
            "'minimal': is a world, but this command shows logs; `shoal run minimal --view` shows its run\n");
}

// Those of each command of shoal are tried in tests/tools/shoal/commands, without a process for each.
TEST(CommandLine, EveryOptionOfTheOtherProgramsSaysWhatIsWrongWithIt) {
  EXPECT_GT(expect_that_options_say_what_is_wrong(tried, all_commands(tried, programs)), 80);
}

TEST(CommandLine, NumbersOutOfRangeAreRefusedByTheOtherPrograms) {
  EXPECT_GT(expect_that_ranges_are_kept(tried, all_commands(tried, programs)), 10);
}

TEST(CommandLine, APipeThatIsClosedEndsEveryCommandQuietly) {
  const ScratchFolder folder;
  const std::string world = source("worlds/minimal.yaml"), log = folder.file("run.lcm");
  ASSERT_EQ(run_shoal({"run", world, "--bus", "none", "--duration", "2", "--speed", "max", "--record", log}).exit_code,
            0);
  const Words lines = {
      "--help",
      "run --help",
      "list devices",
      "list messages",
      "describe world",
      "describe --page devices",
      "describe --schema world",
      "log info " + log,
      "log csv " + log + " rover1.lidar",
      "check " + world,
      "run " + world + " --bus none --duration 1 --speed max --quiet --results " + folder.file("results"),
      "run " + world + " --bus none --duration 1 --speed max",
      "replay " + log + " --quiet",
      "acoustics --ranges 1:5000:1",
      "bench --robots 1 --warm-up 0 --measure 0.1"};
  for (const std::string& line : lines) {
    // `true` reads nothing at all; `head` reads a line.
    for (const char* reader : {"true", "head -1"}) {
      const Ended ended = run_shell("shoal " + line + " | " + reader);
      EXPECT_EQ(ended.exit_code, 0) << line << " | " << reader;
      EXPECT_THAT(ended.errors, Not(HasSubstr("pipe"))) << line;
      EXPECT_THAT(ended.errors, Not(HasSubstr("cannot write"))) << line;
    }
  }
  EXPECT_TRUE(std::filesystem::exists(folder.file("results/summary.json")));
}

TEST(CommandLine, AFullDiskIsReportedByEveryCommandThatPrints) {
  const std::string world = source("worlds/minimal.yaml");
  for (const std::string& line :
       {std::string("--help"), std::string("run --help"), std::string("list devices"), std::string("describe world"),
        std::string("--version"), "check " + world, std::string("acoustics --range 100"), "medium " + world,
        "run " + world + " --bus none --duration 0.1 --speed max"}) {
    const Ended ended = run_shell("shoal " + line + " > /dev/full");
    EXPECT_EQ(ended.exit_code, 4) << line;
    EXPECT_THAT(ended.errors, HasSubstr("shoal: cannot write to stdout: No space left on device")) << line;
  }
}

TEST(CommandLine, FilesThatAreNotWhatTheyShouldBeAreNamed) {
  const ScratchFolder folder;
  const std::string world = source("worlds/minimal.yaml"), none = folder.file("none"), dir = source("worlds");
  struct Case {
    Words arguments;
    int exit_code;
    std::string named;
  };
  const std::vector<Case> cases = {
      {{"run", none}, 2, none},
      {{"run", dir}, 2, dir},
      {{"check", none}, 2, none},
      {{"check", dir}, 2, dir},
      {{"check", "/dev/null"}, 2, "/dev/null"},
      {{"snap", dir, "--out", folder.file("a.png")}, 2, dir},
      {{"snap", world, "--size", "40x30", "--out", "/dev/full/a.png"}, 4, "/dev/full/a.png"},
      {{"snapshot", none}, 4, none},
      {{"snapshot", dir}, 4, dir},
      {{"run", "--from", dir}, 4, dir},
      {{"log", "info", none}, 4, none},
      {{"log", "info", dir}, 4, dir},
      {{"log", "csv", none, "c"}, 4, none},
      {{"log", "allan", none, "c"}, 4, none},
      {{"log", "image", none, "c", "--png", folder.file("a.png")}, 4, none},
      {{"replay", none}, 4, none},
      {{"replay", dir}, 4, dir},
      {{"score", none}, 4, none},
      {{"score", dir}, 4, dir},
      {{"report", none}, 4, none},
      {{"study", none}, 2, none},
      {{"study", dir}, 2, dir},
      {{"fidelity", none}, 2, none},
      {{"mesh", none}, 2, none},
      {{"mesh", dir}, 2, dir},
      {{"medium", none}, 2, none},
      {{"acoustics", none}, 2, none},
      {{"acoustics", "--closed-forms", none}, 4, none},
      {{"control", "spawn", "@" + none}, 2, none},
      {{"control", "spawn", "@" + dir}, 2, dir},
      {{"spy", "--types", none}, 4, none},
      {{"list", "devices", "--plugin", none}, 2, none},
      {{"run", world, "--await", "a", "--bus", "none"}, 2, "--await: needs the LCM bus"},
      {{"check", "grüße.yaml"}, 2, "grüße.yaml"},
      {{"run", world, "--bus", "none", "--results", "/dev/null/r"}, 4, "/dev/null/r"},
      {{"run", world, "--bus", "none", "--record", dir}, 4, dir},
  };
  for (const Case& each : cases) {
    const Ended ended = run_shoal(each.arguments);
    EXPECT_EQ(ended.exit_code, each.exit_code) << testing::PrintToString(each.arguments) << ended.errors;
    EXPECT_THAT(ended.errors, HasSubstr(each.named)) << testing::PrintToString(each.arguments);
    EXPECT_LE(lines_of(ended.errors).size(), 2u) << ended.errors;
  }
}

TEST(CommandLine, OutputFitsEightyColumns) {
  for (const char* what : {"device", "noise", "world", "vehicle", "study", "lidar", "micromodem", "camera", "pose_t",
                           "sim_info_t", "planar_lidar_t", "multibeam_t"}) {
    const Ended ended = run_program("shoal", {"describe", what}, {"COLUMNS=80"});
    for (const std::string& line : lines_of(ended.output))
      EXPECT_TRUE(line.size() <= 80 || line.find(' ', line.find_first_not_of(' ')) == std::string::npos) << line;
  }
  EXPECT_LE(max_line(run_program("shoal", {"list", "devices"}, {"COLUMNS=80"}).output), 80u);
  EXPECT_LE(max_line(run_program("shoal", {"list", "messages"}, {"COLUMNS=80"}).output), 80u);
  EXPECT_LE(max_line(run_program("shoal", {"acoustics"}, {"COLUMNS=80"}).output), 80u);
}

TEST(CommandLine, LogLevelDecidesWhatGoesToStderr) {
  const ScratchFolder folder;
  // An event that speaks, and a script that warns of nothing: what is said is `info`.
  write_file(folder.file("w.yaml"),
             "shoal: 1\nrun: {duration_s: 1, speed: max}\nevents:\n  - {name: e, at: 0.5, do: [{log: here it is}]}\n"
             "  - {name: f, at: 0.6, do: [{publish: {channel: a.cmd, type: shoal.utime_t, value: {utime: 1}}}]}\n");
  for (const auto& [level, reports] :
       {std::pair{"debug", true}, {"info", true}, {"warn", false}, {"error", false}, {"off", false}}) {
    const Ended ended = run_shoal({"run", folder.file("w.yaml"), "--bus", "none", "--log-level", level});
    EXPECT_EQ(ended.exit_code, 0) << ended.errors;
    EXPECT_EQ(ended.errors.find("here it is") != std::string::npos, reports) << level << ended.errors;
    EXPECT_THAT(ended.output, HasSubstr("state hash")) << level;
    if (std::string(level) == "off") {
      EXPECT_EQ(ended.errors, "");
    }
  }
  // An error that ends the command is said at every level.
  const Ended ended = run_shoal({"run", folder.file("none.yaml"), "--log-level", "off"});
  EXPECT_THAT(ended.errors, HasSubstr("none.yaml"));
}

TEST(CommandLine, ProgressKeepsToTheWidthAndTheLevel) {
  const ScratchFolder folder;
  write_file(folder.file("w.yaml"), endless_world());
  OnTerminal narrow(
      {"env", "-u", "COLUMNS", built("shoal"), "run", folder.file("w.yaml"), "--bus", "none", "--no-keys"}, 40, 24);
  ASSERT_TRUE(narrow.shows("..."));
  kill(narrow.pid(), SIGINT);
  EXPECT_EQ(narrow.wait(), 130);
  OnTerminal silent({built("shoal"), "run", folder.file("w.yaml"), "--bus", "none", "--duration", "1.2", "--no-keys",
                     "--log-level", "warn"},
                    80, 24);
  EXPECT_EQ(silent.wait(), 0);
  EXPECT_THAT(silent.shown(), Not(HasSubstr("x real time  ")));
  EXPECT_THAT(silent.shown(), HasSubstr("state hash"));
}

TEST(CommandLine, ColorsAreForTerminalsWithoutNoColor) {
  const ScratchFolder folder;
  // Falls like a stone, which a warning says.
  write_file(folder.file("w.yaml"), "shoal: 1\nvehicles:\n  - {name: a, position_m: [0, 0, 0], file: " +
                                        source("vehicles/remus100.yaml") + "}\n");
  const Words check = {built("shoal"), "check", folder.file("w.yaml")};
  const auto shown = [&](Words environment) {
    environment.insert(environment.begin(), "env");
    environment.insert(environment.end(), check.begin(), check.end());
    OnTerminal terminal(environment, 80, 24);
    EXPECT_TRUE(terminal.shows("warning"));
    terminal.wait();
    return terminal.shown();
  };
  EXPECT_THAT(shown({"-u", "NO_COLOR", "TERM=xterm"}), HasSubstr("\x1b[m"));
  EXPECT_THAT(shown({"TERM=xterm", "NO_COLOR=1"}), Not(HasSubstr("\x1b[m")));
  EXPECT_THAT(shown({"TERM=dumb"}), Not(HasSubstr("\x1b")));
  Program piped(check);
  piped.wait();
  EXPECT_THAT(piped.errors(), HasSubstr("warning"));
  EXPECT_THAT(piped.errors(), Not(HasSubstr("\x1b")));
}

TEST(Spy, FitsATerminalAndIsPlainInAPipe) {
  const ScratchFolder folder;
  write_file(folder.file("w.yaml"), endless_world());
  Program shoal({built("shoal"), "run", folder.file("w.yaml"), "--lcm-url", own_url(), "--quiet"});
  OnTerminal spy({"env", "-u", "COLUMNS", "TERM=xterm", built("shoal"), "spy", "--lcm-url", own_url()}, 60, 5);
  ASSERT_TRUE(spy.shows("more channels"));
  ASSERT_TRUE(spy.shows("last message"));
  kill(spy.pid(), SIGINT);
  EXPECT_EQ(spy.wait(), 0);
  for (std::string line : lines_of(spy.shown())) {
    line = std::regex_replace(line, std::regex("\x1b\\[[0-9;]*[A-Za-z]|\r"), "");
    EXPECT_LE(line.size(), 60u) << line;
  }
  const Ended piped = run_shell("shoal spy --lcm-url '" + own_url() + "' | head -3");
  EXPECT_EQ(piped.exit_code, 0);
  EXPECT_EQ(piped.errors, "");
  EXPECT_EQ(lines_of(piped.output).size(), 3u);
  EXPECT_THAT(piped.output, Not(HasSubstr("\x1b")));
  const Ended one = run_shell("shoal spy sim.clock --lcm-url '" + own_url() + "' | head -1");
  EXPECT_EQ(one.exit_code, 0);
  EXPECT_EQ(one.output, "shoal.utime_t\n");
  shoal.send_signal(SIGINT);
  EXPECT_EQ(shoal.wait(), 130);
}

}  // namespace
