// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <spdlog/fmt/fmt.h>

#include <cmath>
#include <functional>
#include <limits>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "experiment/score/truth_history.hpp"
#include "sim/state/state_archive.hpp"
#include "sim/world/world.hpp"

namespace experiment {

/// Figures by name, `NAME.figure`.  NaN: there was no data to compute it from.
using Figures = std::map<std::string, double>;

inline constexpr double no_figure = std::numeric_limits<double>::quiet_NaN();

/// Errors are divided by the distance traveled from this distance on, because a vehicle at rest may creep.
inline constexpr double min_distance_m = 1;

/// Estimate and truth at the estimate's own time.
struct ErrorSample {
  double time_s = 0;
  double error_m = 0;
  sim::Vector3d truth_m = sim::Vector3d::Zero();
  sim::Vector3d estimate_m = sim::Vector3d::Zero();
  double travelled_m = 0;      ///< distance traveled by the true position from the start
  double sigma_m = no_figure;  ///< rms error predicted by the covariance of the estimate; NaN: no covariance
  double nees = no_figure;     ///< normalized estimation error squared; NaN without a covariance
  void visit_state(sim::StateArchive& archive) {
    archive(time_s, error_m, truth_m, estimate_m, travelled_m, sigma_m, nees);
  }
};

/// Extent to which data that grows with a run is saved.
enum class History {
  whole,
  length,  ///< for the same metrics, later: what came after is cut off again
};

/// Inputs of a metric.
struct MetricContext {
  const sim::MetricConfig& config;
  sim::World& world;
  /// Truth of a vehicle by its name; outlives the metric.
  std::function<const TruthHistory&(const std::string&)> truth_of;
};

/// Entry of `metrics:` during the run.
class Metric {
 public:
  explicit Metric(const MetricContext& context) : config_(context.config) {}
  virtual ~Metric() = default;
  Metric(const Metric&) = delete;
  Metric& operator=(const Metric&) = delete;

  virtual void after_step() {}
  /// Adds the figures named by `config().figures()`.  Figures of metrics that depend on no other are already present.
  virtual void add_figures(Figures& figures) const = 0;
  /// Returns whether it uses figures of other metrics.
  virtual bool needs_others() const { return false; }
  /// Returns null when the metric compares no estimates.
  virtual const std::vector<ErrorSample>* samples() const { return nullptr; }
  /// Dimensions of the errors of these samples.
  virtual int dimensions() const { return 0; }
  virtual std::int64_t bad_messages() const { return 0; }
  /// Returns why a figure is NaN, in a few words for the rule that fails because of it.  `figure`: without the name of
  /// the metric.
  virtual std::string why_none(const std::string& figure) const = 0;
  /// Visits every member that is state, so that the metric is restored with the world; a metric without state visits
  /// nothing.  Messages that it has not read yet are discarded when restoring.
  virtual void visit_state(sim::StateArchive& archive, History history) = 0;
  const sim::MetricConfig& config() const { return config_; }

 protected:
  static void empty(sim::Mailbox& mailbox) {
    while (mailbox.take()) {
    }
  }
  /// Returns a phrase for error messages, ` from 120 s on`; empty when the metric counts from the start.
  std::string since_from_s() const {
    const double from_s = config_.params->from_s;
    return from_s > 0 ? fmt::format(" from {:.6g} s on", from_s) : "";
  }
  void add(Figures& figures, const std::string& figure, double value) const {
    figures[config_.name + "." + figure] = value;
  }

 private:
  const sim::MetricConfig& config_;
};

/// Returns the 95 % quantile of the chi-square distribution with `dimensions` (2 or 3) degrees of freedom.
inline double chi_square_95(int dimensions) {
  // Quantile tables of the chi-square distribution; with 2 degrees of freedom it is -2 ln 0.05.
  return dimensions == 2 ? -2 * std::log(0.05) : 7.814727903251179;
}

}  // namespace experiment
