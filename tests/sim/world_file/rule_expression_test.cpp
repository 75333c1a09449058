// SPDX-License-Identifier: BSD-3-Clause
#include "sim/world_file/rule_expression.hpp"

#include <gmock/gmock.h>

#include <cmath>
#include <limits>
#include <map>

#include "sim/world_file/load_world.hpp"
#include "tests/comma_locale.hpp"
#include "tests/sim/config/parse.hpp"

namespace {

using sim::RuleExpression;
using sim::RuleProblem;

/// Knows some figures, and the function `max`.
class SomeNames final : public sim::RuleNames {
 public:
  std::string function_problem(const std::string& function) const override {
    return function == "max" ? "" : "unknown function '" + function + "'";
  }
  std::optional<RuleProblem> name_problem(const std::string& /*function*/, const std::string& name) const override {
    if (values.contains(name)) return std::nullopt;
    return RuleProblem{name.find('.') + 1, "unknown name '" + name + "'"};
  }

  const std::map<std::string, double> values{{"a.x_m", 6}, {"b.x_m", 2}, {"a-b.x_m", 5}, {"3d.x_m", 7}};
};

const SomeNames some_names;

RuleExpression rule_of(const std::string& text) {
  RuleProblem problem;
  const auto rule = RuleExpression::parse(text, some_names, problem);
  EXPECT_TRUE(rule) << text << ": " << problem.text;
  return rule.value_or(RuleExpression());
}

RuleExpression::Outcome outcome_of(const std::string& text) {
  const RuleExpression rule = rule_of(text);
  std::vector<double> values;
  for (const RuleExpression::Figure& figure : rule.figures()) values.push_back(some_names.values.at(figure.name));
  return rule.evaluate(values);
}

bool holds(const std::string& text) {
  return outcome_of(text).holds;
}

/// `AT: TEXT`, with the character counted from 0.
std::string problem_of(const std::string& text) {
  RuleProblem problem;
  if (RuleExpression::parse(text, some_names, problem)) return "none";
  return std::to_string(problem.at) + ": " + problem.text;
}

TEST(RuleExpression, ComparesItsTwoSides) {
  EXPECT_TRUE(holds("a.x_m < 6.5"));
  EXPECT_FALSE(holds("a.x_m < 6"));
  EXPECT_TRUE(holds("a.x_m <= 6"));
  EXPECT_FALSE(holds("a.x_m > 6"));
  EXPECT_TRUE(holds("a.x_m >= 6"));
  EXPECT_TRUE(holds("a.x_m == 6"));
  EXPECT_FALSE(holds("a.x_m != 6"));
  EXPECT_TRUE(holds("7 > a.x_m"));
  EXPECT_TRUE(holds("a.x_m<6.5"));
}

TEST(RuleExpression, CalculatesAsOnPaper) {
  EXPECT_EQ(outcome_of("a.x_m + 2 * b.x_m < 0").left, 6 + 2 * 2);
  EXPECT_EQ(outcome_of("(a.x_m + 2) * b.x_m < 0").left, (6 + 2) * 2);
  EXPECT_EQ(outcome_of("a.x_m - b.x_m - 1 < 0").left, 6 - 2 - 1);
  EXPECT_EQ(outcome_of("a.x_m / b.x_m / 4 < 0").left, 6.0 / 2 / 4);
  EXPECT_EQ(outcome_of("-a.x_m * -2 < 0").left, 12);
  EXPECT_EQ(outcome_of("a.x_m - -2 < 0").left, 8);
  EXPECT_EQ(outcome_of("a.x_m < -(b.x_m + 1e1) / 0.5").right, -24);
  EXPECT_EQ(outcome_of("a.x_m < .5").right, 0.5);
  EXPECT_EQ(outcome_of("a.x_m\n  < 1e-3\t").right, 0.001);
}

TEST(RuleExpression, ReportsAMinusFromADashInAName) {
  EXPECT_EQ(outcome_of("a-b.x_m < 0").left, 5);
  EXPECT_EQ(outcome_of("a.x_m-b.x_m < 0").left, 6 - 2);
  EXPECT_EQ(outcome_of("a.x_m-a-b.x_m < 0").left, 6 - 5);
  EXPECT_EQ(outcome_of("a.x_m-(b.x_m) < 0").left, 6 - 2);
  EXPECT_EQ(outcome_of("a.x_m-3 < 0").left, 6 - 3);
  EXPECT_EQ(outcome_of("9-3d.x_m < 0").left, 9 - 7);
}

TEST(RuleExpression, NamesEachFigureOnce) {
  const RuleExpression rule = rule_of("max(a.x_m) + a.x_m < max( a.x_m ) * b.x_m");
  std::vector<std::string> names;
  for (const RuleExpression::Figure& figure : rule.figures()) names.push_back(figure.text());
  EXPECT_THAT(names, testing::ElementsAre("max(a.x_m)", "a.x_m", "b.x_m"));
  EXPECT_EQ(rule.evaluate(std::vector<double>{1, 2, 3}).right, 3);
}

TEST(RuleExpression, ItsMarginIsAboveZeroWhereItHolds) {
  EXPECT_EQ(outcome_of("a.x_m < 8").margin, 2);
  EXPECT_EQ(outcome_of("a.x_m <= 5").margin, -1);
  EXPECT_EQ(outcome_of("a.x_m > 8").margin, -2);
  EXPECT_EQ(outcome_of("a.x_m >= 5").margin, 1);
  EXPECT_TRUE(std::isnan(outcome_of("a.x_m == 6").margin));
  EXPECT_TRUE(std::isnan(outcome_of("a.x_m != 5").margin));
}

TEST(RuleExpression, NothingHoldsForAFigureThatIsNotThere) {
  const double none = std::numeric_limits<double>::quiet_NaN();
  for (const std::string sign : {"<", "<=", ">", ">=", "==", "!="}) {
    EXPECT_FALSE(rule_of("a.x_m " + sign + " 3").evaluate(std::vector{none}).holds) << sign;
    EXPECT_FALSE(rule_of("3 " + sign + " a.x_m").evaluate(std::vector{none}).holds) << sign;
  }
  const double endless = std::numeric_limits<double>::infinity();
  EXPECT_TRUE(rule_of("a.x_m > 3").evaluate(std::vector{endless}).holds);
  EXPECT_FALSE(rule_of("a.x_m - a.x_m != 3").evaluate(std::vector{endless}).holds);
}

TEST(RuleExpression, ADivisionByZeroFailsTheRule) {
  for (const std::string sign : {"<", "<=", ">", ">=", "==", "!="})
    EXPECT_FALSE(rule_of("a.x_m / b.x_m " + sign + " 3").evaluate(std::vector{1.0, 0.0}).holds) << sign;
  EXPECT_EQ(problem_of("a.x_m / 0 < 3"), "8: a division by 0 has no result");
}

TEST(RuleExpression, SaysWhatIsWrongAtWhichCharacter) {
  const std::string made_of = ": a rule is made of numbers, figures, + - * / ( ) and one of < <= > >= == !=";
  EXPECT_EQ(problem_of(""), "0: the rule is empty; write a comparison such as 'METRIC.FIGURE < 5'");
  EXPECT_EQ(problem_of("  "), "0: the rule is empty; write a comparison such as 'METRIC.FIGURE < 5'");
  EXPECT_EQ(problem_of("a.y_m < 3"), "2: unknown name 'a.y_m'");
  EXPECT_EQ(problem_of("3 > b.x_m - a.y_m"), "14: unknown name 'a.y_m'");
  EXPECT_EQ(problem_of("3 > c.x_m-b.x_m"), "6: unknown name 'c.x_m'");
  EXPECT_EQ(problem_of("a.x_m b.x_m < 3"), "6: an operator is missing before 'b.x_m'");
  EXPECT_EQ(problem_of("2 a.x_m < 3"), "2: an operator is missing before 'a.x_m'");
  EXPECT_EQ(problem_of("a.x_m < 2 (3)"), "10: an operator is missing before '('");
  EXPECT_EQ(problem_of("a.x_m"), "5: the rule has no comparison; write one of < <= > >= == !=");
  EXPECT_EQ(problem_of("1 < a.x_m < 3"), "10: a rule has one comparison; write a second rule for '<'");
  EXPECT_EQ(problem_of("a.x_m <> 3"), "7: a number or a figure is missing before '>'");
  EXPECT_EQ(problem_of("a.x_m = 3"), "6: write '==' instead of '='");
  EXPECT_EQ(problem_of("a.x_m =< 3"), "6: write '<=' instead of '=<'");
  EXPECT_EQ(problem_of("a.x_m => 3"), "6: write '>=' instead of '=>'");
  EXPECT_EQ(problem_of("a.x_m <"), "7: a number or a figure is missing at the end of the rule");
  EXPECT_EQ(problem_of("a.x_m + < 3"), "8: a number or a figure is missing before '<'");
  EXPECT_EQ(problem_of("* a.x_m < 3"), "0: a number or a figure is missing before '*'");
  EXPECT_EQ(problem_of("(a.x_m < 3"), "7: a comparison cannot stand in parentheses, got '<'");
  EXPECT_EQ(problem_of("2 * (a.x_m"), "4: '(' is not closed");
  EXPECT_EQ(problem_of("a.x_m < 3)"), "9: ')' closes nothing");
  EXPECT_EQ(problem_of("() < 3"), "1: a number or a figure is missing before ')'");
  EXPECT_EQ(problem_of("a.x_m < 3 and b.x_m < 3"), "10: a rule has one comparison; write two rules instead of 'and'");
  EXPECT_EQ(problem_of("a.x_m < 3 && b.x_m < 3"), "10: a rule has one comparison; write two rules instead of '&'");
  EXPECT_EQ(problem_of("a.x_m ≤ 3"), "6: '≤' has no meaning here" + made_of);
  EXPECT_EQ(problem_of("a.x_m < $"), "8: '$' has no meaning here" + made_of);
  EXPECT_EQ(problem_of("a.x_m < 5m"), "8: '5m' is not a number");
  EXPECT_EQ(problem_of("a.x_m < 1,5"), "9: ',' has no meaning here" + made_of);
  EXPECT_EQ(problem_of("a.x_m < 1.2.3"), "8: '1.2.3' is not a number");
  EXPECT_EQ(problem_of("a.x_m < 0x10"), "8: '0x10' is not a number");
  EXPECT_EQ(problem_of("a.x_m < 1e999"), "8: '1e999' is outside the range of numbers");
  EXPECT_EQ(problem_of("a.x_m < nan"), "8: unknown name 'nan'");
  EXPECT_EQ(problem_of("a.x_m < inf"), "8: unknown name 'inf'");
  EXPECT_EQ(problem_of("1 < 2"), "0: the rule names no figure, so that no run can change its outcome");
  EXPECT_EQ(problem_of("min(a.x_m) < 2"), "0: unknown function 'min'");
  EXPECT_EQ(problem_of("max(a.x_m, b.x_m) < 2"), "9: 'max(...)' holds the name of one figure, got ','");
  EXPECT_EQ(problem_of("max(a.x_m + 1) < 2"), "10: 'max(...)' holds the name of one figure, got '+'");
  EXPECT_EQ(problem_of("max() < 2"), "4: the name of a figure must stand in 'max(...)', got ')'");
  EXPECT_EQ(problem_of("max(a.x_m"), "3: '(' is not closed");
  EXPECT_EQ(problem_of("max(a.y_m) < 2"), "6: unknown name 'a.y_m'");
}

TEST(RuleExpression, IsBoundedInLengthAndDepth) {
  const std::string deep(RuleExpression::max_depth - 1, '(');
  const std::string closed(RuleExpression::max_depth - 1, ')');
  EXPECT_EQ(problem_of(deep + "a.x_m" + closed + " < 3"), "none");
  EXPECT_EQ(problem_of("(" + deep + "a.x_m" + closed + ") < 3"), "32: the rule is nested more than 32 deep");
  EXPECT_EQ(problem_of(std::string(400, '-') + "a.x_m < 3"), "32: the rule is nested more than 32 deep");
  std::string longest = "a.x_m < 1";
  while (longest.size() + 4 <= RuleExpression::max_length) longest += " + 1";
  EXPECT_EQ(problem_of(longest), "none");
  EXPECT_EQ(problem_of(longest + " + 1"), "500: a rule has at most 500 characters");
}

TEST(RuleExpression, ReadsNumbersTheSameInEveryLanguage) {
  const test_support::CommaLocale comma;
  EXPECT_EQ(outcome_of("a.x_m < 0.25").right, 0.25);
}

// Worlds

}  // namespace
