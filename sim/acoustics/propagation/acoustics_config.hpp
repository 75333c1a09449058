// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "sim/acoustics/propagation/ambient_noise.hpp"
#include "sim/acoustics/propagation/decibels.hpp"
#include "sim/acoustics/propagation/multipath.hpp"
#include "sim/acoustics/propagation/transmission_loss.hpp"
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

/// Entry of `links:`: losses from one transducer to another.
struct LinkConfig {
  std::string from, to;  ///< a vehicle, or vehicle/device; empty: any
  bool both_ways = true;
  double loss_probability = 0;
  double extra_loss_dB = 0;
  void read(ParamReader& in);
};

/// How sound travels from a source to a receiver.
enum class SoundPaths {
  straight,  ///< along the straight line, at the mean slowness of the water along it
  rays,      ///< along rays that bend with the speed of sound over the depth
};

/// `echo_lock:` of a world's acoustics: receivers that take an echo for the first arrival.
struct EchoLockConfig {
  double probability = 0.1;  ///< for an echo as loud as the first arrival, at the detection threshold
  double margin_dB = 10;     ///< signal-to-noise ratio over the threshold at which it has fallen to 1/e
  void read(ParamReader& in);
};

/// `acoustics:` of a world: propagation of sound between transducers.
struct AcousticsConfig {
  std::optional<SoundPaths> propagation;  ///< unset: rays where the water has a profile
  std::optional<double> shadow_loss_dB;   ///< rays: loss of the sound that leaks into shadows; unset: nothing does
  std::optional<EchoLockConfig> echo_lock;
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
