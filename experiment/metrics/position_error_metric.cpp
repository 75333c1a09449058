// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <cmath>

#include "experiment/metrics/estimate_metric.hpp"
#include "experiment/score/metric_registry.hpp"

namespace experiment {

namespace {

/// Distance between an estimate on a channel and the truth.
class PositionErrorMetric final : public EstimateMetric {
 public:
  static constexpr const char* meaning =
      "distance between the estimates on a channel and the true position of a vehicle";
  static std::vector<sim::FigureKind> figures() {
    return {
        {"rms_m", "m", "root mean square of the position errors"},
        {"final_m", "m", "position error of the last estimate"},
        {"max_m", "m", "largest position error"},
        {"per_distance_percent", "%", "last error over the distance traveled until then, when that is at least 1 m"},
        {"max_gap_s", "s", "longest time without an estimate, from `from_s` to `until_s` or the end"},
        {"samples", "estimates", "estimates that were compared with the truth", true}};
  }
  using EstimateMetric::EstimateMetric;

  void add_figures(Figures& figures) const override {
    double squares = 0;
    double largest = 0;
    for (const ErrorSample& sample : *samples()) {
      squares += sample.error_m * sample.error_m;
      largest = std::max(largest, sample.error_m);
    }
    const bool any = !samples()->empty();
    const auto count = static_cast<double>(samples()->size());
    const double distance_m = any ? samples()->back().travelled_m : 0;
    add(figures, "rms_m", any ? std::sqrt(squares / count) : no_figure);
    add(figures, "final_m", any ? samples()->back().error_m : no_figure);
    add(figures, "max_m", any ? largest : no_figure);
    add(figures, "max_gap_s", max_gap_s());
    // Over a shorter distance the ratio says nothing.
    add(figures, "per_distance_percent",
        distance_m >= min_distance_m ? 100 * samples()->back().error_m / distance_m : no_figure);
    add(figures, "samples", count);
  }
};

SHOAL_METRIC("position_error", PositionErrorMetric);

}  // namespace

}  // namespace experiment
