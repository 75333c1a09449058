// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <spdlog/fmt/fmt.h>

#include <functional>
#include <limits>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "sim/state/state_archive.hpp"
#include "sim/world/world.hpp"
#include "tools/experiment/score/truth_history.hpp"

namespace tools {

/// Figures by name, `NAME.figure`.  NaN: there was nothing to make it of.
using Figures = std::map<std::string, double>;

inline constexpr double no_figure = std::numeric_limits<double>::quiet_NaN();

/// Errors are compared with the way travelled when that is at least so long: what stands may creep.
inline constexpr double min_distance_m = 1;

/// One estimate beside the truth at the estimate's own time.
struct ErrorSample {
  double time_s = 0;
  double error_m = 0;
  sim::Vector3d truth_m = sim::Vector3d::Zero();
  sim::Vector3d estimate_m = sim::Vector3d::Zero();
  double travelled_m = 0;      ///< way of the truth from the start
  double sigma_m = no_figure;  ///< rms error that the covariance of the estimate tells; NaN: it has none
  double nees = no_figure;     ///< normalised estimation error squared; NaN without a covariance
  void visit_state(sim::StateArchive& archive) {
    archive(time_s, error_m, truth_m, estimate_m, travelled_m, sigma_m, nees);
  }
};

/// How much of what grows with a run is saved.
enum class History {
  whole,
  length,  ///< for the same metrics, later: what came after is cut off again
};

/// What a metric looks at.
struct MetricContext {
  const sim::MetricConfig& config;
  sim::World& world;
  /// The truth of a vehicle by its name; outlives the metric.
  std::function<const TruthHistory&(const std::string&)> truth_of;
};

/// One entry of `metrics:` while the run goes.
class Metric {
 public:
  explicit Metric(const MetricContext& context) : config_(context.config) {}
  virtual ~Metric() = default;
  Metric(const Metric&) = delete;
  Metric& operator=(const Metric&) = delete;

  virtual void after_step() {}
  /// Adds the figures that `config().figures()` names.  Those of metrics that look at no other are there already.
  virtual void add_figures(Figures& figures) const = 0;
  /// It looks at figures of other metrics.
  virtual bool needs_others() const { return false; }
  /// Null when it compares no estimates.
  virtual const std::vector<ErrorSample>* samples() const { return nullptr; }
  /// Of the errors of these samples.
  virtual int dimensions() const { return 0; }
  virtual std::int64_t bad_messages() const { return 0; }
  /// Why a figure is NaN, in a few words for the rule that fails by it.  `figure`: without the name of the metric.
  virtual std::string why_none(const std::string& figure) const = 0;
  /// Names every member that is state, so that the metric goes back with the world; a metric without state says so.
  /// Messages that it has not read yet is thrown away when restoring.
  virtual void visit_state(sim::StateArchive& archive, History history) = 0;
  const sim::MetricConfig& config() const { return config_; }

 protected:
  static void empty(sim::Mailbox& mailbox) {
    while (mailbox.take()) {
    }
  }
  /// For reasons: ` from 120 s on`; empty when the metric counts from the start.
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

/// The chi-square value below which `dimensions` (2 or 3) squared normal errors lie in 95 of 100 cases.
double chi_square_95(int dimensions);

}  // namespace tools
