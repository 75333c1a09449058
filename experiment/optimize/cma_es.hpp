// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <cstdint>

#include "experiment/optimize/optimizer.hpp"
#include "sim/random/random.hpp"

namespace experiment {

/// Evolution strategy with covariance matrix adaptation, with the formulas and constants of Hansen's tutorial (arXiv
/// 1604.00772) and positive weights only.  A sample outside of the box is reflected into it; its value is lowered by
/// its distance from the box, which keeps the mean inside.
class CmaEs final : public Optimizer {
 public:
  struct Options {
    int population = 0;  ///< candidates of a generation; 0: 4 + 3 ln n
    double sigma = 0.3;  ///< initial standard deviation of each coordinate
    std::uint64_t seed = 1;
  };

  CmaEs(const Point& start, const Options& options);
  std::vector<Point> propose() override;
  void learn(std::span<const double> values) override;

  double sigma() const { return sigma_; }
  int population() const { return population_; }

 private:
  void adapt(const Eigen::VectorXd& mean_step, const std::vector<std::size_t>& order);
  void decompose();

  int population_;
  double sigma_;
  sim::Random random_;
  std::int64_t proposed_ = 0;  ///< candidates so far
  std::int64_t generation_ = 0;
  // Constants of the strategy, with the names of the tutorial.
  Eigen::VectorXd weights_;
  double mu_eff_ = 0, c_sigma_ = 0, d_sigma_ = 0, c_c_ = 0, c_1_ = 0, c_mu_ = 0, chi_n_ = 0;
  // State.
  Eigen::VectorXd mean_, p_sigma_, p_c_;
  Eigen::MatrixXd C_;
  Eigen::MatrixXd B_;        ///< eigenvectors of C
  Eigen::VectorXd D_;        ///< square roots of its eigenvalues
  Eigen::MatrixXd samples_;  ///< of the last propose(), by column, before reflection
};

}  // namespace experiment
