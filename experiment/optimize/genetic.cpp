// SPDX-License-Identifier: BSD-3-Clause
#include "experiment/optimize/genetic.hpp"

#include <algorithm>
#include <cmath>

namespace experiment {

GeneticAlgorithm::GeneticAlgorithm(Point start, const Options& options)
    : start_(std::move(start)), options_(options), random_(options.seed, "genetic_algorithm") {}

const Point& GeneticAlgorithm::parent() {
  const auto count = static_cast<std::uint32_t>(survivors_.size());
  std::uint32_t best = count - 1;
  for (int i = 0; i < options_.tournament; ++i) best = std::min(best, random_.integer_below(count));
  return survivors_[best].point;
}

Point GeneticAlgorithm::child() {
  const Point& a = parent();
  const Point& b = parent();
  Point child;
  for (std::size_t i = 0; i < a.size(); ++i) {
    // Blend crossover (BLX-alpha, Eshelman and Schaffer 1993): a child may lie somewhat beyond its parents, or the
    // range of a population could only shrink.
    const double reach = options_.blend * std::abs(a[i] - b[i]);
    const double low = std::min(a[i], b[i]) - reach, high = std::max(a[i], b[i]) + reach;
    double x = low + random_.uniform() * (high - low);
    if (random_.uniform() < options_.mutation_share) x += options_.mutation_sigma * random_.gaussian();
    child.push_back(reflected(x));
  }
  return child;
}

std::vector<Point> GeneticAlgorithm::propose() {
  children_.clear();
  for (int k = 0; k < options_.population; ++k) {
    random_.begin_step(proposed_++);
    if (!survivors_.empty()) {
      children_.push_back(child());
      continue;
    }
    Point& point = children_.emplace_back();
    for (const double x : start_) point.push_back(reflected(x + options_.sigma * random_.gaussian()));
  }
  return children_;
}

void GeneticAlgorithm::learn(std::span<const double> values) {
  for (std::size_t k = 0; k < children_.size(); ++k) survivors_.push_back({children_[k], values[k]});
  std::stable_sort(survivors_.begin(), survivors_.end(),
                   [](const Individual& a, const Individual& b) { return a.value > b.value; });
  survivors_.resize(std::min(survivors_.size(), static_cast<std::size_t>(options_.population)));
}

}  // namespace experiment
