// SPDX-License-Identifier: BSD-3-Clause
#include "sim/program/program_declaration.hpp"

#include <gmock/gmock.h>

namespace {

using testing::ElementsAre;
using testing::HasSubstr;

constexpr const char* head = "shoal_args: 1\nprogram: pilot\n";

std::vector<std::string> errors_of(const std::string& text) {
  sim::Diagnostics diagnostics;
  sim::read_declaration(text, "pilot.args.yaml", diagnostics);
  return diagnostics.lines();
}

/// The errors of one argument with these keys.
std::vector<std::string> errors_of_arg(const std::string& keys) {
  return errors_of(std::string(head) + "args:\n  - {" + keys + "}\n");
}

TEST(ProgramDeclaration, IsRead) {
  sim::Diagnostics diagnostics;
  const sim::ProgramDeclaration pilot = sim::read_declaration(
      std::string(head) +
          "meaning: Flies.\npublishes: ['{name}.cmd']\nargs:\n"
          "  - {name: name, type: text, required: true}\n"
          "  - {name: speed_mps, type: number, min: 0, max: 5, default: 1.5, meaning: how fast}\n"
          "  - {name: orders, type: tuples, columns: [time_s, depth_m, speed_mps], min_columns: 2}\n"
          "  - {name: slot, type: integer, needs: [slots]}\n  - {name: slots, type: integer}\n"
          "at_most_one: [[slot, orders]]\n",
      "pilot.args.yaml", diagnostics);
  EXPECT_THAT(diagnostics.lines(), ElementsAre());
  EXPECT_EQ(pilot.program, "pilot");
  ASSERT_EQ(pilot.args.size(), 5u);
  EXPECT_TRUE(pilot.args[0].required);
  EXPECT_EQ(pilot.args[1].range.high, 5);
  EXPECT_EQ(pilot.args[1].initial->scalar, "1.5");
  EXPECT_EQ(pilot.args[2].needed_columns(), 2u);
  EXPECT_EQ(pilot.find("slot"), &pilot.args[3]);
  EXPECT_EQ(pilot.find("slop"), nullptr);
  EXPECT_THAT(*pilot.publishes, ElementsAre("{name}.cmd"));
  EXPECT_FALSE(pilot.subscribes) << "unknown";
}

TEST(ProgramDeclaration, ReadsBackAsItIsWritten) {
  sim::Diagnostics diagnostics;
  const std::string text =
      std::string(head) +
      "meaning: \"Flies: up, 'down' and #1.\"\npublishes: [\"{name}.cmd\"]\nsubscribes: []\nargs:\n"
      "  - {name: mode, type: choice, choices: [slow, fast], default: slow, meaning: \"a, b\"}\n"
      "  - {name: start_m, type: tuple, columns: [x, y], min: -10000000, max: 10000000, default: "
      "[0, 0]}\n"
      "  - {name: loop, type: flag, needs: [mode]}\n"
      "exactly_one: [[mode, loop]]\n";
  const sim::ProgramDeclaration pilot = sim::read_declaration(text, "pilot.args.yaml", diagnostics);
  EXPECT_THAT(diagnostics.lines(), ElementsAre());
  EXPECT_EQ(sim::to_yaml(pilot), text);
}

TEST(ProgramDeclaration, SaysWhatIsWrongAndWhere) {
  EXPECT_THAT(errors_of("args: []\n"), ElementsAre("pilot.args.yaml:1:1: missing key 'shoal_args'",
                                                   "pilot.args.yaml:1:1: missing key 'program'"));
  EXPECT_THAT(errors_of("shoal_args: 2\nprogram: pilot\n"),
              ElementsAre("pilot.args.yaml:1:13: 'shoal_args' must be 1, got 2: the file is of a newer Shoal"));
  EXPECT_THAT(errors_of(std::string(head) + "arguments: []\n"), ElementsAre(HasSubstr("unknown key 'arguments'")));
  EXPECT_THAT(errors_of("[1, 2"), ElementsAre(HasSubstr("pilot.args.yaml:1:")));
  EXPECT_THAT(errors_of_arg("name: speed, type: nummer"), ElementsAre(HasSubstr("4:25: argument 'speed': 'type'")));
  EXPECT_THAT(errors_of_arg("name: Speed, type: number"), ElementsAre(HasSubstr("must begin with a small letter")));
  EXPECT_THAT(errors_of_arg("name: a-b, type: number"), ElementsAre(HasSubstr("got 'a-b'")));
  EXPECT_THAT(errors_of_arg("name: a, type: text, min: 1"),
              ElementsAre(HasSubstr("argument 'a': 'min' does not apply to 'type: text'")));
  EXPECT_THAT(errors_of_arg("name: a, type: choice"), ElementsAre(HasSubstr("'type: choice' needs 'choices'")));
  EXPECT_THAT(errors_of_arg("name: a, type: tuple"), ElementsAre(HasSubstr("'type: tuple' needs 'columns'")));
  EXPECT_THAT(errors_of_arg("name: a, type: tuple, columns: [x], min_columns: 2"),
              ElementsAre(HasSubstr("'min_columns' must be at most the number of 'columns'")));
  EXPECT_THAT(errors_of_arg("name: a, type: number, min: 2, max: 1"), ElementsAre(HasSubstr("got 1 below 2")));
  EXPECT_THAT(errors_of_arg("name: a, type: number, max: 2, default: 3"),
              ElementsAre(HasSubstr("argument 'a': 'default' must be <= 2, got 3")));
  EXPECT_THAT(errors_of_arg("name: a, type: number, required: true, default: 3"),
              ElementsAre(HasSubstr("'default' cannot be combined with 'required: true'")));
  EXPECT_THAT(errors_of_arg("name: a, type: flag, needs: [b]"),
              ElementsAre(HasSubstr("'needs' of 'a' names no argument 'b'")));
  EXPECT_THAT(errors_of(std::string(head) + "args: [{name: a, type: flag}, {name: a, type: flag}]\n"),
              ElementsAre(HasSubstr("duplicate argument 'a'")));
  EXPECT_THAT(errors_of(std::string(head) + "exactly_one: [a]\n"), ElementsAre(HasSubstr("list of lists")));
}

}  // namespace
