// SPDX-License-Identifier: BSD-3-Clause
#include "tools/command_line/declared_options.hpp"

#include <gmock/gmock.h>

#include <CLI/CLI.hpp>

#include "tools/command_line/help.hpp"

namespace {

using testing::ElementsAre;
using testing::HasSubstr;

/// A program with an argument of each kind.
class Pilot {
 public:
  Pilot() {
    options.text("name", "NAME", name, "name of it").required();
    options.number("speed_mps", speed_mps, 0, 5, "how fast");
    options.integer("slot", slot, 0, 9, "its slot").needs({"slots"});
    options.integer("slots", slots, 1, 10, "slots in a cycle");
    options.flag("loop", loop, "again and again");
    options.choice("mode", mode, {"slow", "fast"}, "way of driving");
    options.tuple(
        "start_m", {"x", "y"}, sim::any_place(), [this](const auto& numbers) { start_m = numbers; }, "position");
    options.tuples(
        "orders", {"time_s", "depth_m", "speed_mps"}, 2, sim::any_place(),
        [this](const auto& lists) { orders = lists; }, "what to do");
    options.at_most_one({"start_m", "orders"});
    options.publishes({"{name}.cmd"});
  }

  /// The exit code; -1: continue.  What is printed is in `out` and `err`.
  int parse(std::vector<const char*> words) {
    words.insert(words.begin(), "pilot");
    testing::internal::CaptureStdout();
    testing::internal::CaptureStderr();
    const int exit_code = options.parse(static_cast<int>(words.size()), words.data()).value_or(-1);
    out = testing::internal::GetCapturedStdout();
    err = testing::internal::GetCapturedStderr();
    return exit_code;
  }

  CLI::App app{"Flies.", "pilot"};
  command_line::DeclaredOptions options{app};
  std::string name, mode = "slow", out, err;
  double speed_mps = 1.5;
  std::optional<int> slot, slots;
  bool loop = false;
  std::vector<double> start_m;
  std::vector<std::vector<double>> orders;
};

TEST(DeclaredOptions, AreTakenAsAWorldGivesThem) {
  Pilot pilot;
  EXPECT_EQ(pilot.parse({"--name=a", "--speed-mps=2.5", "--slot=1", "--slots=2", "--loop", "--mode=fast",
                         "--orders=[[1,2],[3,4,5]]"}),
            -1)
      << pilot.err;
  EXPECT_EQ(pilot.name, "a");
  EXPECT_EQ(pilot.speed_mps, 2.5);
  EXPECT_EQ(pilot.slot, 1);
  EXPECT_TRUE(pilot.loop);
  EXPECT_EQ(pilot.mode, "fast");
  EXPECT_THAT(pilot.orders, ElementsAre(ElementsAre(1, 2), ElementsAre(3, 4, 5)));
  Pilot by_hand;
  EXPECT_EQ(by_hand.parse({"--name", "a", "--start-m", "[-1, 2e1]"}), -1) << by_hand.err;
  EXPECT_THAT(by_hand.start_m, ElementsAre(-1, 20));
}

TEST(DeclaredOptions, SayWhatIsWrong) {
  const std::pair<std::vector<const char*>, const char*> mistakes[] = {
      {{}, "pilot: --name is required"},
      {{"--name=a", "--speed-mps=6"}, "--speed-mps: must be from 0 to 5, got '6'"},
      {{"--name=a", "--slot=1"}, "--slot needs --slots"},
      {{"--name=a", "--mode=quick"}, "--mode: must be slow or fast, got 'quick'"},
      {{"--name=a", "--start-m=[1]"}, "--start-m: 'start_m' must be 2 numbers, got 1"},
      {{"--name=a", "--start-m=[1,"}, "--start-m:1:"},
      {{"--name=a", "--orders=[[1]]"}, "--orders: 'orders[1]' must be 2 to 3 numbers, got 1"},
      {{"--name=a", "--orders=7"}, "--orders: 'orders' must be a list of [time_s, depth_m, speed_mps], got '7'"},
      {{"--name=a", "--start-m=[1,2]", "--orders=[[1,2]]"}, "--start-m cannot be combined with --orders"},
      {{"--name=a", "--describe"}, "--describe takes no other options"},
      {{"--name=a", "--orderss=1"}, "unknown option '--orderss'; did you mean '--orders'?"},
  };
  for (const auto& [words, reports] : mistakes) {
    Pilot pilot;
    EXPECT_EQ(pilot.parse(words), 2) << reports;
    EXPECT_THAT(pilot.err, HasSubstr(reports));
  }
  Pilot one;
  one.options.exactly_one({"loop", "orders"});
  EXPECT_EQ(one.parse({"--name=a"}), 2);
  EXPECT_THAT(one.err, HasSubstr("pilot: needs --loop or --orders"));
}

TEST(DeclaredOptions, DescribeThemselvesAsADeclaration) {
  Pilot pilot;
  EXPECT_EQ(pilot.parse({"--describe"}), 0);
  EXPECT_EQ(pilot.out,
            "shoal_args: 1\nprogram: pilot\nmeaning: \"Flies.\"\npublishes: [\"{name}.cmd\"]\nargs:\n"
            "  - {name: name, type: text, required: true, meaning: \"name of it\"}\n"
            "  - {name: speed_mps, type: number, min: 0, max: 5, default: 1.5, meaning: \"how fast\"}\n"
            "  - {name: slot, type: integer, min: 0, max: 9, needs: [slots], meaning: \"its slot\"}\n"
            "  - {name: slots, type: integer, min: 1, max: 10, meaning: \"slots in a cycle\"}\n"
            "  - {name: loop, type: flag, meaning: \"again and again\"}\n"
            "  - {name: mode, type: choice, choices: [slow, fast], default: slow, meaning: \"way of driving\"}\n"
            "  - {name: start_m, type: tuple, columns: [x, y], min: -10000000, max: 10000000, meaning: \"position\"}\n"
            "  - {name: orders, type: tuples, columns: [time_s, depth_m, speed_mps], min_columns: 2, min: -10000000, "
            "max: 10000000, meaning: \"what to do\"}\n"
            "at_most_one: [[start_m, orders]]\n");
  sim::Diagnostics diagnostics;
  sim::read_declaration(pilot.out, "pilot.args.yaml", diagnostics);
  EXPECT_THAT(diagnostics.lines(), ElementsAre());
}

TEST(DeclaredOptions, StandInTheHelp) {
  Pilot pilot;
  EXPECT_EQ(pilot.parse({"--help"}), 0);
  EXPECT_THAT(pilot.out, HasSubstr("--speed-mps NUMBER"));
  EXPECT_THAT(pilot.out, HasSubstr("how fast (from 0 to 5; default 1.5)"));
  EXPECT_THAT(pilot.out, HasSubstr("--start-m [X,Y]"));
  EXPECT_THAT(pilot.out, HasSubstr("--orders [[TIME,DEPTH,SPEED],...]"));
}

using testing::ElementsAre;

std::vector<std::string> names_of(std::vector<std::string> words) {
  CLI::App app;
  std::vector<std::string> names;
  command_line::add_name_list(app, "--joints", names, "which");
  std::reverse(words.begin(), words.end());  // as CLI11 takes them
  app.parse(words);
  return names;
}

TEST(NameList, HasNamesBetweenCommas) {
  EXPECT_THAT(names_of({"--joints", "hip,knee"}), ElementsAre("hip", "knee"));
  EXPECT_THAT(names_of({"--joints", "hip", "--joints", "knee,toe"}), ElementsAre("hip", "knee", "toe"));
  EXPECT_THAT(names_of({}), testing::IsEmpty());
}

TEST(NameList, AnEmptyNameIsAnError) {
  for (const char* text : {",", "hip,", ",hip", "hip,,knee"})
    EXPECT_THROW(names_of({std::string("--joints=") + text}), CLI::ValidationError) << text;
}

}  // namespace
