// SPDX-License-Identifier: BSD-3-Clause
#include <spdlog/fmt/fmt.h>
#include <spdlog/spdlog.h>

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "shoal/estimate_t.hpp"
#include "shoal/message_codec.hpp"
#include "shoal/pose_t.hpp"
#include "tools/experiment/score/metric.hpp"

namespace tools {

namespace {

/// How far ahead of the truth an estimate may be: the clock of a vehicle is not perfect.
constexpr sim::Time most_ahead{1'000'000};

/// Of one metric; the count of bad messages is in the summary.
constexpr int most_warnings = 100;

struct Estimate {
  std::int64_t utime = 0;
  sim::Vector3d position_m = sim::Vector3d::Zero();
  std::optional<Eigen::Matrix3d> covariance_m2;
};

Estimate decode_estimate(const sim::Bytes& payload) {
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

/// error^T P^-1 error in the first `size` dimensions; NaN when P is none that a covariance can be.
template <int size>
double nees_of(const Eigen::Matrix3d& covariance_m2, const sim::Vector3d& error) {
  const Eigen::Matrix<double, size, size> P = covariance_m2.topLeftCorner<size, size>();
  if ((P - P.transpose()).cwiseAbs().maxCoeff() > 1e-6 * P.cwiseAbs().maxCoeff()) return no_figure;
  const Eigen::LLT<Eigen::Matrix<double, size, size>> factor(P);
  const Eigen::Matrix<double, size, 1> e = error.head<size>();
  return factor.info() == Eigen::Success ? e.dot(factor.solve(e)) : no_figure;
}

/// position_error and consistency: estimates of a vehicle's position against the truth.
class EstimateMetric final : public Metric {
 public:
  EstimateMetric(const sim::MetricConfig& config, const sim::World& world, const TruthHistory& truth)
      : Metric(config), world_(world), truth_(truth), mailbox_(vehicle().bus().open_mailbox(config.channel)) {}

  ~EstimateMetric() override {
    say_how_many();
    if (warnings_ > most_warnings)
      spdlog::warn("metric '{}': {} messages were ignored in all", config().name, bad_messages_);
  }

  void after_step() override {
    if (!begun_s_) begun_s_ = sim::to_seconds(world_.now());
    std::erase_if(early_, [this](const Early& early) { return compare(early.time, early.estimate); });
    while (const auto message = mailbox_->take()) {
      try {
        take(decode_estimate(message->payload));
        say_how_many();
      } catch (const std::runtime_error& error) {
        ++bad_messages_;
        complain(message->channel, error.what());
      }
    }
  }

  void add_figures(Figures& figures) const override {
    if (config().type == sim::MetricType::consistency)
      add_consistency(figures);
    else
      add_errors(figures);
    add(figures, "samples", static_cast<double>(samples_.size()));
  }

  std::string why_none(const std::string& figure) const override {
    if (!samples_.empty() && figure == "per_distance_percent")
      return fmt::format("the vehicle had travelled less than {} m", shortest_way_m);
    if (bad_messages_ > 0)
      return fmt::format("none of {} message{} on '{}' could be used", bad_messages_, bad_messages_ == 1 ? "" : "s",
                         config().channel);
    return "no estimate came on '" + config().channel + "'" + since_from_s();
  }
  const std::vector<ErrorSample>* samples() const override { return &samples_; }
  std::int64_t bad_messages() const override { return bad_messages_; }

  void visit_state(sim::StateArchive& archive, History history) override {
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

 private:
  /// An estimate whose time has not come yet.
  struct Early {
    sim::Time time{0};
    Estimate estimate;
    void visit_state(sim::StateArchive& archive) {
      archive(time, estimate.utime, estimate.position_m, estimate.covariance_m2);
    }
  };

  /// A restored world may have built it anew.
  const sim::Vehicle& vehicle() const { return *world_.find_vehicle(config().vehicle); }

  /// Says once what is wrong, however often it comes.
  void complain(const std::string& channel, const std::string& what) {
    if (what != complaint_) {
      say_how_many();
      complaint_ = what;
      warn(fmt::format("{}: {} (ignored, as are all more of this)", channel, what));
    }
    ++ignored_;
  }
  void say_how_many() {
    if (ignored_ > 1) warn(fmt::format("{} messages in a row were ignored", ignored_));
    ignored_ = 0;
  }
  void warn(const std::string& text) {
    if (warnings_ < most_warnings) spdlog::warn("metric '{}': {}", config().name, text);
    ++warnings_;
  }

  void take(const Estimate& estimate) {
    check_covariance(estimate);
    const sim::Time time = true_time_of(world_, vehicle(), estimate.utime);
    const bool forgotten = time.count() < 0 || time < world_.now() - sim::from_seconds(TruthHistory::memory_s);
    if (forgotten || time > world_.now() + most_ahead)
      throw std::runtime_error(
          fmt::format("'utime' is not within the last {} s of simulated time", TruthHistory::memory_s));
    if (sim::to_seconds(time) < config().from_s) return;
    if (!compare(time, estimate)) early_.push_back({time, estimate});
  }

  void check_covariance(const Estimate& estimate) const {
    if (config().type != sim::MetricType::consistency) return;
    if (!estimate.covariance_m2) throw std::runtime_error("it has no covariance: a shoal.estimate_t is needed");
    if (!std::isfinite(nees(estimate, sim::Vector3d::Zero())))
      throw std::runtime_error("'covariance_m2' must be symmetric and positive definite");
  }

  /// False when the truth at that time is not known yet.
  bool compare(sim::Time time, const Estimate& estimate) {
    const auto truth = truth_.at(time);
    if (!truth) return false;
    const sim::Vector3d error = estimate.position_m - truth->position_m;
    ErrorSample sample;
    sample.time_s = sim::to_seconds(time);
    const bool flat = config().dimensions == 2;
    sample.error_m = flat ? error.head<2>().norm() : error.norm();
    sample.truth_m = truth->position_m;
    sample.estimate_m = estimate.position_m;
    sample.travelled_m = truth->travelled_m;
    sample.nees = nees(estimate, error);
    if (std::isfinite(sample.nees)) {
      const Eigen::Matrix3d& P = *estimate.covariance_m2;
      sample.sigma_m = std::sqrt(flat ? P(0, 0) + P(1, 1) : P.trace());
    }
    samples_.push_back(sample);
    return true;
  }

  double nees(const Estimate& estimate, const sim::Vector3d& error) const {
    if (!estimate.covariance_m2 || !estimate.covariance_m2->allFinite()) return no_figure;
    return config().dimensions == 2 ? nees_of<2>(*estimate.covariance_m2, error)
                                    : nees_of<3>(*estimate.covariance_m2, error);
  }

  void add_errors(Figures& figures) const {
    double squares = 0;
    double largest = 0;
    for (const ErrorSample& sample : samples_) {
      squares += sample.error_m * sample.error_m;
      largest = std::max(largest, sample.error_m);
    }
    const bool any = !samples_.empty();
    const auto count = static_cast<double>(samples_.size());
    const double way_m = any ? samples_.back().travelled_m : 0;
    add(figures, "rms_m", any ? std::sqrt(squares / count) : no_figure);
    add(figures, "final_m", any ? samples_.back().error_m : no_figure);
    add(figures, "max_m", any ? largest : no_figure);
    add(figures, "longest_gap_s", longest_gap_s());
    add(figures, "per_distance_percent", way_m >= shortest_way_m ? 100 * samples_.back().error_m / way_m : no_figure);
  }

  /// Until the first estimate, between two, or since the last.
  double longest_gap_s() const {
    const double now_s = sim::to_seconds(world_.now());
    double last_s = std::max(config().from_s, begun_s_.value_or(now_s));
    double gap_s = 0;
    for (const ErrorSample& sample : samples_) {
      gap_s = std::max(gap_s, sample.time_s - last_s);
      last_s = std::max(last_s, sample.time_s);
    }
    return std::max(gap_s, now_s - last_s);
  }

  void add_consistency(Figures& figures) const {
    const double bound = chi_square_95(config().dimensions);
    double sum = 0;
    double inside = 0;
    for (const ErrorSample& sample : samples_) {
      sum += sample.nees;
      inside += sample.nees <= bound ? 1 : 0;
    }
    const auto count = static_cast<double>(samples_.size());
    add(figures, "nees_mean", count > 0 ? sum / count : no_figure);
    add(figures, "inside_95_share", count > 0 ? inside / count : no_figure);
  }

  const sim::World& world_;
  const TruthHistory& truth_;
  std::unique_ptr<sim::Mailbox> mailbox_;
  std::vector<Early> early_;
  std::vector<ErrorSample> samples_;
  std::optional<double> begun_s_;  ///< when it began to listen
  std::int64_t bad_messages_ = 0;
  std::string complaint_;     ///< the last one
  std::int64_t ignored_ = 0;  ///< messages in a row
  int warnings_ = 0;
};

class DistanceMetric final : public Metric {
 public:
  DistanceMetric(const sim::MetricConfig& config, const sim::World& world, const TruthHistory& truth)
      : Metric(config), world_(world), truth_(truth) {}

  void after_step() override {
    if (sim::to_seconds(world_.now()) <= config().from_s) before_m_ = truth_.now().travelled_m;
  }
  void visit_state(sim::StateArchive& archive, History) override { archive(before_m_); }
  std::string why_none(const std::string&) const override { return "nothing was measured"; }
  void add_figures(Figures& figures) const override {
    add(figures, "travelled_m", truth_.now().travelled_m - before_m_);
  }

 private:
  const sim::World& world_;
  const TruthHistory& truth_;
  double before_m_ = 0;  ///< travelled before it counts
};

}  // namespace

double chi_square_95(int dimensions) {
  // Quantile tables of the chi-square distribution; with 2 degrees of freedom it is -2 ln 0.05.
  return dimensions == 2 ? -2 * std::log(0.05) : 7.814727903251179;
}

std::unique_ptr<Metric> make_estimate_metric(const sim::MetricConfig& config, const sim::World& world,
                                             const TruthHistory& truth) {
  return std::make_unique<EstimateMetric>(config, world, truth);
}

std::unique_ptr<Metric> make_distance_metric(const sim::MetricConfig& config, const sim::World& world,
                                             const TruthHistory& truth) {
  return std::make_unique<DistanceMetric>(config, world, truth);
}

}  // namespace tools
