// SPDX-License-Identifier: BSD-3-Clause
#include "experiment/study/study_rules.hpp"

#include <algorithm>
#include <string_view>

#include "experiment/study/study_config.hpp"
#include "sim/config/message_text.hpp"

namespace experiment {

const std::vector<std::string>& statistic_words() {
  static const std::vector<std::string> words{"mean", "std", "min", "max", "median"};
  return words;
}

std::pair<std::string, std::string> case_and_figure(const std::string& name) {
  const std::size_t dot = std::min(name.find('.'), name.size());
  return {name.substr(0, dot), dot < name.size() ? name.substr(dot + 1) : ""};
}

StudyRuleNames::StudyRuleNames(const std::vector<StudyCase>& cases, const std::vector<sim::LoadedWorld>& worlds,
                               std::vector<std::string> algorithm_figures)
    : algorithm_figures_(std::move(algorithm_figures)) {
  for (const StudyCase& each : cases) cases_.push_back(each.name);
  for (const sim::LoadedWorld& world : worlds) metrics_.push_back(&world.config.metrics);
}

std::string StudyRuleNames::function_problem(const std::string& function) const {
  const std::vector<std::string>& words = statistic_words();
  if (std::find(words.begin(), words.end(), function) != words.end()) return {};
  return "unknown statistic '" + sim::shortened(function) + "'; known statistics: " + sim::list_text(words) +
         sim::did_you_mean(function, words);
}

std::optional<sim::RuleProblem> StudyRuleNames::name_problem(const std::string& function,
                                                             const std::string& name) const {
  const auto [in_case, figure] = case_and_figure(name);
  const auto found = std::find(cases_.begin(), cases_.end(), in_case);
  if (function.empty()) {
    const std::string whole = found != cases_.end() && !figure.empty() ? name : cases_.front() + "." + name;
    if (name.find('.') == std::string::npos && name != passed_figure)
      return sim::RuleProblem{0, "'" + sim::shortened(name) + "' is neither a number nor a statistic, " +
                                     "STATISTIC(CASE.METRIC.FIGURE); statistics: " + sim::list_text(statistic_words())};
    return sim::RuleProblem{0, "a rule of a study needs a statistic over the seeds, such as 'mean(" +
                                   sim::shortened(whole) + ")'; statistics: " + sim::list_text(statistic_words())};
  }
  if (found == cases_.end())
    return sim::RuleProblem{0, "unknown case '" + sim::shortened(in_case) +
                                   "'; known cases: " + sim::list_text(cases_) + sim::did_you_mean(in_case, cases_)};
  if (figure.empty())
    return sim::RuleProblem{0, "case '" + in_case + "' needs one of its figures, such as " + in_case + ".passed"};
  const bool of_algorithm =
      std::find(algorithm_figures_.begin(), algorithm_figures_.end(), figure) != algorithm_figures_.end();
  if (figure == passed_figure || of_algorithm) return std::nullopt;
  const std::size_t begin = in_case.size() + 1;
  const auto index = static_cast<std::size_t>(found - cases_.begin());
  if (index >= metrics_.size()) return std::nullopt;
  auto problem = sim::figure_problem(*metrics_[index], figure);
  if (problem) problem->at += begin;
  return problem;
}

}  // namespace experiment
