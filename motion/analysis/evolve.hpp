// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "experiment/optimize/optimizer.hpp"
#include "motion/analysis/perturbed_world.hpp"
#include "motion/analysis/walk.hpp"
#include "motion/gait/gait_family.hpp"
#include "sim/world_file/world_config.hpp"

namespace motion {

enum class SearchMethod { cma_es, genetic };

/// How a gait is searched.
struct EvolveOptions {
  SearchMethod method = SearchMethod::cma_es;
  int candidates = 500;  ///< at most; whole generations are tried
  int population = 16;   ///< candidates of a generation
  int worlds = 8;        ///< perturbed ones; 0: only the world as it is
  double sigma = 0.3;    ///< initial standard deviation, as a fraction of the range of each number
  std::uint64_t seed = 1;
  int threads = 0;  ///< 0: one for each processor
  WalkOptions walk;
};

/// A gait and its walks.
struct Candidate {
  int number = 0;  ///< from 1; 0: the start of the search
  experiment::Point point;
  std::vector<double> values;              ///< numbers of the gait
  std::vector<std::optional<Walk>> walks;  ///< by world; unset: not tried there
  double value_mps = 0;                    ///< of the worst walk
  bool is_complete() const;
  bool fell() const;
};

/// Search for a gait that is fast in the worst of several perturbed worlds.
///
/// Each candidate walks in one world, and the better half in the others too: the rest of a generation only needs to be
/// known as the rest.  The first world is the one that was the worst one for most of the last generation's better half.
/// The results do not depend on the number of threads.
class Evolution {
 public:
  /// `world`: as loaded.  `gait` must outlive this.
  Evolution(const sim::WorldConfig& world, const std::string& vehicle, const GaitFamily& gait,
            const EvolveOptions& options);

  /// Tries one generation.  Returns false, and does nothing, when the candidates are used up.
  bool advance();

  const std::vector<Perturbation>& perturbations() const { return perturbations_; }
  int tried() const { return tried_; }
  int walks() const { return walks_; }
  /// The gait at the start of the search, in all worlds.
  const Candidate& start() const { return start_; }
  /// The best until now that has walked in all worlds; the start, as long as none is better.
  const Candidate& best() const { return best_; }
  /// The best of the last generation.
  const Candidate& best_of_generation() const { return best_of_generation_; }
  /// Walks with the best gait in other worlds.
  std::vector<Walk> walks_of_best(const std::vector<Perturbation>& worlds);

 private:
  sim::WorldConfig world_of(const Perturbation& perturbation) const;
  void walk_in(std::vector<Candidate>& candidates, const std::vector<std::pair<std::size_t, std::size_t>>& pairs);
  Candidate candidate_at(const experiment::Point& point, int number) const;
  void try_all(std::vector<Candidate>& candidates);
  void choose_first_world(const std::vector<Candidate>& candidates);

  EvolveOptions options_;
  std::string vehicle_;
  const GaitFamily& gait_;
  sim::WorldConfig world_;
  std::vector<Perturbation> perturbations_;
  std::vector<sim::WorldConfig> worlds_;
  std::unique_ptr<experiment::Optimizer> optimizer_;
  std::size_t first_world_ = 0;
  int tried_ = 0, walks_ = 0;
  Candidate start_, best_, best_of_generation_;
};

}  // namespace motion
