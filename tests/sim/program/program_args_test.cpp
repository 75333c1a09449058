// SPDX-License-Identifier: BSD-3-Clause
#include "sim/program/program_args.hpp"

#include <gmock/gmock.h>

namespace {

using testing::ElementsAre;
using testing::HasSubstr;

const sim::ProgramDeclaration& rover() {
  static const sim::ProgramDeclaration declaration = [] {
    sim::Diagnostics diagnostics;
    sim::ProgramDeclaration read = sim::read_declaration(
        "shoal_args: 1\nprogram: rover\nargs:\n"
        "  - {name: name, type: text, required: true}\n"
        "  - {name: waypoints_m, type: tuples, columns: [x, y], min: -1e7, max: 1e7}\n"
        "  - {name: start_m, type: tuple, columns: [x, y, z], min_columns: 2}\n"
        "  - {name: weights, type: numbers, min: 0}\n"
        "  - {name: speed_mps, type: number, min: 0.05, max: 5, default: 0.8}\n"
        "  - {name: id, type: integer, min: 0, max: 255}\n"
        "  - {name: loop, type: flag}\n"
        "  - {name: steer, type: choice, choices: [cooperative, alone]}\n"
        "  - {name: slot, type: integer, needs: [slots]}\n"
        "  - {name: slots, type: integer}\n"
        "  - {name: random_s, type: number}\n"
        "at_most_one: [[slot, random_s]]\n",
        "rover.args.yaml", diagnostics);
    EXPECT_THAT(diagnostics.lines(), ElementsAre());
    return read;
  }();
  return declaration;
}

struct Checked {
  std::vector<std::string> words, errors;
};

Checked check(const sim::ProgramDeclaration& declaration, const std::string& args) {
  sim::Diagnostics diagnostics;
  const sim::ConfigNode node = sim::parse_config_text(args, "w.yaml", diagnostics);
  Checked checked;
  checked.words = sim::command_line_of(declaration, node, node.place, "process 'r'", diagnostics);
  checked.errors = diagnostics.lines();
  return checked;
}

std::vector<std::string> errors(const std::string& args) {
  return check(rover(), "{name: r, " + args + "}").errors;
}

TEST(ProgramArgs, BecomeACommandLineInTheirOrder) {
  const Checked checked = check(rover(),
                                "{speed_mps: 1.50, name: rover 1, waypoints_m: [[-28, 28], [-20.5, 1e3]], start_m: [1, "
                                "2], weights: [], id: 7, loop: true, steer: alone}");
  EXPECT_THAT(checked.errors, ElementsAre());
  EXPECT_THAT(checked.words, ElementsAre("--speed-mps=1.5", "--name=rover 1", "--waypoints-m=[[-28,28],[-20.5,1000]]",
                                         "--start-m=[1,2]", "--weights=[]", "--id=7", "--loop", "--steer=alone"));
  EXPECT_THAT(check(rover(), "{name: --help, loop: false}").words, ElementsAre("--name=--help"));
}

TEST(ProgramArgs, WrongOnesAreNamedWithTheirPlace) {
  EXPECT_THAT(errors("waypoints_m: [[-28, 28], [-20]]"),
              ElementsAre("w.yaml:1:36: process 'r': 'waypoints_m[2]' must be 2 numbers, got 1"));
  EXPECT_THAT(errors("waypoints_m: 3"), ElementsAre(HasSubstr("1:24: process 'r': 'waypoints_m' must be a list of "
                                                              "[x, y], got '3'")));
  EXPECT_THAT(errors("waypoints_m: [3]"), ElementsAre(HasSubstr("'waypoints_m[1]' must be a list of 2 numbers")));
  EXPECT_THAT(errors("waypoints_m: [[1, 2e7]]"), ElementsAre(HasSubstr("item 2 of 'waypoints_m[1]' must be >= ")));
  EXPECT_THAT(errors("start_m: [1]"), ElementsAre(HasSubstr("'start_m' must be 2 to 3 numbers, got 1")));
  EXPECT_THAT(errors("weights: [1, -1]"), ElementsAre(HasSubstr("item 2 of 'weights' must be >= 0, got -1")));
  EXPECT_THAT(errors("speed_mps: 9"),
              ElementsAre("w.yaml:1:22: process 'r': 'speed_mps' must be >= 0.05 and <= 5, got 9"));
  EXPECT_THAT(errors("speed_mps: '1'"), ElementsAre(HasSubstr("must be a number, got the text '1'")));
  EXPECT_THAT(errors("id: 1.5"), ElementsAre(HasSubstr("'id' must be a whole number, got '1.5'")));
  EXPECT_THAT(errors("loop: 1"), ElementsAre(HasSubstr("'loop' must be true or false, got '1'")));
  EXPECT_THAT(errors("steer: alon"), ElementsAre(HasSubstr("'steer'")));
  EXPECT_THAT(errors("speed_mps:"), ElementsAre(HasSubstr("'speed_mps' must be a number, got nothing")));
}

TEST(ProgramArgs, UnknownMissingAndContraryOnesAreErrors) {
  EXPECT_THAT(errors("waypoint_m: []"),
              ElementsAre("w.yaml:1:11: process 'r': unknown argument 'waypoint_m'; did you mean 'waypoints_m'?"));
  EXPECT_THAT(errors("color: red"), ElementsAre(HasSubstr("unknown argument 'color'; known arguments: name, ")));
  EXPECT_THAT(check(rover(), "{loop: true}").errors, ElementsAre("w.yaml:1:1: process 'r': missing argument 'name'"));
  EXPECT_THAT(check(rover(), "[name]").errors, testing::Not(ElementsAre()));
  EXPECT_THAT(errors("slot: 1"), ElementsAre("w.yaml:1:17: process 'r': 'slot' needs the argument 'slots'"));
  EXPECT_THAT(errors("slot: 1, slots: 2, random_s: 3"),
              ElementsAre(HasSubstr("of slot, random_s only one may be given, got 'slot', 'random_s'")));
  sim::ProgramDeclaration one = rover();
  one.exactly_one = {{"waypoints_m", "loop"}};
  EXPECT_THAT(check(one, "{name: r}").errors,
              ElementsAre("w.yaml:1:1: process 'r': missing argument: one of waypoints_m, loop"));
}

TEST(ProgramArgs, AWordIsNotLongerThanLinuxTakes) {
  EXPECT_THAT(check(rover(), "{name: " + std::string(131064, 'x') + "}").words, testing::SizeIs(1));
  EXPECT_THAT(errors("steer: alone, weights: [1]"), ElementsAre());
  EXPECT_THAT(check(rover(), "{name: " + std::string(131065, 'x') + "}").errors,
              ElementsAre(HasSubstr("'name' must have at most 131071 bytes on the command line, got 131072")));
  EXPECT_THAT(check(rover(), "{name: \"a\\0b\"}").errors,
              ElementsAre(HasSubstr("must have no control characters, got 'a\\x00b'")));
}

TEST(ProgramArgs, NameTheChannels) {
  sim::Diagnostics diagnostics;
  const sim::ConfigNode args = sim::parse_config_text("{name: r1}", "w.yaml", diagnostics);
  EXPECT_EQ(sim::channel_of(rover(), args, "{name}.estimate"), "r1.estimate");
  EXPECT_EQ(sim::channel_of(rover(), args, "{name}.{speed_mps}"), "r1.0.8");
  EXPECT_EQ(sim::channel_of(rover(), args, "{steer}.estimate"), "");
  EXPECT_EQ(sim::channel_of(rover(), args, "{name"), "{name");
}

}  // namespace
