// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "tests/cross_check/engine.hpp"

namespace cross_check {

/// States of all bodies after each step; the first are those at the start.
struct Trajectory {
  double step_s = 0;
  std::vector<std::vector<BodyState>> states;

  /// Index of the state at a time, which is a multiple of the step.
  std::size_t at(double time_s) const;
};

/// What is measured, and its exact value.
struct Quantity {
  std::string name;  ///< with its unit
  double exact = 0;
};

struct Experiment {
  std::string name;   ///< one word
  std::string title;  ///< headline of the page
  std::string text;   ///< the model and the source of the exact values, as Markdown
  Model model;
  double duration_s = 1;
  std::vector<Quantity> quantities;
  std::function<std::vector<double>(const Trajectory&)> measure;  ///< a number for each quantity
};

/// The ten experiments.
std::vector<Experiment> experiments();

/// Runs an experiment, and returns a number for each quantity: NaN where there is none, and for all when the engine
/// diverged.
std::vector<double> run(const Experiment& experiment, Method method, double step_s);

/// CPU time of a step in s: the smallest of three runs without measurement; of the steps until it diverged.
double time_per_step_s(const Experiment& experiment, Method method, double step_s);

}  // namespace cross_check
