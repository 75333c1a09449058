// SPDX-License-Identifier: BSD-3-Clause
#include <cmath>
#include <vector>

#include "sim/config/config_node.hpp"
#include "sim/world_file/rule_expression.hpp"
#include "tests/fuzz/fuzz_input.hpp"

namespace {

/// Knows every name that begins with a letter from a to m, so that both outcomes are met.
class HalfOfTheNames final : public sim::RuleNames {
 public:
  std::string function_problem(const std::string& function) const override {
    return function == "max" || function == "mean" ? "" : "unknown";
  }
  std::optional<sim::RuleProblem> name_problem(const std::string& /*function*/,
                                               const std::string& name) const override {
    if (name.front() < 'n' && name.find('.') != std::string::npos) return std::nullopt;
    return sim::RuleProblem{name.size() - 1, "unknown"};
  }
};

}  // namespace

SHOAL_FUZZ_TARGET(rule) {
  const std::string_view text = fuzz::text_of(input);
  sim::RuleProblem problem;
  const auto rule = sim::RuleExpression::parse(text, HalfOfTheNames(), problem);
  if (!rule) {
    fuzz::require(!problem.text.empty(), "a refused rule has a reason");
    fuzz::require(problem.at <= text.size(), "the place of a mistake lies in the text");
  } else {
    fuzz::require(rule->text() == text, "a rule keeps its text");
    fuzz::require(!rule->figures().empty(), "a rule names a figure");
    std::vector<double> values(rule->figures().size(), 1.5);
    rule->evaluate(values);
    values.front() = std::nan("");
    fuzz::require(!rule->evaluate(values).holds, "no rule holds for a figure that does not exist");
  }
}
