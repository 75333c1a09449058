// SPDX-License-Identifier: BSD-3-Clause
#include "experiment/score/metric_registry.hpp"

#include <map>
#include <utility>

namespace experiment {

namespace {

std::map<std::string, detail::MetricMaker>& metric_makers() {
  static std::map<std::string, detail::MetricMaker> makers;
  return makers;
}

}  // namespace

void detail::add_metric(sim::MetricKind kind, MetricMaker maker) {
  sim::MetricRegistry::instance().add(kind);
  metric_makers().emplace(std::move(kind.word), std::move(maker));
}

std::unique_ptr<Metric> make_metric(const MetricContext& context) {
  return metric_makers().at(context.config.kind->word)(context);
}

}  // namespace experiment
