// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <functional>
#include <string>

#include "sim/world_file/rule_expression.hpp"
#include "tools/experiment/score/metric.hpp"

namespace tools {

/// A rule and its outcome.
struct RuleVerdict {
  std::string rule;  ///< as it was written
  bool passed = false;
  std::string result = {};    ///< what the two sides came to, or why there is none; empty: `rule` says all
  double left = no_figure;    ///< value of the left side
  double right = no_figure;   ///< value of the right side
  double margin = no_figure;  ///< distance to the limit; NaN for == and !=

  /// `RULE (RESULT)`.
  std::string text() const;
};

/// The value of a figure; NaN with the reason: there is none.
struct FigureValue {
  double value = no_figure;
  std::string why_none;
};

/// Judges a rule.  A figure that is NaN fails it, and the result says why there is none.
RuleVerdict judge_rule(const sim::RuleExpression& rule,
                       const std::function<FigureValue(const sim::RuleExpression::Figure&)>& value_of);

}  // namespace tools
