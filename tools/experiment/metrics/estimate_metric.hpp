// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "tools/experiment/score/metric.hpp"

namespace tools {

/// Compares estimates of a vehicle's position, shoal.pose_t or shoal.estimate_t on a channel, with the truth.  Of what
/// it finds its subclasses make figures.
class EstimateMetric : public Metric {
 public:
  struct Params final : sim::MetricParams {
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

  /// Throws std::runtime_error when the metric cannot use it.
  virtual void check(const Estimate& /*estimate*/) const {}
  /// Normalised estimation error squared; NaN without a covariance, or with none that can be one.
  double nees(const Estimate& estimate, const sim::Vector3d& error) const;
  const Params& params() const { return params_; }
  /// Between two estimates, before the first or since the last.
  double max_gap_s() const;

 private:
  /// An estimate with a time in the future.
  struct Early {
    sim::Time time{0};
    Estimate estimate;
    void visit_state(sim::StateArchive& archive) {
      archive(time, estimate.utime, estimate.position_m, estimate.covariance_m2);
    }
  };

  static Estimate decode(const sim::Bytes& payload);
  /// A restored world may have built it again.
  const sim::Vehicle& vehicle() const { return *world_.find_vehicle(params_.vehicle); }
  /// Warns of an error once.
  void warn_once(const std::string& channel, const std::string& what);
  void report_sample_count();
  void warn(const std::string& text);
  void take(const Estimate& estimate);
  /// False when the truth at that time is not known yet.
  bool compare(sim::Time time, const Estimate& estimate);

  const Params& params_;
  const sim::World& world_;
  const TruthHistory& truth_;
  std::unique_ptr<sim::Mailbox> mailbox_;
  std::vector<Early> early_;
  std::vector<ErrorSample> samples_;
  std::optional<double> begun_s_;  ///< when it began to listen
  std::int64_t bad_messages_ = 0;
  std::string warning_text_;  ///< the last one
  std::int64_t ignored_ = 0;  ///< messages in a row
  int warnings_ = 0;
};

}  // namespace tools
