// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "sim/world_file/metric_registry.hpp"
#include "tools/experiment/results/run_record.hpp"

namespace tools {

/// The figures of one metric of a run.
struct RunMetric {
  struct Figure {
    std::string name;                       ///< `rms_m`
    std::optional<double> value;            ///< unset: there was nothing to compute it from
    const sim::FigureKind* kind = nullptr;  ///< null: this version does not know the figure
  };

  std::string name;
  const sim::MetricKind* kind = nullptr;  ///< null: this version knows no metric of such figures
  std::string vehicle, channel;           ///< as in the world; empty: unset, or the world is unknown
  int dimensions = 0;                     ///< of an error; 0: not known
  std::vector<Figure> figures;            ///< the most important one first

  /// Unset as well when the metric has no such figure.
  std::optional<double> value(const std::string& figure) const;
};

/// The figures of a run by metric.  The type of a metric follows from its figures.  Vehicles, channels and the order
/// are those of world.yaml in the run's folder; without a usable one they are empty, and the order is by name.
std::vector<RunMetric> metrics_of(const RunRecord& run);

/// The names of figures (`NAME.figure`) by metric, without values, in order of name.
std::vector<RunMetric> metrics_named(const std::vector<std::string>& figures);

/// A value for people: whole from 1000 on, else four digits; `none` when there is none.
std::string figure_text(const std::optional<double>& value);
/// The same with its unit: `0.91 m`.
std::string figure_with_unit(const RunMetric::Figure& figure);

}  // namespace tools
