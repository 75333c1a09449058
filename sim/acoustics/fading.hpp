// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "sim/acoustics/decibels.hpp"
#include "sim/config/param_reader.hpp"
#include "sim/random/random.hpp"

namespace sim {

/// `fading:` of a world's acoustics: how a packet's level differs from the mean, from packet to packet.
struct FadingConfig {
  enum class Type { none, rayleigh, log_normal };

  Type type = Type::none;
  double std_dB = 5;  ///< log_normal
  void read(ParamReader& in);
};

/// The gain of one packet.  rayleigh: many paths and none that is strong; the power has the mean 1 and an exponential
/// distribution.  log_normal: about 0 dB, which is the median.  Draws nothing for none.
Decibels fade(const FadingConfig& config, Random& random);

}  // namespace sim
