// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "sim/acoustics/ambient_noise.hpp"
#include "sim/acoustics/fading.hpp"
#include "sim/acoustics/multipath.hpp"
#include "sim/acoustics/transmission_loss.hpp"
#include "sim/config/param_reader.hpp"

namespace sim {

/// Entry of `links:`: losses from one transducer to another.
struct LinkConfig {
  std::string from, to;  ///< a vehicle, or vehicle/device; empty: any
  bool both_ways = true;
  double loss_probability = 0;
  double extra_loss_dB = 0;
  void read(ParamReader& in);
};

/// `acoustics:` of a world: propagation of sound between transducers.
struct AcousticsConfig {
  SpreadingConfig spreading;
  AbsorptionConfig absorption;
  NoiseConfig noise;
  std::optional<MultipathConfig> multipath;
  FadingConfig fading;
  bool occlusion = true;                    ///< terrain, objects and hulls block sound
  std::optional<double> occlusion_loss_dB;  ///< loss through obstacles; unset: no transmission
  double negligible_dB = 10;                ///< signals this far below the noise are ignored
  std::optional<double> range_max_m;        ///< maximum range of reception
  std::vector<LinkConfig> links;
  void read(ParamReader& in);
};

}  // namespace sim
