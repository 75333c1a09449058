// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "sim/acoustics/decibels.hpp"
#include "sim/config/param_reader.hpp"
#include "sim/random/random.hpp"

namespace sim {

/// `fading:` of a world's acoustics: variation of the level from packet to packet.
struct FadingConfig {
  enum class Type { none, rayleigh, log_normal };

  Type type = Type::none;
  double std_dB = 5;  ///< log_normal
  void read(ParamReader& in);
};

/// Draws the gain of one packet.  rayleigh: many paths without a dominant one; the power has the mean 1 and an
/// exponential distribution.  log_normal: the median is 0 dB.  none: draws nothing.
Decibels fade(const FadingConfig& config, Random& random);

}  // namespace sim
