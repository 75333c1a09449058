// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <iosfwd>
#include <vector>

#include "tests/cross_check/experiments.hpp"

namespace cross_check {

/// One run of an experiment.
struct Row {
  Method method = Method::shoal;
  double step_s = 0;
  std::vector<double> values;  ///< of the experiment's quantities
  double cpu_s = 0;            ///< of a step
};

struct Measured {
  Experiment experiment;
  std::vector<Row> rows;
};

/// Runs the experiments by every method with steps of 1 ms and 5 ms.
std::vector<Measured> measure(const std::vector<Experiment>& chosen);

/// A section in Markdown for each experiment.
void write_tables(std::ostream& out, const std::vector<Measured>& all);
/// docs/models/cross_check.md: errors, costs and what each experiment is.
void write_page(std::ostream& out, const std::vector<Measured>& all);
/// docs/models/cross_check/runs.csv: the values of every run.
void write_csv(std::ostream& out, const std::vector<Measured>& all);

}  // namespace cross_check
