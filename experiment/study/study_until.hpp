// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "sim/config/param_reader.hpp"

namespace experiment {

/// Condition that ends a study before its last seed: `ci(FIGURE) < 5 %`.
struct StudyUntil {
  std::string figure;
  double bound = 0;               ///< of half of the 95 % confidence interval of the mean, in the unit of the figure
  bool relative = false;          ///< `bound` is a share of the mean
  std::size_t batch = 10;         ///< seeds after which the condition is evaluated, again and again
  std::string text;               ///< as written
  std::size_t planned_seeds = 0;  ///< seeds of the study, used or not
  sim::SourcePlace place;
};

/// Fewer seeds in a batch give intervals that may be narrow by chance.
inline constexpr std::size_t min_sure_batch = 10;

/// Parses `ci(FIGURE) < 5 %`, `ci(FIGURE) < 0.1` or `ci < 5 %`, of the first of `figures` except `passed`.  Throws
/// std::invalid_argument with the rule.
StudyUntil parse_until(const std::string& text, const std::vector<std::string>& figures);

/// Reads the keys `until` and `batch` of a study.
std::optional<StudyUntil> read_until(sim::ParamReader& in, const std::vector<std::string>& figures);

/// Returns whether the mean of these values, one for each seed, is known as well as the condition requires.  Never when
/// a value is NaN, or there are less than two.
bool is_certain(const StudyUntil& until, const std::vector<double>& values);

}  // namespace experiment
