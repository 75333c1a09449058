// SPDX-License-Identifier: BSD-3-Clause
#include <Eigen/LU>
#include <algorithm>
#include <cmath>

#include "autonomy/cooperative/estimator/estimator_registry.hpp"
#include "autonomy/cooperative/filter/minimum.hpp"
#include "autonomy/cooperative/filter/own_filter.hpp"

namespace navigation {

namespace {

/// Covariance intersection (Julier and Uhlmann, ACC 1997) with a partial measurement, as by Chang, Chen and Mehta
/// (IEEE T-RO, 2021): the correlation of own and sender's estimate is unknown, that of the range with both is 0.
///
///     P1 = D P D,   B1 = B / (1 - w),   S = u' P1 u + u' B1 u + R,   K = P1 u / S,   P+ = (I - K u') P1
///
/// D is w^(-1/2) for the position and 1 for the errors of the own instruments (heading, speed, clock), which are in no
/// data of others.  Inflated with each of many measurements, they would exceed what the instruments allow: a heading
/// that nothing bounds turns the track.  w in (0, 1] minimizes the trace of the position; w = 1 means no update.  A
/// sender whose fixes by satellite replaced all that it sent before is independent, and says so: the range is used
/// without inflation.
class CovarianceIntersection final : public OwnFilterEstimator<CovarianceIntersection> {
 public:
  static constexpr const char* meaning = "covariance intersection: consistent for any unknown correlation";

  void start(const Setup& setup) override {
    need_bytes(setup, "ci", position_bytes + 1);
    OwnFilterEstimator::start(setup);
  }
  void on_range(const ReceivedRange& received) override {
    PayloadReader reader(received.payload);
    const auto sender = read_position(reader);
    const bool is_independent = reader.whole(1) != 0;
    if (!sender || !reader.ok()) return;
    const JointFilter::RangeRow row = filter_.range_row(own, *sender, received.own_z_m - received.sender_z_m);
    const double R = received.std_m * received.std_m + row.bend_variance_m2 +
                     sender_clock_variance_m2(setup_, received.sender, received.toa - setup_.time);
    const double b = row.u.dot(sender->P * row.u);
    const double innovation_m = received.range_m - row.predicted_m;
    const double a = row.H.dot(filter_.P() * row.H);
    if (!std::isfinite(innovation_m) || !filter_.within_gate(innovation_m, a + b + R)) return;
    independence_.shared();
    // Fixes of the sender have replaced all that it shared: no common errors are left, and an ordinary update is exact.
    if (is_independent) {
      filter_.update(row.H, innovation_m, b + R);
      return;
    }
    // Covariance intersection (Julier and Uhlmann 1997) of own covariance over w and the sender's over 1 - w. The
    // weight minimizes the trace of the own position after the update.
    const double trace = filter_.covariance(own).trace();
    const Minimum best = minimum_between(0.01, 0.999, [&](double w) {
      const Eigen::VectorXd DH = inflated(row.H, w), PDH = filter_.P() * DH;
      return trace / w - PDH.head<2>().squaredNorm() / (w * (DH.dot(PDH) + b / (1 - w) + R));
    });
    // No weight gains anything: the estimate stays as it is.
    if (!(best.value < trace)) return;
    inflate(best.at);
    filter_.update(row.H, innovation_m, b / (1 - best.at) + R);
  }
  void on_bearing(const Relative& seen) override {
    const auto other = position_in(seen.payload);
    if (!other) return;
    const JointFilter::RelativeRow row = filter_.relative_row(own, *other, seen);
    const Matrix2 B = row.J * other->P * row.J.transpose();
    if (!filter_.within_gate(row, B)) return;
    const double trace = filter_.covariance(own).trace();
    // As for ranges, with a measurement of two components.
    const Minimum best = minimum_between(0.01, 0.999, [&](double w) {
      const Eigen::MatrixXd DH = inflated(row.H.transpose(), w), PDH = filter_.P() * DH;
      const Matrix2 S = DH.transpose() * PDH + B / (1 - w) + row.R;
      const Matrix2 gained = PDH.topRows<2>() * S.inverse() * PDH.topRows<2>().transpose();
      return (trace - gained.trace()) / w;
    });
    if (!(best.value < trace)) return;
    independence_.shared();
    inflate(best.at);
    filter_.update(row.H, row.innovation, B / (1 - best.at) + row.R);
  }
  Bytes make_payload(Time time, std::size_t) override {
    Bytes payload = payload_of(own_position(time));
    payload.push_back(independence_.is_independent() ? 1 : 0);
    independence_.shared();
    return payload;
  }

 private:
  /// D H.
  static Eigen::MatrixXd inflated(Eigen::MatrixXd H, double w) {
    H.topRows<2>() /= std::sqrt(w);
    return H;
  }
  /// P = D P D.
  void inflate(double w) { filter_.set_P(inflated(inflated(filter_.P(), w).transpose(), w)); }
};

SHOAL_ESTIMATOR("ci", CovarianceIntersection);

}  // namespace

}  // namespace navigation
