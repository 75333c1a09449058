// SPDX-License-Identifier: BSD-3-Clause
#include "experiment/optimize/cma_es.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>

namespace experiment {

CmaEs::CmaEs(const Point& start, const Options& options)
    : population_(options.population), sigma_(options.sigma), random_(options.seed, "cma_es") {
  const auto n = static_cast<Eigen::Index>(start.size());
  const auto dimension = static_cast<double>(n);
  if (population_ == 0) population_ = 4 + static_cast<int>(3 * std::log(dimension));
  // Weights of the better half.
  const int mu = population_ / 2;
  weights_.resize(mu);
  for (int i = 0; i < mu; ++i) weights_[i] = std::log((population_ + 1) / 2.0) - std::log(i + 1.0);
  weights_ /= weights_.sum();
  mu_eff_ = 1 / weights_.squaredNorm();
  c_sigma_ = (mu_eff_ + 2) / (dimension + mu_eff_ + 5);
  d_sigma_ = 1 + 2 * std::max(0.0, std::sqrt((mu_eff_ - 1) / (dimension + 1)) - 1) + c_sigma_;
  c_c_ = (4 + mu_eff_ / dimension) / (dimension + 4 + 2 * mu_eff_ / dimension);
  c_1_ = 2 / (std::pow(dimension + 1.3, 2) + mu_eff_);
  c_mu_ = std::min(1 - c_1_, 2 * (0.25 + mu_eff_ + 1 / mu_eff_ - 2) / (std::pow(dimension + 2, 2) + mu_eff_));
  chi_n_ = std::sqrt(dimension) * (1 - 1 / (4 * dimension) + 1 / (21 * dimension * dimension));
  mean_ = Eigen::Map<const Eigen::VectorXd>(start.data(), n);
  p_sigma_ = p_c_ = Eigen::VectorXd::Zero(n);
  C_ = B_ = Eigen::MatrixXd::Identity(n, n);
  D_ = Eigen::VectorXd::Ones(n);
}

std::vector<Point> CmaEs::propose() {
  const Eigen::Index n = mean_.size();
  samples_.resize(n, population_);
  std::vector<Point> points;
  for (int k = 0; k < population_; ++k) {
    random_.begin_step(proposed_++);
    Eigen::VectorXd z(n);
    // N(mean, sigma^2 B D^2 B') by its principal axes (Hansen, The CMA Evolution Strategy: A Tutorial).
    for (double& one : z) one = random_.gaussian();
    samples_.col(k) = mean_ + sigma_ * (B_ * D_.cwiseProduct(z));
    Point& point = points.emplace_back();
    // Points are reflected into their ranges, but the search learns from the unreflected samples, whose distribution
    // is normal.
    for (const double x : samples_.col(k)) point.push_back(reflected(x));
  }
  return points;
}

void CmaEs::learn(std::span<const double> values) {
  // Lower the values of samples outside of the box, by the spread of the generation for a distance of one sigma.
  std::vector<double> lowered(values.begin(), values.end());
  const std::vector<std::size_t> raw_order = by_rank(values);
  const double spread = values[raw_order[raw_order.size() / 4]] - values[raw_order[raw_order.size() * 3 / 4]];
  for (std::size_t k = 0; k < lowered.size(); ++k) {
    const auto sample = samples_.col(static_cast<Eigen::Index>(k));
    const double outside2 = (sample - sample.cwiseMax(0).cwiseMin(1)).squaredNorm();
    lowered[k] -= spread * outside2 / (sigma_ * sigma_);
  }
  const std::vector<std::size_t> order = by_rank(lowered);
  Eigen::VectorXd mean_step = Eigen::VectorXd::Zero(mean_.size());
  for (Eigen::Index i = 0; i < weights_.size(); ++i)
    mean_step += weights_[i] * (samples_.col(static_cast<Eigen::Index>(order[static_cast<std::size_t>(i)])) - mean_);
  adapt(mean_step / sigma_, order);
  mean_ += mean_step;
  decompose();
}

void CmaEs::adapt(const Eigen::VectorXd& mean_step, const std::vector<std::size_t>& order) {
  const auto dimension = static_cast<double>(mean_.size());
  ++generation_;
  // Evolution paths.
  const Eigen::VectorXd whitened = B_ * (B_.transpose() * mean_step).cwiseQuotient(D_);
  p_sigma_ = (1 - c_sigma_) * p_sigma_ + std::sqrt(c_sigma_ * (2 - c_sigma_) * mu_eff_) * whitened;
  const double decay = 1 - std::pow(1 - c_sigma_, 2 * static_cast<double>(generation_));
  const bool is_moderate = p_sigma_.norm() / std::sqrt(decay) < (1.4 + 2 / (dimension + 1)) * chi_n_;
  p_c_ = (1 - c_c_) * p_c_;
  if (is_moderate) p_c_ += std::sqrt(c_c_ * (2 - c_c_) * mu_eff_) * mean_step;
  // Covariance.
  const double correction = is_moderate ? 0 : c_c_ * (2 - c_c_);
  C_ *= 1 - c_1_ - c_mu_ + c_1_ * correction;
  C_ += c_1_ * p_c_ * p_c_.transpose();
  for (Eigen::Index i = 0; i < weights_.size(); ++i) {
    const auto k = static_cast<Eigen::Index>(order[static_cast<std::size_t>(i)]);
    const Eigen::VectorXd y = (samples_.col(k) - mean_) / sigma_;
    C_ += c_mu_ * weights_[i] * y * y.transpose();
  }
  // Step size.  Beyond 1 each sample would be anywhere in the box.
  sigma_ *= std::exp(c_sigma_ / d_sigma_ * (p_sigma_.norm() / chi_n_ - 1));
  sigma_ = std::min(sigma_, 1.0);
}

void CmaEs::decompose() {
  C_ = (C_ + C_.transpose().eval()) / 2;
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver(C_);
  constexpr double min_eigenvalue = 1e-20;  // rounding must not make an eigenvalue negative
  B_ = solver.eigenvectors();
  D_ = solver.eigenvalues().cwiseMax(min_eigenvalue).cwiseSqrt();
}

}  // namespace experiment
