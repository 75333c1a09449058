// SPDX-License-Identifier: BSD-3-Clause
#include "experiment/metrics/estimate_metric.hpp"

#include <spdlog/fmt/fmt.h>

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "shoal/estimate_t.hpp"
#include "shoal/message_codec.hpp"
#include "shoal/pose_t.hpp"
#include "sim/base/log.hpp"

namespace experiment {

namespace {

/// Tolerated lead of an estimate over the truth, because the clock of a vehicle is not perfect.
constexpr sim::Time max_ahead{1'000'000};

/// Limit of warnings of one metric; the count of bad messages is in the summary.
constexpr int max_warnings = 100;

/// Returns error^T P^-1 error in the first `size` dimensions; NaN when P is not a valid covariance.
template <int size>
double nees_of(const Eigen::Matrix3d& covariance_m2, const sim::Vector3d& error) {
  const Eigen::Matrix<double, size, size> P = covariance_m2.topLeftCorner<size, size>();
  if ((P - P.transpose()).cwiseAbs().maxCoeff() > 1e-6 * P.cwiseAbs().maxCoeff()) return no_figure;
  const Eigen::LLT<Eigen::Matrix<double, size, size>> factor(P);
  const Eigen::Matrix<double, size, 1> e = error.head<size>();
  return factor.info() == Eigen::Success ? e.dot(factor.solve(e)) : no_figure;
}

}  // namespace

void EstimateMetric::Params::read(sim::ParamReader& in) {
  in.require("vehicle");
  read_vehicle(in);
  in.require("channel");
  read_channel(in);
  read_period(in);
  in.read("dimensions", dimensions, sim::between(2, 3), "dimensions of the error; 2: horizontal");
}

EstimateMetric::EstimateMetric(const MetricContext& context, const Params& params)
    : Metric(context),
      params_(params),
      world_(context.world),
      truth_(context.truth_of(params.vehicle)),
      mailbox_(vehicle().bus().open_mailbox(params.channel)) {}

EstimateMetric::~EstimateMetric() {
  report_sample_count();
  if (warnings_ > max_warnings)
    sim::log_warn("metric '{}': {} messages were ignored in all", config().name, bad_messages_);
}

void EstimateMetric::after_step() {
  if (!begun_s_) begun_s_ = sim::to_seconds(world_.now());
  // Clocks run ahead, so an estimate may be stamped later than now; it waits for its truth.
  std::erase_if(early_, [this](const Early& early) { return compare(early.time, early.estimate); });
  while (const auto message = mailbox_->take()) {
    try {
      take(decode(message->payload));
      report_sample_count();
    } catch (const std::runtime_error& error) {
      ++bad_messages_;
      warn_once(message->channel, error.what());
    }
  }
}

std::string EstimateMetric::why_none(const std::string& figure) const {
  if (!samples_.empty() && figure == "per_distance_percent")
    return fmt::format("the vehicle had traveled less than {} m", min_distance_m);
  if (bad_messages_ > 0)
    return fmt::format("none of {} message{} on '{}' could be used", bad_messages_, bad_messages_ == 1 ? "" : "s",
                       params_.channel);
  return "no estimate was received on '" + params_.channel + "'" + since_from_s() + params_.to_until_s();
}

void EstimateMetric::visit_state(sim::StateArchive& archive, History history) {
  archive(early_, bad_messages_, begun_s_);
  std::uint64_t count = samples_.size();
  archive(count);
  if (history == History::whole)
    archive(samples_);
  else if (archive.restoring() && count > samples_.size())
    archive.fail("more estimates than there were");
  else if (archive.restoring())
    samples_.resize(count);
  if (archive.restoring()) empty(*mailbox_);
}

EstimateMetric::Estimate EstimateMetric::decode(const sim::Bytes& payload) {
  if (shoal::fingerprint(payload) != shoal::fingerprint_of<shoal::estimate_t>()) {
    const auto pose = shoal::decode<shoal::pose_t>(payload, shoal::Finite::required);
    return {pose.utime, {pose.pos[0], pose.pos[1], pose.pos[2]}, std::nullopt};
  }
  const auto message = shoal::decode<shoal::estimate_t>(payload, shoal::Finite::any);
  Estimate estimate{message.utime, sim::Vector3d(message.position_m), Eigen::Matrix3d()};
  if (!estimate.position_m.allFinite()) throw std::runtime_error("'position_m' must be finite");
  *estimate.covariance_m2 = Eigen::Map<const Eigen::Matrix<double, 3, 3, Eigen::RowMajor>>(message.covariance_m2);
  return estimate;
}

void EstimateMetric::warn_once(const std::string& channel, const std::string& what) {
  if (what != warning_text_) {
    report_sample_count();
    warning_text_ = what;
    warn(fmt::format("{}: {} (ignored, as are all further ones of this kind)", channel, what));
  }
  ++ignored_;
}

void EstimateMetric::report_sample_count() {
  if (ignored_ > 1) warn(fmt::format("{} messages in a row were ignored", ignored_));
  ignored_ = 0;
}

void EstimateMetric::warn(const std::string& text) {
  if (warnings_ < max_warnings) sim::log_warn("metric '{}': {}", config().name, text);
  ++warnings_;
}

void EstimateMetric::take(const Estimate& estimate) {
  check(estimate);
  const sim::Time time = true_time_of(world_, vehicle(), estimate.utime);
  const bool forgotten = time.count() < 0 || time < world_.now() - sim::from_seconds(TruthHistory::memory_s);
  if (forgotten || time > world_.now() + max_ahead)
    throw std::runtime_error(
        fmt::format("'utime' is not within the last {} s of simulated time", TruthHistory::memory_s));
  if (sim::to_seconds(time) < params_.from_s || sim::to_seconds(time) > params_.until_s) return;
  if (!compare(time, estimate)) early_.push_back({time, estimate});
}

bool EstimateMetric::compare(sim::Time time, const Estimate& estimate) {
  const auto truth = truth_.at(time);
  if (!truth) return false;
  const sim::Vector3d error = estimate.position_m - truth->position_m;
  ErrorSample sample;
  sample.time_s = sim::to_seconds(time);
  const bool flat = params_.dimensions == 2;
  sample.error_m = flat ? error.head<2>().norm() : error.norm();
  sample.truth_m = truth->position_m;
  sample.estimate_m = estimate.position_m;
  sample.travelled_m = truth->travelled_m;
  sample.nees = nees(estimate, error);
  // Without a valid covariance there is no NEES, but the error still counts.
  if (std::isfinite(sample.nees)) {
    const Eigen::Matrix3d& P = *estimate.covariance_m2;
    sample.sigma_m = std::sqrt(flat ? P(0, 0) + P(1, 1) : P.trace());
  }
  samples_.push_back(sample);
  return true;
}

double EstimateMetric::nees(const Estimate& estimate, const sim::Vector3d& error) const {
  if (!estimate.covariance_m2 || !estimate.covariance_m2->allFinite()) return no_figure;
  return params_.dimensions == 2 ? nees_of<2>(*estimate.covariance_m2, error)
                                 : nees_of<3>(*estimate.covariance_m2, error);
}

double EstimateMetric::max_gap_s() const {
  const double now_s = std::min(sim::to_seconds(world_.now()), params_.until_s);
  double last_s = std::max(params_.from_s, begun_s_.value_or(now_s));
  double gap_s = 0;
  for (const ErrorSample& sample : samples_) {
    gap_s = std::max(gap_s, sample.time_s - last_s);
    last_s = std::max(last_s, sample.time_s);
  }
  return std::max(gap_s, now_s - last_s);
}

}  // namespace experiment
