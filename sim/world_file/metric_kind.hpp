// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <set>
#include <string>
#include <vector>

#include "sim/world_file/metric_config.hpp"

namespace sim {

/// One figure that a type of metric gives.
struct FigureKind {
  std::string name;     ///< such as `rms_m`
  std::string unit;     ///< such as `m`, `packets`; `1` for a ratio
  std::string meaning;  ///< one line
  bool is_count = false;
};

/// What a type of metric needs, takes and gives.
struct MetricKind {
  std::string word;     ///< of `type:`
  std::string meaning;  ///< one line
  MetricType type;
  std::vector<std::string> required, optional;  ///< keys beside `name` and `type`
  std::vector<FigureKind> figures;              ///< the most important one first

  /// Null when it has no figure of this name.
  const FigureKind* find(const std::string& figure) const;
};

/// One for each MetricType, in its order.
const std::vector<MetricKind>& metric_kinds();
const MetricKind& metric_kind(MetricType type);

/// The type that gives just these figures; null: none does.
const MetricKind* metric_kind_of_figures(const std::set<std::string>& figures);

}  // namespace sim
