// SPDX-License-Identifier: BSD-3-Clause
#include <Eigen/LU>
#include <algorithm>
#include <cmath>

#include "autonomy/cooperative/estimator/estimator_registry.hpp"
#include "autonomy/cooperative/filter/minimum.hpp"
#include "autonomy/cooperative/filter/own_filter.hpp"

namespace navigation {

namespace {

/// Split covariance intersection (Li and Nashashibi, IEEE ITS Magazine 5(2), 2013): P = Pd + Pi, where Pi is of errors
/// that are independent of those of all others.  With a sender of covariance Bd + Bi,
///
///     P1 = Pd / w + Pi,   P2 = Bd / (1 - w) + Bi,   K = P1 H' (H P1 H' + u' P2 u + R)^-1,   A = I - K H
///     P+ = A P1 A' + K (u' P2 u + R) K',   Pi+ = A Pi A' + K R K',   Pd+ = P+ - Pi+
///
/// and w minimizes the trace.  What a vehicle measures by itself is independent until it says its position; from then
/// on others may have it, and it belongs to Pd.  What came from a sender does, too: others received the same.
class SplitCovarianceIntersection final : public EstimatorOf<SplitCovarianceIntersection> {
 public:
  static constexpr const char* meaning = "split covariance intersection: own errors are known to be independent";
  static constexpr std::size_t bytes = position_bytes + 6;

  void start(const Setup& setup) override {
    need_bytes(setup, "sci", bytes);
    setup_ = setup;
    total_ = JointFilter(setup.sound_speed_mps, setup.gate);
    total_.add(setup.errors(), setup.time, setup.position_W, setup.position_std_m);
    Pd_ = Eigen::MatrixXd::Zero(total_.size(), total_.size());
  }
  void predict(Time time, const Vector2& v_W, const Matrix2& q) override {
    const Eigen::MatrixXd F = total_.jacobian(own, time, v_W);
    total_.move(own, time, v_W, q);
    Pd_ = (F * Pd_ * F.transpose()).eval();
  }
  void fix(Time, const Vector2& p_W, double std_m) override {
    Eigen::MatrixXd A;  // P+ = A P
    if (total_.fix(own, p_W, std_m, &A) == JointFilter::Outcome::refused) return;
    Pd_ = (A * Pd_ * A.transpose()).eval();
  }
  void on_range(const ReceivedRange& received) override {
    PayloadReader reader(received.payload);
    const auto sender = read_position(reader);
    const auto sender_independent = read_covariance(reader);
    if (!sender || !sender_independent) return;
    const JointFilter::RangeRow row = total_.range_row(own, *sender, received.own_z_m - received.sender_z_m);
    const double R = received.std_m * received.std_m + row.bend_variance_m2 +
                     sender_clock_variance_m2(setup_, received.sender, received.toa - setup_.time);
    const double b = row.u.dot(sender->P * row.u);
    // Both are rounded for the payload, so the part may exceed the whole by a last digit.
    const double bi = std::min(b, row.u.dot(*sender_independent * row.u));
    const double innovation_m = received.range_m - row.predicted_m;
    const double a = row.H.dot(total_.P() * row.H);
    if (!std::isfinite(innovation_m) || !total_.within_gate(innovation_m, a + b + R)) return;
    const Eigen::MatrixXd Pi = total_.P() - Pd_;
    // Only the errors that may be correlated are inflated (Julier and Uhlmann 2001, split covariance intersection).
    const auto variance = [&](double w) { return (b - bi) / (1 - w) + bi + R; };
    const Eigen::VectorXd PdH = Pd_ * row.H, PiH = Pi * row.H;
    const double trace_d = Pd_.topLeftCorner<2, 2>().trace(), trace_i = Pi.topLeftCorner<2, 2>().trace();
    const Minimum best = minimum_between(0.01, 0.999, [&](double w) {
      const Eigen::VectorXd PH = PdH / w + PiH;
      return trace_d / w + trace_i - PH.head<2>().squaredNorm() / (row.H.dot(PH) + variance(w));
    });
    if (!(best.value < total_.covariance(own).trace())) return;
    const double w = best.at;
    const Eigen::VectorXd PH = PdH / w + PiH;
    const Eigen::VectorXd K = PH / (row.H.dot(PH) + variance(w));
    const Eigen::MatrixXd A = Eigen::MatrixXd::Identity(total_.size(), total_.size()) - K * row.H.transpose();
    // Joseph form, which keeps the covariance positive semi-definite for any gain.
    const Eigen::MatrixXd Pi_after = A * Pi * A.transpose() + R * K * K.transpose();
    Pd_ = (A * Pd_ * A.transpose() / w + ((b - bi) / (1 - w) + bi) * K * K.transpose()).eval();
    total_.set_x(total_.x() + K * innovation_m);
    total_.set_P(Pi_after + Pd_);
  }
  Bytes make_payload(Time time, std::size_t) override {
    const Estimate estimate = total_.now(own, time);
    Bytes payload = payload_of({estimate.p_W, estimate.P});
    PayloadWriter writer(payload);
    write_covariance(writer, total_.covariance(own) - Pd_.topLeftCorner<2, 2>());
    Pd_ = total_.P();
    return payload;
  }
  Estimate now(Time time) const override { return total_.now(own, time); }

 private:
  static constexpr int own = 0;

  Setup setup_;
  JointFilter total_;
  Eigen::MatrixXd Pd_;
};

SHOAL_ESTIMATOR("sci", SplitCovarianceIntersection);

}  // namespace

}  // namespace navigation
