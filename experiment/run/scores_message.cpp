// SPDX-License-Identifier: BSD-3-Clause
#include "experiment/run/scores_message.hpp"

namespace experiment {

void fill_scores(const Scoring& scoring, shoal::sim_scores_t& message) {
  message.figure.clear();
  message.value.clear();
  for (const auto& [name, value] : scoring.figures()) {
    message.figure.push_back(name);
    message.value.push_back(value);
  }
  message.count = static_cast<std::int32_t>(message.figure.size());
  // Rules with both sides of their comparison.
  message.rule.clear();
  message.holds.clear();
  message.left.clear();
  message.right.clear();
  for (const Scoring::Verdict& verdict : scoring.verdicts()) {
    message.rule.push_back(verdict.rule);
    message.holds.push_back(static_cast<std::int8_t>(verdict.passed));
    message.left.push_back(verdict.left);
    message.right.push_back(verdict.right);
  }
  message.rules = static_cast<std::int32_t>(message.rule.size());
}

}  // namespace experiment
