// SPDX-License-Identifier: BSD-3-Clause
#include <ceres/tiny_solver.h>

#include <Eigen/Cholesky>
#include <cmath>
#include <deque>
#include <vector>

#include "autonomy/cooperative/estimator/estimator_registry.hpp"
#include "autonomy/cooperative/filter/own_filter.hpp"

namespace navigation {

namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;

/// A state, what was measured there, and the motion after it.
struct Node {
  struct Motion {
    Time time;
    Vector2 v_W;
    Matrix2 q;
  };
  Time time = 0;
  std::vector<Motion> motions = {};
  std::optional<Position> sender = {};  ///< of a range
  std::optional<Vector2> fix_W = {};
  double range_m = 0, dz_m = 0, std_m = 1;
  Time until = time;
};

/// Returns L with L L' = P, without the columns of eigenvalues that are 0: states without noise have none.
MatrixXd root_of(const MatrixXd& P) {
  const Eigen::LDLT<MatrixXd> factors(P);
  const VectorXd D = factors.vectorD();
  const MatrixXd lower = factors.transpositionsP().transpose() * MatrixXd(factors.matrixL());
  MatrixXd L(P.rows(), P.cols());
  Eigen::Index count = 0;
  for (Eigen::Index i = 0; i < D.size(); ++i)
    if (D[i] > 0) L.col(count++) = std::sqrt(D[i]) * lower.col(i);
  return L.leftCols(count);
}

/// Trajectory x_0 .. x_N as function of white noise e of variance 1, for ceres::TinySolver:
///
///     x_0 = m + L_0 e_0     x_k+1 = f(x_k) + L_k+1 e_k+1     residuals: e, (z - h(x_k)) / sigma
///
/// Its minimum is that of |x_0 - m|^2_P + sum |x_k+1 - f(x_k)|^2_Q + sum |z - h(x_k)|^2_R with P = L_0 L_0', Q = L L';
/// Q may be singular, which it is for constant states.
class Trajectory {
 public:
  using Scalar = double;
  enum { NUM_RESIDUALS = Eigen::Dynamic, NUM_PARAMETERS = Eigen::Dynamic };

  /// Noise and weights are those at the states `at`, before the measurement of each node; empty: of the prediction.
  Trajectory(const JointFilter& first, const std::deque<Node>& nodes, const std::vector<VectorXd>& at);

  int NumParameters() const { return parameters_; }
  int NumResiduals() const { return parameters_ + measured_; }
  bool operator()(const double* noise, double* residuals, double* jacobian) const;
  std::vector<VectorXd> states(const VectorXd& noise) const;
  /// Returns the filter at the end, with the covariance of the linearized problem.
  JointFilter end(const VectorXd& noise) const;

 private:
  /// Optional results of a walk along the trajectory; the first rows of the Jacobian are those of the noise.
  struct Results {
    double* residuals = nullptr;
    MatrixXd* jacobian = nullptr;
    MatrixXd* last = nullptr;  ///< derivative of the last state
    std::vector<VectorXd>* states = nullptr;
  };
  JointFilter walk(const VectorXd& noise, const Results& results) const;
  MatrixXd jacobian_of_noise() const;

  const JointFilter& first_;
  const std::deque<Node>& nodes_;
  std::vector<MatrixXd> roots_;  ///< of P_0, and of Q after each node
  std::vector<double> range_std_m_;
  int parameters_ = 0, measured_ = 0;
};

Trajectory::Trajectory(const JointFilter& first, const std::deque<Node>& nodes, const std::vector<VectorXd>& at)
    : first_(first), nodes_(nodes), roots_{root_of(first.P())} {
  JointFilter filter = first;
  for (std::size_t k = 0; k < nodes.size(); ++k) {
    const Node& node = nodes[k];
    if (!at.empty()) filter.set_x(at[k]);
    double variance_m2 = node.std_m * node.std_m;
    // Errors of the sender count as noise of the range: it is not estimated here.
    if (node.sender) {
      const Vector2 u = filter.range_row(0, *node.sender, node.dz_m).u;
      variance_m2 += u.dot(node.sender->P * u);
    }
    range_std_m_.push_back(std::sqrt(variance_m2));
    measured_ += (node.sender ? 1 : 0) + (node.fix_W ? 2 : 0);
    // From a certain state, so that P is the noise of this stretch alone.
    filter.set_P(MatrixXd::Zero(filter.size(), filter.size()));
    for (const Node::Motion& motion : node.motions) filter.move(0, motion.time, motion.v_W, motion.q);
    roots_.push_back(root_of(filter.P()));
  }
  for (const MatrixXd& root : roots_) parameters_ += static_cast<int>(root.cols());
}

JointFilter Trajectory::walk(const VectorXd& noise, const Results& results) const {
  JointFilter filter = first_;
  const int n = filter.size();
  filter.set_P(MatrixXd::Zero(n, n));
  MatrixXd D = MatrixXd::Zero(n, parameters_);  // derivative of the state with respect to the noise
  int column = 0;
  int row = parameters_;
  const auto add_noise = [&](const MatrixXd& root) {
    const auto columns = static_cast<int>(root.cols());
    filter.set_x(filter.x() + root * noise.segment(column, columns));
    D.middleCols(column, columns) = root;
    column += columns;
  };
  const auto measure = [&](const VectorXd& H, double innovation, double std_m) {
    if (results.residuals != nullptr) results.residuals[row] = innovation / std_m;
    if (results.jacobian != nullptr)
      results.jacobian->row(row).head(column) = -(H.transpose() * D.leftCols(column)) / std_m;
    ++row;
  };
  const int slow = filter.layout(0).slow_fix;
  add_noise(roots_.front());
  for (std::size_t k = 0; k < nodes_.size(); ++k) {
    const Node& node = nodes_[k];
    if (results.states != nullptr) results.states->push_back(filter.x());
    if (node.sender) {
      const JointFilter::RangeRow range = filter.range_row(0, *node.sender, node.dz_m);
      measure(range.H, node.range_m - range.predicted_m, range_std_m_[k]);
    }
    for (int i = 0; i < 2 && node.fix_W; ++i) {
      VectorXd H = VectorXd::Zero(n);
      H[i] = 1;
      if (slow >= 0) H[slow + i] = 1;
      measure(H, (*node.fix_W)[i] - H.dot(filter.x()), node.std_m);
    }
    MatrixXd F = MatrixXd::Identity(n, n);
    for (const Node::Motion& motion : node.motions) {
      if (results.jacobian != nullptr) F = filter.jacobian(0, motion.time, motion.v_W) * F;
      filter.move(0, motion.time, motion.v_W, Matrix2::Zero());
    }
    D.leftCols(column) = (F * D.leftCols(column)).eval();
    add_noise(roots_[k + 1]);
  }
  if (results.last != nullptr) *results.last = D;
  return filter;
}

MatrixXd Trajectory::jacobian_of_noise() const {
  MatrixXd J = MatrixXd::Zero(NumResiduals(), parameters_);
  J.topRows(parameters_).setIdentity();
  return J;
}

bool Trajectory::operator()(const double* noise, double* residuals, double* jacobian) const {
  const VectorXd e = Eigen::Map<const VectorXd>(noise, parameters_);
  Eigen::Map<VectorXd>(residuals, parameters_) = e;
  if (jacobian == nullptr) {
    walk(e, {.residuals = residuals});
    return true;
  }
  MatrixXd J = jacobian_of_noise();
  walk(e, {.residuals = residuals, .jacobian = &J});
  Eigen::Map<MatrixXd>(jacobian, J.rows(), J.cols()) = J;
  return true;
}

std::vector<VectorXd> Trajectory::states(const VectorXd& noise) const {
  std::vector<VectorXd> states;
  walk(noise, {.states = &states});
  return states;
}

JointFilter Trajectory::end(const VectorXd& noise) const {
  MatrixXd J = jacobian_of_noise();
  MatrixXd D;
  JointFilter filter = walk(noise, {.jacobian = &J, .last = &D});
  const MatrixXd information = J.transpose() * J;
  const MatrixXd P = D * information.llt().solve(D.transpose());
  filter.set_P(0.5 * (P + P.transpose()));
  return filter;
}

/// Fixed-lag smoother: the states of the last `lag_s` at each range and fix, by nonlinear least squares (Fallon,
/// Papadopoulos, Leonard and Patrikalakis, IJRR 29(12), 2010), solved by the Levenberg-Marquardt method of Ceres.
///
/// The oldest state is marginalized: m and P are then the prediction from its linearization.  What others say is taken
/// as independent, as by `naive`; a wrong start is found again by the relinearization.
class FixedLagSmoother final : public OwnFilterEstimator<FixedLagSmoother> {
 public:
  static constexpr const char* meaning =
      "fixed-lag smoother: relinearizes the last minutes; treats received estimates as independent";
  static constexpr double lag_s = 120;
  /// Fixes each second would make the problem large, while they need no smoothing.
  static constexpr std::size_t max_nodes = 40;
  /// Noise and weights are computed again at the trajectory of the first solution.
  static constexpr int passes = 2;

  void start(const Setup& setup) override {
    need_bytes(setup, "fls", position_bytes);
    OwnFilterEstimator::start(setup);
    nodes_ = {Node{.time = setup.time}};
    first_ = filter_;
  }
  void predict(Time time, const Vector2& v_W, const Matrix2& q) override {
    if (!(time > nodes_.back().until)) return;
    nodes_.back().motions.push_back({time, v_W, q});
    nodes_.back().until = time;
    filter_.move(own, time, v_W, q);
  }
  void fix(Time time, const Vector2& p_W, double std_m) override {
    if (filter_.fix(own, p_W, std_m) != JointFilter::Outcome::used) return;  // linear: nothing to solve again
    Node& node = begin_node(time);
    node.fix_W = p_W;
    node.std_m = std_m;
  }
  void on_range(const ReceivedRange& received) override {
    const auto sender = position_in(received.payload);
    if (!sender) return;
    const double dz_m = received.own_z_m - received.sender_z_m;
    const double clock_m2 = sender_clock_variance_m2(setup_, received.sender, received.toa - setup_.time);
    const double std_m = std::sqrt(received.std_m * received.std_m + clock_m2);
    // The gate is that of a filter at the newest state; a wrong range would spoil the whole window.
    JointFilter predicted = filter_;
    if (predicted.range(own, *sender, dz_m, received.range_m, std_m) != JointFilter::Outcome::used) return;
    Node& node = begin_node(received.toa);
    node.sender = sender;
    node.dz_m = dz_m;
    node.range_m = received.range_m;
    node.std_m = std_m;
    solve();
  }
  Bytes make_payload(Time time, std::size_t) override { return payload_of(own_position(time)); }

 private:
  Node& begin_node(Time time) {
    nodes_.push_back(Node{.time = time});
    while (nodes_.size() > 2 && (seconds(time - nodes_[1].time) > lag_s || nodes_.size() > max_nodes)) {
      const Node& oldest = nodes_.front();
      if (oldest.sender) first_.range(own, *oldest.sender, oldest.dz_m, oldest.range_m, oldest.std_m);
      if (oldest.fix_W) first_.fix(own, *oldest.fix_W, oldest.std_m);
      for (const Node::Motion& motion : oldest.motions) first_.move(own, motion.time, motion.v_W, motion.q);
      nodes_.pop_front();
    }
    return nodes_.back();
  }
  void solve() {
    std::vector<VectorXd> at;
    for (int pass = 0; pass < passes; ++pass) {
      const Trajectory trajectory(first_, nodes_, at);
      VectorXd noise = VectorXd::Zero(trajectory.NumParameters());
      ceres::TinySolver<Trajectory>().Solve(trajectory, &noise);
      at = trajectory.states(noise);
      filter_ = trajectory.end(noise);
    }
  }

  JointFilter first_;  ///< before the measurement of the first node
  std::deque<Node> nodes_;
};

SHOAL_ESTIMATOR("fls", FixedLagSmoother);

}  // namespace

}  // namespace navigation
