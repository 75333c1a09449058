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

/// Entry of `metrics:`, which yields figures that score the run.
struct MetricConfig {
  std::string name;
  const MetricKind* kind = nullptr;            ///< null only after an error
  std::shared_ptr<const MetricParams> params;  ///< parameters of its type; null only after an error
  SourcePlace place;

  void read(ParamReader& in);
  /// Returns the names of its figures, `NAME.figure`, as used in pass rules and the summary.
  std::vector<std::string> figures() const;
};

/// Declares each metric by the word of its type, so that other metrics of the list may name it.  Must be called before
/// `metrics` is read.
void declare_metrics(ParamReader& in);
/// Returns what is wrong with the name `METRIC.FIGURE`, and at which character; none when it is valid.
std::optional<RuleProblem> figure_problem(const std::vector<MetricConfig>& metrics, const std::string& name);
/// Reads `pass:`, the list of pass rules of a world, which name figures of `metrics`.
void read_rules(ParamReader& in, std::vector<RuleExpression>& rules, const std::vector<MetricConfig>& metrics);
/// Checks metrics after the vehicles were loaded, such as for devices that do not exist.
void check_metrics(const WorldConfig& world, Diagnostics& diagnostics);

/// Describes `pass:`, a list of rules.
void describe_rules(ParamReader& in, const char* meaning, std::vector<std::string> examples);

/// Reads the value of `pass:`.
std::vector<RuleExpression> read_rule_list(const ConfigNode& list, const RuleNames& names, Diagnostics& diagnostics);

}  // namespace sim
