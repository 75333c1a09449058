// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "sim/config/param_reader.hpp"
#include "sim/world_file/metric_registry.hpp"
#include "sim/world_file/rule_expression.hpp"

namespace sim {

struct WorldConfig;

/// One entry of `metrics:`; gives figures that score the run.
struct MetricConfig {
  std::string name;
  const MetricKind* kind = nullptr;            ///< null only after an error
  std::shared_ptr<const MetricParams> params;  ///< of its type; null only after an error
  SourcePlace place;

  void read(ParamReader& in);
  /// Names of its figures, `NAME.figure`, as pass rules and the summary call them.
  std::vector<std::string> figures() const;
};

/// Makes each metric known by the word of its type, so that other metrics of the list may name it.  Call before
/// `metrics` is read.
void declare_metrics(ParamReader& in);
/// What is wrong with `METRIC.FIGURE` where these metrics are known, and at which of its characters.
std::optional<RuleProblem> figure_problem(const std::vector<MetricConfig>& metrics, const std::string& name);
/// Reads `pass:`, the list of rules of a world, which name figures of `metrics`.
void read_rules(ParamReader& in, std::vector<RuleExpression>& rules, const std::vector<MetricConfig>& metrics);
/// What is wrong with metrics when the vehicles are known, such as devices that do not exist.
void check_metrics(const WorldConfig& world, Diagnostics& diagnostics);

}  // namespace sim
