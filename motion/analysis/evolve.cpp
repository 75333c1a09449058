// SPDX-License-Identifier: BSD-3-Clause
#include "motion/analysis/evolve.hpp"

#include <algorithm>
#include <utility>

#include "experiment/optimize/cma_es.hpp"
#include "experiment/optimize/genetic.hpp"
#include "sim/base/thread_pool.hpp"

namespace motion {

namespace {

std::unique_ptr<experiment::Optimizer> optimizer_of(const EvolveOptions& options, const experiment::Point& start) {
  switch (options.method) {
    case SearchMethod::cma_es:
      return std::make_unique<experiment::CmaEs>(
          start,
          experiment::CmaEs::Options{.population = options.population, .sigma = options.sigma, .seed = options.seed});
    case SearchMethod::genetic:
      break;
  }
  experiment::GeneticAlgorithm::Options genetic;
  genetic.population = options.population;
  genetic.sigma = options.sigma;
  genetic.seed = options.seed;
  return std::make_unique<experiment::GeneticAlgorithm>(start, genetic);
}

}  // namespace

bool Candidate::is_complete() const {
  return std::all_of(walks.begin(), walks.end(), [](const auto& walk) { return walk.has_value(); });
}

bool Candidate::fell() const {
  return std::any_of(walks.begin(), walks.end(), [](const auto& walk) { return walk && walk->fell; });
}

Evolution::Evolution(const sim::WorldConfig& world, const std::string& vehicle, const GaitFamily& gait,
                     const EvolveOptions& options)
    : options_(options), vehicle_(vehicle), gait_(gait), world_(world_for_walks(world)) {
  perturbations_ = options.worlds == 0 ? std::vector<Perturbation>(1)
                                       : drawn_perturbations(options.worlds, options.seed, "evolve/worlds");
  for (const Perturbation& one : perturbations_) worlds_.push_back(world_of(one));
  // The start of the search.
  experiment::Point point;
  for (const GaitNumber& number : gait_.numbers())
    point.push_back((number.start - number.low) / (number.high - number.low));
  optimizer_ = optimizer_of(options, point);
  std::vector<Candidate> start{candidate_at(point, 0)};
  try_all(start);
  start_ = best_ = best_of_generation_ = start.front();
}

sim::WorldConfig Evolution::world_of(const Perturbation& perturbation) const {
  return perturbed(world_, vehicle_, perturbation);
}

Candidate Evolution::candidate_at(const experiment::Point& point, int number) const {
  Candidate candidate;
  candidate.number = number;
  candidate.point = point;
  for (std::size_t i = 0; i < point.size(); ++i) {
    const GaitNumber& one = gait_.numbers()[i];
    candidate.values.push_back(one.low + point[i] * (one.high - one.low));
  }
  candidate.walks.resize(worlds_.size());
  return candidate;
}

/// Walks of pairs of a candidate and a world.
void Evolution::walk_in(std::vector<Candidate>& candidates,
                        const std::vector<std::pair<std::size_t, std::size_t>>& pairs) {
  sim::ThreadPool(options_.threads).for_each(pairs.size(), [&](std::size_t i) {
    Candidate& candidate = candidates[pairs[i].first];
    candidate.walks[pairs[i].second] =
        measured_walk(worlds_[pairs[i].second], vehicle_, gait_.motion(candidate.values), options_.walk);
  });
  walks_ += static_cast<int>(pairs.size());
  for (Candidate& candidate : candidates) {
    candidate.value_mps = 1e9;
    for (const auto& walk : candidate.walks)
      if (walk) candidate.value_mps = std::min(candidate.value_mps, walk->value_mps);
  }
}

void Evolution::try_all(std::vector<Candidate>& candidates) {
  std::vector<std::pair<std::size_t, std::size_t>> pairs;
  for (std::size_t i = 0; i < candidates.size(); ++i) pairs.emplace_back(i, first_world_);
  walk_in(candidates, pairs);
  // The better half in the other worlds.
  std::vector<double> values;
  for (const Candidate& candidate : candidates) values.push_back(candidate.value_mps);
  std::vector<std::size_t> better = experiment::by_rank(values);
  better.resize((candidates.size() + 1) / 2);
  pairs.clear();
  for (const std::size_t i : better)
    for (std::size_t w = 0; w < worlds_.size(); ++w)
      if (w != first_world_) pairs.emplace_back(i, w);
  walk_in(candidates, pairs);
}

void Evolution::choose_first_world(const std::vector<Candidate>& candidates) {
  std::vector<int> worst(worlds_.size(), 0);
  for (const Candidate& candidate : candidates) {
    if (!candidate.is_complete()) continue;
    for (std::size_t w = 0; w < worlds_.size(); ++w)
      // The world in which most candidates do worst goes first, since it rules out most of them after a single walk.
      if (candidate.walks[w]->value_mps == candidate.value_mps) {
        ++worst[w];
        break;
      }
  }
  first_world_ = static_cast<std::size_t>(std::max_element(worst.begin(), worst.end()) - worst.begin());
}

bool Evolution::advance() {
  if (tried_ + options_.population > options_.candidates) return false;
  std::vector<Candidate> candidates;
  for (const experiment::Point& point : optimizer_->propose()) candidates.push_back(candidate_at(point, ++tried_));
  try_all(candidates);
  // The others come after those that walked in all worlds.
  double least_mps = 1e9;
  for (const Candidate& candidate : candidates)
    if (candidate.is_complete()) least_mps = std::min(least_mps, candidate.value_mps);
  std::vector<double> values;
  for (const Candidate& candidate : candidates)
    values.push_back(candidate.is_complete() ? candidate.value_mps : std::min(candidate.value_mps, least_mps - 1e-6));
  optimizer_->learn(values);
  best_of_generation_ = candidates[experiment::by_rank(values).front()];
  if (best_of_generation_.value_mps > best_.value_mps) best_ = best_of_generation_;
  choose_first_world(candidates);
  return true;
}

std::vector<Walk> Evolution::walks_of_best(const std::vector<Perturbation>& worlds) {
  std::vector<Walk> walks(worlds.size());
  const sim::JointMotion motion = gait_.motion(best_.values);
  sim::ThreadPool(options_.threads).for_each(worlds.size(), [&](std::size_t i) {
    walks[i] = measured_walk(world_of(worlds[i]), vehicle_, motion, options_.walk);
  });
  walks_ += static_cast<int>(worlds.size());
  return walks;
}

}  // namespace motion
