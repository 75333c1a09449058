// SPDX-License-Identifier: BSD-3-Clause
#include "sim/acoustics/acoustics_config.hpp"

namespace sim {

void LinkConfig::read(ParamReader& in) {
  in.read("from", from, "sender: a vehicle, or vehicle/device; absent: any");
  in.read("to", to, "receiver: a vehicle, or vehicle/device; absent: any");
  in.read("both_ways", both_ways, "also from `to` to `from`");
  in.read("loss_probability", loss_probability, between(0, 1), "of each signal that would be understood");
  in.read("extra_loss_dB", extra_loss_dB, between(-200, 200), "taken from the level");
}

void AcousticsConfig::read(ParamReader& in) {
  in.read("spreading", spreading, "how sound thins out with range");
  in.read("absorption", absorption, "how sound is swallowed with range");
  in.read("noise", noise, "of the sea");
  in.read("multipath", multipath, "echoes of surface and bottom; absent: the direct path alone");
  in.read("fading", fading, "how levels vary");
  in.read("occlusion", occlusion, "terrain, objects and hulls stand in the way of sound");
  in.read("occlusion_loss_dB", occlusion_loss_dB, between(0, 1000), "of what stands in the way; unset: nothing passes");
  in.read("inaudible_dB", inaudible_dB, between(0, 100), "sounds this far below the noise of the sea do not count");
  in.read("range_max_m", range_max_m, above(0), "nothing is heard beyond");
  in.read_list("links", links, "link", "losses of single links");
}

}  // namespace sim
