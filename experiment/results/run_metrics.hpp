// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "experiment/results/run_record.hpp"
#include "sim/world_file/metric_registry.hpp"

namespace experiment {

/// Figures of one metric of a run.
struct RunMetric {
  struct Figure {
    std::string name;                       ///< `rms_m`
    std::optional<double> value;            ///< unset: there was no data to compute it from
    const sim::FigureKind* kind = nullptr;  ///< null: the figure is unknown to this version
  };

  std::string name;
  const sim::MetricKind* kind = nullptr;  ///< null: this version has no metric with such figures
  std::string vehicle, channel;           ///< as in the world; empty: unset, or the world is unknown
  int dimensions = 0;                     ///< of an error; 0: unknown
  std::vector<Figure> figures;            ///< the most important one first

  /// Returns the value; std::nullopt also if the metric has no such figure.
  std::optional<double> value(const std::string& figure) const;
};

/// Returns the figures of a run by metric.  The type of a metric follows from its figures.  Vehicles, channels and the
/// order are those of world.yaml in the run's folder; without a usable one they are empty, and the order is by name.
std::vector<RunMetric> metrics_of(const RunRecord& run);

/// Returns the names of figures (`NAME.figure`) by metric, without values, in order of name.
std::vector<RunMetric> metrics_named(const std::vector<std::string>& figures);

/// Returns the units of figures (`NAME.figure`) that have one and whose metric is known.  `figures`: all of the runs,
/// which tell the type of a metric.
std::map<std::string, std::string> units_of(const std::vector<std::string>& figures);

/// Formats a value: as a whole number from 1000 on, else with four digits; `none` when there is none.
std::string figure_text(const std::optional<double>& value);
/// Returns the same with its unit: `0.91 m`.
std::string figure_with_unit(const RunMetric::Figure& figure);

}  // namespace experiment
