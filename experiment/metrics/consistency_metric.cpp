// SPDX-License-Identifier: BSD-3-Clause
#include <cmath>
#include <stdexcept>

#include "experiment/metrics/estimate_metric.hpp"
#include "experiment/score/metric_registry.hpp"

namespace experiment {

namespace {

/// Consistency of an estimate: whether its covariance matches its errors.
class ConsistencyMetric final : public EstimateMetric {
 public:
  static constexpr const char* meaning = "whether the covariance of the estimates matches their errors";
  static std::vector<sim::FigureKind> figures() {
    return {{"nees_mean", "1", "mean normalized estimation error squared; the number of dimensions when consistent"},
            {"inside_95_share", "1", "share of the errors within their own 95 % bound; 0.95 when consistent"},
            {"samples", "estimates", "estimates that were compared with the truth", true}};
  }
  using EstimateMetric::EstimateMetric;

  void add_figures(Figures& figures) const override {
    const double bound = chi_square_95(dimensions());
    double sum = 0;
    double inside = 0;
    for (const ErrorSample& sample : *samples()) {
      sum += sample.nees;
      inside += sample.nees <= bound ? 1 : 0;
    }
    const auto count = static_cast<double>(samples()->size());
    add(figures, "nees_mean", count > 0 ? sum / count : no_figure);
    add(figures, "inside_95_share", count > 0 ? inside / count : no_figure);
    add(figures, "samples", count);
  }

 private:
  void check(const Estimate& estimate) const override {
    if (!estimate.covariance_m2) throw std::runtime_error("it has no covariance: a shoal.estimate_t is needed");
    if (!std::isfinite(nees(estimate, sim::Vector3d::Zero())))
      throw std::runtime_error("'covariance_m2' must be symmetric and positive definite");
  }
};

SHOAL_METRIC("consistency", ConsistencyMetric);

}  // namespace

}  // namespace experiment
