// SPDX-License-Identifier: BSD-3-Clause
#include "sim/acoustics/propagation/acoustics_config.hpp"

#include <cmath>

namespace sim {

void LinkConfig::read(ParamReader& in) {
  in.read("from", from, "sender: a vehicle, or vehicle/device; unset: any");
  in.read("to", to, "receiver: a vehicle, or vehicle/device; unset: any");
  in.read("both_ways", both_ways, "also from `to` to `from`");
  in.read("loss_probability", loss_probability, between(0, 1),
          "loss probability of each signal that would be understood");
  in.read("extra_loss_dB", extra_loss_dB, between(-200, 200), "taken from the level");
}

void EchoLockConfig::read(ParamReader& in) {
  in.read("probability", probability, between(0, 1),
          "that a receiver takes an echo as loud as the first arrival for it, at its detection threshold");
  in.read("margin_dB", margin_dB, above_to(0, 100),
          "signal over the threshold at which the probability has fallen to 1/e");
}

void AcousticsConfig::read(ParamReader& in) {
  in.read_choice("propagation", propagation, "auto", {{"straight", SoundPaths::straight}, {"rays", SoundPaths::rays}},
                 "straight lines, or rays refracted by the sound speed profile; auto: rays if the water has a profile");
  in.read("shadow_loss_dB", shadow_loss_dB, between(0, 200),
          "rays: loss of the sound that leaks into shadows, beyond that of the straight line; unset: none leaks");
  in.read("echo_lock", echo_lock, "receivers sometimes take an echo for the first arrival; unset: never");
  in.read("spreading", spreading,
          "spreading loss along straight lines; has no effect with rays, whose ray tubes give the spreading");
  in.read("absorption", absorption, "absorption of sound with range");
  in.read("noise", noise, "ambient noise of the sea");
  in.read("multipath", multipath, "echoes of surface and bottom; unset: the direct path alone");
  in.read("fading", fading, "fading of the level");
  in.read("occlusion", occlusion, "terrain, objects and hulls block sound");
  in.read("occlusion_loss_dB", occlusion_loss_dB, between(0, 1000), "loss through obstacles; unset: nothing passes");
  in.read("negligible_dB", negligible_dB, between(0, 100), "signals this far below the ambient noise are ignored");
  in.read("range_max_m", range_max_m, above(0), "maximum range of reception");
  in.read_list("links", links, "link", "losses of single links");
}

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
