// SPDX-License-Identifier: BSD-3-Clause
#include "experiment/score/rule_verdict.hpp"

#include <spdlog/fmt/fmt.h>

#include <cmath>
#include <vector>

namespace experiment {

std::string RuleVerdict::text() const {
  return result.empty() ? rule : rule + " (" + result + ")";
}

RuleVerdict judge_rule(const sim::RuleExpression& rule,
                       const std::function<FigureValue(const sim::RuleExpression::Figure&)>& value_of) {
  std::vector<double> values;
  std::string missing;
  for (const sim::RuleExpression::Figure& figure : rule.figures()) {
    const FigureValue found = value_of(figure);
    values.push_back(found.value);
    if (std::isnan(found.value))
      missing += fmt::format("{}{} is none: {}", missing.empty() ? "" : "; ", figure.text(), found.why_none);
  }
  const sim::RuleExpression::Outcome outcome = rule.evaluate(values);
  RuleVerdict verdict{rule.text(), outcome.holds};
  verdict.left = outcome.left;
  verdict.right = outcome.right;
  verdict.margin = outcome.margin;
  if (!missing.empty())
    verdict.result = missing;
  else if (!std::isfinite(outcome.left) || !std::isfinite(outcome.right))
    verdict.result = fmt::format("the {} side is not finite", std::isfinite(outcome.left) ? "right" : "left");
  else
    verdict.result = fmt::format("left {:.6g}, right {:.6g}", outcome.left, outcome.right) +
                     (std::isnan(outcome.margin) ? "" : fmt::format(", margin {:.6g}", outcome.margin));
  return verdict;
}

}  // namespace experiment
