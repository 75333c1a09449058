// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <functional>
#include <optional>
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

/// Outcome of the rules of a run or a study.  A run that was not judged has not passed.
enum class Judgement { passed, failed, not_judged };

/// Returns the readable form: `passed`, `FAILED` or `not judged`.
inline const char* judgement_word(Judgement judgement) {
  if (judgement == Judgement::not_judged) return "not judged";
  return judgement == Judgement::passed ? "passed" : "FAILED";
}

inline Judgement judgement_of(bool passed) {
  return passed ? Judgement::passed : Judgement::failed;
}

/// Returns the value of `passed` in JSON files: nothing, written as null, where nothing was judged.
inline std::optional<bool> as_flag(Judgement judgement) {
  if (judgement == Judgement::not_judged) return std::nullopt;
  return judgement == Judgement::passed;
}

}  // namespace experiment
