// SPDX-License-Identifier: BSD-3-Clause
#include <spdlog/fmt/fmt.h>

#include <algorithm>
#include <cmath>

#include "experiment/metrics/estimate_metric.hpp"
#include "experiment/score/metric_registry.hpp"
#include "sim/world_file/world_config.hpp"

namespace experiment {

namespace {

/// Rms error of an estimate over the bound of its vehicle.
class BoundRatioMetric final : public Metric {
 public:
  static constexpr const char* meaning = "how near an estimate comes to the reference for its error";
  static std::vector<sim::FigureKind> figures() {
    return {{"ratio", "1", "rms_m of `metric` over rms_m of `bound`; 1: as good as the reference"}};
  }
  struct Params final : sim::MetricParams {
    std::string metric, bound;
    void read(sim::ParamReader& in) override {
      in.require("metric");
      read_known_name(in, "metric", metric, "position_error", "the error of the estimate");
      in.require("bound");
      read_known_name(in, "bound", bound, "bound", "the reference");
    }
    void check(const sim::MetricConfig& config, const sim::WorldConfig& world,
               sim::Diagnostics& diagnostics) const override;
  };

  BoundRatioMetric(const MetricContext& context, const Params& params) : Metric(context), params_(params) {}

  bool needs_others() const override { return true; }
  void add_figures(Figures& figures) const override {
    const double bound_m = figures.at(params_.bound + ".rms_m");
    add(figures, "ratio", bound_m > 0 ? figures.at(params_.metric + ".rms_m") / bound_m : no_figure);
  }
  std::string why_none(const std::string&) const override {
    return "the error '" + params_.metric + "' or the bound '" + params_.bound + "' is not known";
  }
  // No state: the other two metrics have it.
  void visit_state(sim::StateArchive&, History) override {}

 private:
  const Params& params_;
};

/// A ratio needs errors of the same position at the same times.
void BoundRatioMetric::Params::check(const sim::MetricConfig& config, const sim::WorldConfig& world,
                                     sim::Diagnostics& diagnostics) const {
  const auto params_of = [&](const std::string& name) -> const sim::MetricParams* {
    const auto found = std::find_if(world.metrics.begin(), world.metrics.end(),
                                    [&](const sim::MetricConfig& each) { return each.name == name; });
    return found == world.metrics.end() ? nullptr : found->params.get();
  };
  const auto* error = dynamic_cast<const EstimateMetric::Params*>(params_of(metric));
  const sim::MetricParams* limit = params_of(bound);
  if (error == nullptr || limit == nullptr) return;
  const auto refuse = [&](const std::string& text) {
    diagnostics.error(config.place, "metric '" + config.name + "'", text);
  };
  if (error->vehicle != limit->vehicle)
    refuse(fmt::format("'{}' and '{}' must be of the same vehicle, got '{}' and '{}'", metric, bound, error->vehicle,
                       limit->vehicle));
  if (error->from_s != limit->from_s)
    refuse(fmt::format("'{}' and '{}' must have the same 'from_s', got {:.6g} and {:.6g}", metric, bound, error->from_s,
                       limit->from_s));
  if (std::isfinite(error->until_s))
    refuse(fmt::format("'{}' must not have 'until_s', got {:.6g}: the bound covers the whole run", metric,
                       error->until_s));
  if (error->dimensions != 2) refuse(fmt::format("'{}' must have 2 dimensions: the bound is horizontal", metric));
}

SHOAL_METRIC("bound_ratio", BoundRatioMetric);

}  // namespace

}  // namespace experiment
