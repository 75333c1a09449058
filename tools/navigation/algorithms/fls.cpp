// SPDX-License-Identifier: BSD-3-Clause
#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <deque>
#include <vector>

#include "tools/navigation/estimator/estimator_registry.hpp"
#include "tools/navigation/filter/own_filter.hpp"

namespace navigation {

namespace {

/// Fixed-lag smoother: the states of the last `lag_s` at each range and fix, by Gauss-Newton (as the nonlinear least
/// squares of Fallon, Papadopoulos, Leonard and Patrikalakis, IJRR 29(12), 2010).  The states x_k minimise
///
///     |x_0 - m|^2_P + sum |x_k+1 - f(x_k)|^2_Q + sum (z - h(x_k))^2 / R
///
/// The oldest is marginalised: m and P are then the prediction from its linearisation.  What others say is taken as
/// independent, as by `naive`; a wrong start is found again by the relinearisation.
class FixedLagSmoother final : public OwnFilterEstimator<FixedLagSmoother> {
 public:
  static constexpr const char* meaning =
      "fixed-lag smoother: relinearises the last minutes; what others say is independent";
  static constexpr double lag_s = 120;
  static constexpr int iterations = 4;

  void start(const Setup& setup) override {
    need_bytes(setup, "fls", position_bytes);
    OwnFilterEstimator::start(setup);
    nodes_ = {Node{.time = setup.time}};
    first_ = filter_;
  }
  void moved(Time time, const Vector2& v_W, const Matrix2& q) override {
    if (!(time > nodes_.back().until)) return;
    nodes_.back().motions.push_back({time, v_W, q});
    nodes_.back().until = time;
    filter_.move(own, time, v_W, q);
  }
  void fix(Time time, const Vector2& p_W, double std_m) override {
    Node& node = begin_node(time);
    node.fix_W = p_W;
    node.std_m = std_m;
    filter_.fix(own, p_W, std_m);  // linear: nothing to relinearise
  }
  void heard(const Heard& heard) override {
    const auto sender = position_in(heard.payload);
    if (!sender) return;
    Node& node = begin_node(heard.toa);
    node.sender = sender;
    node.dz_m = heard.own_z_m - heard.sender_z_m;
    node.range_m = heard.range_m;
    const double clock_m2 = sender_clock_variance_m2(setup_, heard.sender, heard.toa - setup_.time);
    node.std_m = std::sqrt(heard.std_m * heard.std_m + clock_m2);
    solve();
  }
  Bytes say(Time time, std::size_t) override { return payload_of(own_position(time)); }

 private:
  struct Motion {
    Time time;
    Vector2 v_W;
    Matrix2 q;
  };
  /// A state, what was measured there, and the motion after it.
  struct Node {
    Time time = 0;
    std::vector<Motion> motions = {};
    std::optional<Position> sender = {};  ///< of a range
    std::optional<Vector2> fix_W = {};
    double range_m = 0, dz_m = 0, std_m = 1;
    Time until = time;
  };

  Node& begin_node(Time time) {
    nodes_.push_back(Node{.time = time});
    while (nodes_.size() > 2 && seconds(time - nodes_[1].time) > lag_s) {
      measure(first_, nodes_.front());
      for (const Motion& motion : nodes_.front().motions) first_.move(own, motion.time, motion.v_W, motion.q);
      nodes_.pop_front();
    }
    return nodes_.back();
  }
  void measure(JointFilter& filter, const Node& node) const {
    if (node.sender) filter.range(own, *node.sender, node.dz_m, node.range_m, node.std_m);
    if (node.fix_W) filter.fix(own, *node.fix_W, node.std_m);
  }
  /// Solves by an iterated Kalman smoother, which is Gauss-Newton on these factors (Bell, SIAM J. Optim. 4(3), 1994).
  void solve();

  JointFilter first_;  ///< before the measurement of the first node
  std::deque<Node> nodes_;
};

void FixedLagSmoother::solve() {
  const std::size_t count = nodes_.size();
  const int n = filter_.size();
  std::vector<Eigen::VectorXd> linearised(count);  // where each state is linearised
  for (int iteration = 0; iteration < iterations; ++iteration) {
    // Forward: predicted and updated states.
    std::vector<Eigen::VectorXd> predicted(count), updated(count);
    std::vector<Eigen::MatrixXd> P_predicted(count), P_updated(count), F(count);
    JointFilter filter = first_;
    for (std::size_t k = 0; k < count; ++k) {
      predicted[k] = filter.x();
      P_predicted[k] = filter.P();
      if (iteration == 0) {
        measure(filter, nodes_[k]);
      } else {
        // Measurement linearised at the smoothed state: innovation z - h(x*) - H (x - x*).
        JointFilter at = filter;
        at.set_x(linearised[k]);
        if (nodes_[k].sender) {
          const JointFilter::RangeRow row = at.range_row(own, *nodes_[k].sender, nodes_[k].dz_m);
          const double R = nodes_[k].std_m * nodes_[k].std_m + row.u.dot(nodes_[k].sender->P * row.u);
          const double innovation = nodes_[k].range_m - row.predicted_m - row.H.dot(filter.x() - linearised[k]);
          if (filter.within_gate(innovation, row.H.dot(filter.P() * row.H) + R)) filter.update(row.H, innovation, R);
        }
        if (nodes_[k].fix_W) filter.fix(own, *nodes_[k].fix_W, nodes_[k].std_m);
      }
      updated[k] = filter.x();
      P_updated[k] = filter.P();
      // Jacobian of the motion to the next node.
      JointFilter unit = filter;
      if (iteration > 0) unit.set_x(linearised[k]);
      F[k] = Eigen::MatrixXd::Identity(n, n);
      for (const Motion& motion : nodes_[k].motions) {
        F[k] = unit.jacobian(own, motion.time, motion.v_W) * F[k];
        unit.move(own, motion.time, motion.v_W, motion.q);
        filter.move(own, motion.time, motion.v_W, motion.q);
      }
    }
    const JointFilter newest = filter;
    // Backward (Rauch, Tung and Striebel).
    linearised[count - 1] = updated[count - 1];
    for (std::size_t k = count - 1; k-- > 0;) {
      const Eigen::MatrixXd C = P_predicted[k + 1].ldlt().solve(F[k] * P_updated[k]).transpose();
      linearised[k] = updated[k] + C * (linearised[k + 1] - predicted[k + 1]);
    }
    filter_ = newest;
  }
}

SHOAL_ESTIMATOR("fls", FixedLagSmoother);

}  // namespace

}  // namespace navigation
