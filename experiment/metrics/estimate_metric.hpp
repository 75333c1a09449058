// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "experiment/metrics/scored_period.hpp"
#include "experiment/score/metric.hpp"

namespace experiment {

/// Compares estimates of a vehicle's position, shoal.pose_t or shoal.estimate_t on a channel, with the truth.  Its
/// subclasses compute figures from the errors.
class EstimateMetric : public Metric {
 public:
  struct Params final : ScoredPeriod {
    int dimensions = 2;  ///< of the error; 2: horizontal
    void read(sim::ParamReader& in) override;
  };

  EstimateMetric(const MetricContext& context, const Params& params);
  ~EstimateMetric() override;

  void after_step() override;
  std::string why_none(const std::string& figure) const override;
  const std::vector<ErrorSample>* samples() const override { return &samples_; }
  int dimensions() const override { return params_.dimensions; }
  std::int64_t bad_messages() const override { return bad_messages_; }
  void visit_state(sim::StateArchive& archive, History history) override;

 protected:
  struct Estimate {
    std::int64_t utime = 0;
    sim::Vector3d position_m = sim::Vector3d::Zero();
    std::optional<Eigen::Matrix3d> covariance_m2;
  };

  /// Throws std::runtime_error when the metric cannot use the estimate.
  virtual void check(const Estimate& /*estimate*/) const {}
  /// Returns the normalized estimation error squared (Bar-Shalom, Li and Kirubarajan 2001); NaN without a valid
  /// covariance.
  double nees(const Estimate& estimate, const sim::Vector3d& error) const;
  const Params& params() const { return params_; }
  /// Returns the longest time between two estimates, before the first or since the last.
  double max_gap_s() const;

 private:
  /// Estimate with a time in the future.
  struct Early {
    sim::Time time{0};
    Estimate estimate;
    void visit_state(sim::StateArchive& archive) {
      archive(time, estimate.utime, estimate.position_m, estimate.covariance_m2);
    }
  };

  static Estimate decode(const sim::Bytes& payload);
  /// Looks the vehicle up at every use, because a restored world may have built it again.
  const sim::Vehicle& vehicle() const { return *world_.find_vehicle(params_.vehicle); }
  /// Warns of an error once.
  void warn_once(const std::string& channel, const std::string& what);
  void report_sample_count();
  void warn(const std::string& text);
  void take(const Estimate& estimate);
  /// Returns false when the truth at that time is not known yet.
  bool compare(sim::Time time, const Estimate& estimate);

  const Params& params_;
  const sim::World& world_;
  const TruthHistory& truth_;
  std::unique_ptr<sim::Mailbox> mailbox_;
  std::vector<Early> early_;
  std::vector<ErrorSample> samples_;
  std::optional<double> begun_s_;  ///< simulated time of the subscription
  std::int64_t bad_messages_ = 0;
  std::string warning_text_;  ///< the last warning
  std::int64_t ignored_ = 0;  ///< consecutive messages that were ignored
  int warnings_ = 0;
};

}  // namespace experiment
