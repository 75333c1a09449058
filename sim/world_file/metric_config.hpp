// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "sim/config/param_reader.hpp"
#include "sim/world_file/metric_registry.hpp"

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

/// The run passes when every rule holds.
struct PassRule {
  std::string metric;  ///< such as `cooperative.rms_m`
  std::optional<double> below, above, equals;
  std::string below_metric, above_metric;  ///< another figure, times `factor`
  double factor = 1;
  void read(ParamReader& in);
};

/// Makes each metric known by the word of its type, so that other metrics of the list may name it.  Call before
/// `metrics` is read.
void declare_metrics(ParamReader& in);
/// Makes the figures known that pass rules may name.
void declare_figures(ParamReader& in, const std::vector<MetricConfig>& metrics);
/// What is wrong with metrics when the vehicles are known, such as devices that are not there.
void check_metrics(const WorldConfig& world, Diagnostics& diagnostics);

}  // namespace sim
