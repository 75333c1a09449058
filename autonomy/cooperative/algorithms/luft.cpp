// SPDX-License-Identifier: BSD-3-Clause
#include <Eigen/LU>
#include <Eigen/QR>
#include <map>
#include <utility>

#include "autonomy/cooperative/estimator/estimator_registry.hpp"
#include "autonomy/cooperative/filter/joint_filter.hpp"

namespace navigation {

namespace {

/// Recursive decentralized localization with pairwise communication (Luft, Schubert, Roumeliotis and Burgard, IJRR
/// 37(10), 2018).  Each vehicle keeps its own state and a factor s_ij for each other, with P_ij = s_ij s_ji':
///
///     motion       s_ij <- F_i s_ij
///     own update   s_ij <- (I - K H) s_ij
///     i sees j     P_ij = s_ij s_ji', joint update, s_ij <- P_ij+, s_ji <- I, and for all others k
///                  s_ik <- P_ii+ P_ii^-1 s_ik   (the one approximation; the same for j)
///
/// Only the two that meet exchange data, which needs both directions: it runs from a record, as if they had.
class PairwiseCommunication final : public TeamEstimator {
 public:
  static constexpr const char* meaning = "pairwise communication of those that meet, with factored correlations";

  void start(int vehicle, const Setup& setup) override {
    Own& own = vehicles_[vehicle];
    own.filter = JointFilter(setup.sound_speed_mps, setup.gate);
    own.filter.add(setup.errors(), setup.time, setup.position_W, setup.position_std_m);
  }
  void predict(int vehicle, Time time, const Vector2& v_W, const Matrix2& q) override {
    Own& own = vehicles_.at(vehicle);
    const Eigen::MatrixXd F = own.filter.jacobian(number, time, v_W);
    const Vector2 before_W = own.filter.position(number);
    own.filter.move(number, time, v_W, q);
    own.traveled_W += own.filter.position(number) - before_W;
    for (auto& [other, s] : own.factors) s = (F * s).eval();
  }
  void fix(int vehicle, Time, const Vector2& p_W, double std_m) override {
    Own& own = vehicles_.at(vehicle);
    Eigen::MatrixXd kept;
    if (own.filter.fix(number, p_W, std_m, &kept) == JointFilter::Outcome::refused) return;
    for (auto& [other, s] : own.factors) s = (kept * s).eval();
  }
  void sent(int vehicle, Time time) override {
    Own& own = vehicles_.at(vehicle);
    std::erase_if(own.sent_W, [&](const auto& each) { return seconds(time - each.first) > max_flight_s; });
    own.sent_W[time] = own.traveled_W;
  }
  void on_range(int vehicle, const ReceivedRange& received) override {
    if (!vehicles_.contains(received.sender)) return;
    const Own& sender = vehicles_.at(received.sender);
    const auto sent = sender.sent_W.find(received.payload_time);
    if (sent == sender.sent_W.end()) return;
    // The range refers to the place of the transmission.
    const Vector2 since_W = sender.traveled_W - sent->second;
    meet(vehicle, received.sender, [&](JointFilter& both) {
      shift(both, 1, -since_W);
      const auto outcome = both.range(0, 1, received.own_z_m - received.sender_z_m, received.range_m, received.std_m);
      shift(both, 1, since_W);
      return outcome;
    });
  }
  void on_bearing(int vehicle, const Relative& seen) override {
    if (!vehicles_.contains(seen.other)) return;
    meet(vehicle, seen.other, [&](JointFilter& both) { return both.see(both.relative_row(0, 1, seen)); });
  }
  Estimate now(int vehicle, Time time) const override { return vehicles_.at(vehicle).filter.now(number, time); }

 private:
  static constexpr int number = 0;  ///< of each vehicle in its own filter
  /// A transmission is no longer received after this, 15 km.
  static constexpr double max_flight_s = 10;

  struct Own {
    JointFilter filter;
    std::map<int, Eigen::MatrixXd> factors;  ///< s_ij, by j; none: 0
    Vector2 traveled_W = Vector2::Zero();    ///< since the start, by its motions
    std::map<Time, Vector2> sent_W;          ///< that at each transmission
  };

  /// Returns P+ P^-1.  P may be singular, as with a clock whose error is its drift alone.
  static Eigen::MatrixXd kept_of(const Eigen::MatrixXd& P_after, const Eigen::MatrixXd& P) {
    return P.completeOrthogonalDecomposition().solve(P_after).transpose();
  }

  static void shift(JointFilter& filter, int part, const Vector2& by_W) {
    Eigen::VectorXd x = filter.x();
    x.segment<2>(filter.offset(part)) += by_W;
    filter.set_x(x);
  }

  /// Updates both by a measurement, unless that is refused.
  template <class Update>
  void meet(int i, int j, const Update& update) {
    Own& a = vehicles_.at(i);
    Own& b = vehicles_.at(j);
    const int n = a.filter.size(), m = b.filter.size();
    JointFilter both = a.filter.joined_with(b.filter);
    if (a.factors.contains(j) && b.factors.contains(i)) {
      const Eigen::MatrixXd across = a.factors.at(j) * b.factors.at(i).transpose();
      Eigen::MatrixXd P = both.P();
      P.topRightCorner(n, m) = across;
      P.bottomLeftCorner(m, n) = across.transpose();
      both.set_P(P);
    }
    const Eigen::MatrixXd P = both.P();
    if (update(both) == JointFilter::Outcome::refused) return;
    const Eigen::MatrixXd P_after = both.P();
    const Eigen::MatrixXd kept_a = kept_of(P_after.topLeftCorner(n, n), P.topLeftCorner(n, n));
    const Eigen::MatrixXd kept_b = kept_of(P_after.bottomRightCorner(m, m), P.bottomRightCorner(m, m));
    for (auto& [other, s] : a.factors) s = (kept_a * s).eval();
    for (auto& [other, s] : b.factors) s = (kept_b * s).eval();
    a.factors[j] = P_after.topRightCorner(n, m);
    b.factors[i] = Eigen::MatrixXd::Identity(m, m);
    a.filter.set_x(both.x().head(n));
    a.filter.set_P(P_after.topLeftCorner(n, n));
    b.filter.set_x(both.x().tail(m));
    b.filter.set_P(P_after.bottomRightCorner(m, m));
  }

  std::map<int, Own> vehicles_;
};

SHOAL_TEAM_ESTIMATOR("luft", PairwiseCommunication);

}  // namespace

}  // namespace navigation
