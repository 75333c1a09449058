// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "sim/config/config_node.hpp"
#include "sim/world_file/load_world.hpp"
#include "sim/world_file/rule_expression.hpp"

namespace tools {

struct StudyCase;

/// The figure of a run that is 1 when it held the rules of its world, and 0 when it did not.
inline constexpr const char* passed_figure = "passed";

/// Statistics over the seeds of a case, which the rules of studies take of its figures.
const std::vector<std::string>& statistic_words();

/// Rules of a study name `STATISTIC(CASE.METRIC.FIGURE)` and `STATISTIC(CASE.passed)`.
class StudyRuleNames final : public sim::RuleNames {
 public:
  /// `worlds` by case; without them any metric and figure is taken.
  explicit StudyRuleNames(const std::vector<StudyCase>& cases, const std::vector<sim::LoadedWorld>& worlds = {});
  std::string function_problem(const std::string& function) const override;
  std::optional<sim::RuleProblem> name_problem(const std::string& function, const std::string& name) const override;

 private:
  std::vector<std::string> cases_;
  std::vector<const std::vector<sim::MetricConfig>*> metrics_;  ///< by case
};

/// The case and the figure of `CASE.FIGURE`.
std::pair<std::string, std::string> case_and_figure(const std::string& name);

/// As sim::rule_of_map: the rule that `{case: a, figure: e.rms_m, statistic: max, below: 2}` becomes,
/// `max(a.e.rms_m) < 2`.
std::optional<std::string> study_rule_of_map(const sim::ConfigNode& map);

}  // namespace tools
