// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>

#include "experiment/optimize/optimizer.hpp"
#include "sim/random/random.hpp"

namespace experiment {

/// Genetic algorithm with real numbers: parents by tournament, children by BLX-alpha crossing (Eshelman and Schaffer
/// 1993) and mutation.  The best of parents and children survive.
class GeneticAlgorithm final : public Optimizer {
 public:
  struct Options {
    int population = 16;          ///< children of a generation, and survivors
    double sigma = 0.3;           ///< standard deviation of the first generation about the start
    int tournament = 3;           ///< candidates of which the best becomes a parent
    double blend = 0.5;           ///< alpha of BLX: how far children reach beyond their parents
    double mutation_share = 0.1;  ///< probability that a coordinate is mutated
    double mutation_sigma = 0.1;
    std::uint64_t seed = 1;
  };

  GeneticAlgorithm(Point start, const Options& options);
  std::vector<Point> propose() override;
  void learn(std::span<const double> values) override;

 private:
  struct Individual {
    Point point;
    double value = 0;
  };
  const Point& parent();
  Point child();

  Point start_;
  Options options_;
  sim::Random random_;
  std::int64_t proposed_ = 0;          ///< candidates so far
  std::vector<Individual> survivors_;  ///< best first
  std::vector<Point> children_;
};

}  // namespace experiment
