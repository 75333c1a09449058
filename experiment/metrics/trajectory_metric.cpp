// SPDX-License-Identifier: BSD-3-Clause
#include <spdlog/fmt/fmt.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <deque>
#include <stdexcept>

#include "experiment/metrics/scored_period.hpp"
#include "experiment/score/metric_registry.hpp"
#include "shoal/estimate_t.hpp"
#include "shoal/message_codec.hpp"
#include "shoal/pose_t.hpp"
#include "sim/base/log.hpp"

namespace experiment {

namespace {

/// Pose in the plane, with the distance traveled until then.
struct PlanarPose {
  Eigen::Vector2d p_W = Eigen::Vector2d::Zero();
  double yaw_rad = 0;
  double travelled_m = 0;
  void visit_state(sim::StateArchive& archive) { archive(p_W, yaw_rad, travelled_m); }
};

/// Returns a point of the world in the frame of a pose.
Eigen::Vector2d seen_from(const PlanarPose& pose, const Eigen::Vector2d& p_W) {
  return Eigen::Rotation2Dd(-pose.yaw_rad) * (p_W - pose.p_W);
}

/// Sums from which the smallest rms distance of two point sets under a rigid motion follows (Horn 1987, in the plane):
/// for centered sets a, b it is sqrt((sum |a|^2 + sum |b|^2 - 2 sqrt(C^2 + S^2)) / n) with C = sum a . b, S = sum a x
/// b.
struct AlignmentSums {
  double count = 0, dot = 0, cross = 0, squares = 0, error_squares = 0;
  Eigen::Vector2d truth = Eigen::Vector2d::Zero(), estimate = Eigen::Vector2d::Zero();

  void add(const Eigen::Vector2d& truth_m, const Eigen::Vector2d& estimate_m) {
    ++count;
    truth += truth_m;
    estimate += estimate_m;
    dot += truth_m.dot(estimate_m);
    cross += truth_m.x() * estimate_m.y() - truth_m.y() * estimate_m.x();
    squares += truth_m.squaredNorm() + estimate_m.squaredNorm();
    error_squares += (truth_m - estimate_m).squaredNorm();
  }
  double rms_m() const { return std::sqrt(error_squares / count); }
  double aligned_rms_m() const {
    const double c = dot - truth.dot(estimate) / count;
    const double s = cross - (truth.x() * estimate.y() - truth.y() * estimate.x()) / count;
    const double both = squares - (truth.squaredNorm() + estimate.squaredNorm()) / count;
    return std::sqrt(std::max(0.0, both - 2 * std::hypot(c, s)) / count);
  }
  void visit_state(sim::StateArchive& archive) { archive(count, dot, cross, squares, error_squares, truth, estimate); }
};

/// Compares the poses of a vehicle on a channel with the truth, as a whole and in segments.
class TrajectoryMetric final : public Metric {
 public:
  static constexpr const char* meaning = "errors of the planar poses on a channel, as a whole and in segments";
  static std::vector<sim::FigureKind> figures() {
    return {{"ate_m", "m", "absolute trajectory error: root mean square of the position errors in the world frame"},
            {"aligned_ate_m", "m", "the same after the rigid motion of the trajectory that makes it smallest"},
            {"yaw_rms_deg", "deg", "root mean square of the heading errors"},
            {"max_m", "m", "largest position error"},
            {"segment_m", "m",
             "root mean square of the position errors at the end of segments of `segment_m`, seen from "
             "their starts"},
            {"segment_deg", "deg", "the same for the headings"},
            {"segments", "segments", "segments that were compared, one from every meter traveled", true},
            {"lost_s", "s", "longest time with a position error above `lost_m`, from the first estimate on"},
            {"poses", "poses", "poses that were compared with the truth", true}};
  }
  struct Params final : ScoredPeriod {
    double segment_m = 10;
    double lost_m = 0.5;
    void read(sim::ParamReader& in) override {
      in.require("vehicle");
      read_vehicle(in);
      in.require("channel");
      read_channel(in);
      read_period(in);
      in.read("segment_m", segment_m, sim::between(1, 1000), "distance traveled in a segment");
      in.read("lost_m", lost_m, sim::above_to(0, 1e6), "position error from which the vehicle counts as lost");
    }
  };

  TrajectoryMetric(const MetricContext& context, const Params& params)
      : Metric(context),
        params_(params),
        world_(context.world),
        mailbox_(vehicle().bus().open_mailbox(params.channel)),
        recent_(static_cast<std::size_t>(memory_s / sim::to_seconds(world_.step_time())) + 1, present()) {}

  void after_step() override {
    remember();
    while (const auto message = mailbox_->take()) {
      try {
        take(message->payload);
      } catch (const std::runtime_error& error) {
        if (bad_messages_++ == 0)
          sim::log_warn("metric '{}': {}: {} (ignored, as are all further bad ones)", config().name, message->channel,
                        error.what());
      }
    }
  }

  void add_figures(Figures& figures) const override {
    const bool any = sums_.count > 0;
    add(figures, "ate_m", any ? sums_.rms_m() : no_figure);
    add(figures, "aligned_ate_m", any ? sums_.aligned_rms_m() : no_figure);
    add(figures, "yaw_rms_deg", any ? sim::radians_to_degrees(std::sqrt(yaw_squares_ / sums_.count)) : no_figure);
    add(figures, "max_m", any ? max_m_ : no_figure);
    add(figures, "segment_m", segments_ > 0 ? std::sqrt(segment_squares_m2_ / segments_) : no_figure);
    add(figures, "segment_deg",
        segments_ > 0 ? sim::radians_to_degrees(std::sqrt(segment_squares_rad2_ / segments_)) : no_figure);
    add(figures, "segments", segments_);
    const double end_s = std::min(sim::to_seconds(world_.now()), params_.until_s);
    // A vehicle that is lost at the end is lost until then.
    const double lost_s = lost_since_s_ ? end_s - *lost_since_s_ : 0;
    add(figures, "lost_s", any ? std::max(max_lost_s_, lost_s) : no_figure);
    add(figures, "poses", sums_.count);
  }
  std::string why_none(const std::string& figure) const override {
    if (sums_.count > 0 && figure.starts_with("segment"))
      return fmt::format("the vehicle did not travel {:g} m", params_.segment_m);
    if (bad_messages_ > 0) return fmt::format("none of {} messages could be used", bad_messages_);
    return "no pose was received on '" + params_.channel + "'" + since_from_s() + params_.to_until_s();
  }
  std::int64_t bad_messages() const override { return bad_messages_; }

  void visit_state(sim::StateArchive& archive, History) override {
    archive.expect_count(recent_.size(), "steps of truth");
    for (PlanarPose& pose : recent_) archive(pose);
    archive(sums_, yaw_squares_, max_m_, segments_, segment_squares_m2_, segment_squares_rad2_, starts_, lost_since_s_,
            max_lost_s_, bad_messages_);
    if (archive.restoring()) empty(*mailbox_);
  }

 private:
  static constexpr double memory_s = 10;
  /// A start of segments is kept each time the vehicle has traveled this far.
  static constexpr double start_every_m = 1;
  /// Truth and estimate at the start of a segment.
  struct Start {
    PlanarPose truth, estimate;
    void visit_state(sim::StateArchive& archive) { archive(truth, estimate); }
  };

  /// Looks the vehicle up at every use, because a restored world may have built it again.
  const sim::Vehicle& vehicle() const { return *world_.find_vehicle(params_.vehicle); }
  std::size_t slot_of(std::int64_t step) const { return static_cast<std::size_t>(step) % recent_.size(); }
  PlanarPose present() const {
    const sim::Pose X_WV = vehicle().X_WV();
    return {X_WV.translation().head<2>(), sim::yaw_of(X_WV.linear()), 0};
  }

  void remember() {
    const PlanarPose& before = recent_[slot_of(world_.step_number() - 1)];
    PlanarPose now = present();
    // A vehicle that was carried has not traveled the distance, and no segment contains it.
    constexpr double fastest_mps = 200;
    const double distance_m = (now.p_W - before.p_W).norm();
    const bool carried = distance_m > fastest_mps * sim::to_seconds(world_.step_time());
    if (carried) starts_.clear();
    now.travelled_m = before.travelled_m + (carried ? 0 : distance_m);
    recent_[slot_of(world_.step_number())] = now;
  }

  void take(const sim::Bytes& payload) {
    // Decode the pose.
    std::int64_t utime = 0;
    PlanarPose estimate;
    if (shoal::fingerprint(payload) == shoal::fingerprint_of<shoal::estimate_t>()) {
      const auto message = shoal::decode<shoal::estimate_t>(payload, shoal::Finite::any);
      utime = message.utime;
      estimate.p_W = {message.position_m[0], message.position_m[1]};
      estimate.yaw_rad = message.yaw_rad;
    } else {
      const auto message = shoal::decode<shoal::pose_t>(payload, shoal::Finite::required);
      const double* q = message.orientation;
      utime = message.utime;
      estimate.p_W = {message.pos[0], message.pos[1]};
      estimate.yaw_rad = std::atan2(2 * (q[0] * q[3] + q[1] * q[2]), 1 - 2 * (q[2] * q[2] + q[3] * q[3]));
    }
    if (!estimate.p_W.allFinite() || !std::isfinite(estimate.yaw_rad))
      throw std::runtime_error("position and heading must be finite");
    // Find the truth of that time.
    const sim::Time time = true_time_of(world_, vehicle(), utime);
    const std::int64_t step_us = world_.step_time().count();
    const bool near = time.count() >= 0 && time <= world_.now() && time > world_.now() - sim::from_seconds(memory_s);
    if (!near) throw std::runtime_error(fmt::format("'utime' is not within the last {} s of simulated time", memory_s));
    if (sim::to_seconds(time) < params_.from_s || sim::to_seconds(time) > params_.until_s) return;
    compare(recent_[slot_of((time.count() + step_us / 2) / step_us)], estimate, sim::to_seconds(time));
  }

  void compare(const PlanarPose& truth, const PlanarPose& estimate, double time_s) {
    const double error_m = (estimate.p_W - truth.p_W).norm();
    sums_.add(truth.p_W, estimate.p_W);
    yaw_squares_ += std::pow(sim::wrap_angle(estimate.yaw_rad - truth.yaw_rad), 2);
    max_m_ = std::max(max_m_, error_m);
    if (error_m > params_.lost_m) {
      if (!lost_since_s_) lost_since_s_ = time_s;
    } else if (lost_since_s_) {
      max_lost_s_ = std::max(max_lost_s_, time_s - *lost_since_s_);
      lost_since_s_.reset();
    }
    // Segments that end here.
    while (!starts_.empty() && truth.travelled_m - starts_.front().truth.travelled_m >= params_.segment_m) {
      const Start& start = starts_.front();
      const Eigen::Vector2d error = seen_from(start.estimate, estimate.p_W) - seen_from(start.truth, truth.p_W);
      const double turn_error = (estimate.yaw_rad - start.estimate.yaw_rad) - (truth.yaw_rad - start.truth.yaw_rad);
      segment_squares_m2_ += error.squaredNorm();
      segment_squares_rad2_ += std::pow(sim::wrap_angle(turn_error), 2);
      ++segments_;
      starts_.pop_front();
    }
    if (starts_.empty() || truth.travelled_m - starts_.back().truth.travelled_m >= start_every_m)
      starts_.push_back({truth, estimate});
  }

  const Params& params_;
  const sim::World& world_;
  std::unique_ptr<sim::Mailbox> mailbox_;
  std::vector<PlanarPose> recent_;  ///< ring by step number
  AlignmentSums sums_;
  double yaw_squares_ = 0, max_m_ = 0;
  double segments_ = 0, segment_squares_m2_ = 0, segment_squares_rad2_ = 0;
  std::deque<Start> starts_;
  std::optional<double> lost_since_s_;
  double max_lost_s_ = 0;
  std::int64_t bad_messages_ = 0;
};

SHOAL_METRIC("trajectory", TrajectoryMetric);

}  // namespace

}  // namespace experiment
