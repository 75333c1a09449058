// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <functional>
#include <string>

#include "experiment/score/metric.hpp"
#include "sim/world_file/rule_expression.hpp"

namespace experiment {

/// Rule and its outcome.
struct RuleVerdict {
  std::string rule;  ///< as written in the file
  bool passed = false;
  std::string result = {};    ///< values of the two sides, or why there are none; empty: `rule` is sufficient
  double left = no_figure;    ///< value of the left side
  double right = no_figure;   ///< value of the right side
  double margin = no_figure;  ///< distance to the limit; NaN for == and !=

  /// Returns `RULE (RESULT)`.
  std::string text() const;
};

/// Value of a figure; NaN with the reason when there is none.
struct FigureValue {
  double value = no_figure;
  std::string why_none;
};

/// Judges a rule.  A figure that is NaN fails it, and the result contains the reason.
RuleVerdict judge_rule(const sim::RuleExpression& rule,
                       const std::function<FigureValue(const sim::RuleExpression::Figure&)>& value_of);

}  // namespace experiment
