// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <functional>
#include <memory>
#include <string>

#include "experiment/score/metric.hpp"

namespace experiment {

/// Creates the metric of an entry of `metrics:`, whose type must be registered.
std::unique_ptr<Metric> make_metric(const MetricContext& context);

namespace detail {

using MetricMaker = std::function<std::unique_ptr<Metric>(const MetricContext&)>;

void add_metric(sim::MetricKind kind, MetricMaker maker);

template <typename Model>
bool add_metric(const char* word) {
  sim::MetricKind kind{.word = word, .meaning = Model::meaning, .figures = Model::figures(), .make_params = {}};
  kind.make_params = [] { return std::make_shared<typename Model::Params>(); };
  add_metric(std::move(kind), [](const MetricContext& context) -> std::unique_ptr<Metric> {
    return std::make_unique<Model>(context, static_cast<const typename Model::Params&>(*context.config.params));
  });
  return true;
}

}  // namespace detail

/// Registers a type of metric, in its own file.  Model is a Metric with `static constexpr const char* meaning`, a
/// `static std::vector<sim::FigureKind> figures()`, a `struct Params : sim::MetricParams` and a constructor from a
/// MetricContext and the Params.
#define SHOAL_METRIC(word, Model) \
  [[maybe_unused]] static const bool registered_##Model = ::experiment::detail::add_metric<Model>(word)

}  // namespace experiment
