// SPDX-License-Identifier: BSD-3-Clause
#include "sim/acoustics/acoustics_config.hpp"

namespace sim {

void LinkConfig::read(ParamReader& in) {
  in.read("from", from, "sender: a vehicle, or vehicle/device; unset: any");
  in.read("to", to, "receiver: a vehicle, or vehicle/device; unset: any");
  in.read("both_ways", both_ways, "also from `to` to `from`");
  in.read("loss_probability", loss_probability, between(0, 1),
          "loss probability of each signal that would be understood");
  in.read("extra_loss_dB", extra_loss_dB, between(-200, 200), "taken from the level");
}

void AcousticsConfig::read(ParamReader& in) {
  in.read("spreading", spreading, "spreading loss of sound with range");
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

}  // namespace sim
