// SPDX-License-Identifier: BSD-3-Clause
#include "sim/acoustics/fading.hpp"

#include <cmath>

namespace sim {

void FadingConfig::read(ParamReader& in) {
  in.read_choice("type", type, {{"none", Type::none}, {"rayleigh", Type::rayleigh}, {"log_normal", Type::log_normal}},
                 "how the level differs from packet to packet");
  in.read("std_dB", std_dB, between(0, 40), "log_normal: measured 5 to 10");
  if (in.has("std_dB") && type != Type::log_normal) in.error("std_dB", "'std_dB' is for type log_normal");
}

Decibels fade(const FadingConfig& config, Random& random) {
  switch (config.type) {
    case FadingConfig::Type::none:
      break;
    case FadingConfig::Type::rayleigh:
      return to_decibels(PowerRatio(-std::log(random.uniform())));
    case FadingConfig::Type::log_normal:
      return Decibels(config.std_dB * random.gaussian());
  }
  return {};
}

}  // namespace sim
