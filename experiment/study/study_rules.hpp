// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "sim/config/config_node.hpp"
#include "sim/world_file/load_world.hpp"
#include "sim/world_file/rule_expression.hpp"

namespace experiment {

struct StudyCase;

/// Figure of a run that is 1 when the rules of its world hold, and 0 when they do not.
inline constexpr const char* passed_figure = "passed";

/// Statistics over the seeds of a case that the rules of studies use.
const std::vector<std::string>& statistic_words();

/// Vocabulary of the rules of a study: `STATISTIC(CASE.METRIC.FIGURE)` and `STATISTIC(CASE.passed)`.
class StudyRuleNames final : public sim::RuleNames {
 public:
  /// `worlds` by case; without them any metric and figure is accepted.  `algorithm_figures`: LABEL.FIGURE, in all
  /// cases.
  explicit StudyRuleNames(const std::vector<StudyCase>& cases, const std::vector<sim::LoadedWorld>& worlds = {},
                          std::vector<std::string> algorithm_figures = {});
  std::string function_problem(const std::string& function) const override;
  std::optional<sim::RuleProblem> name_problem(const std::string& function, const std::string& name) const override;

 private:
  std::vector<std::string> cases_;
  std::vector<const std::vector<sim::MetricConfig>*> metrics_;  ///< by case
  std::vector<std::string> algorithm_figures_;
};

/// Splits `CASE.FIGURE` into case and figure.
std::pair<std::string, std::string> case_and_figure(const std::string& name);

}  // namespace experiment
