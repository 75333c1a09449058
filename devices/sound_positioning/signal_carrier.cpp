// SPDX-License-Identifier: BSD-3-Clause
#include "devices/sound_positioning/signal_carrier.hpp"

namespace devices {

void read_through(sim::ParamReader& in, SignalCarrier& through) {
  in.read_choice("through", through,
                 {{"radio", SignalCarrier::radio}, {"acoustic", SignalCarrier::acoustic}, {"any", SignalCarrier::any}},
                 "radio: not with either end under water; acoustic: with both ends under water only; any: always");
}

bool carries(const sim::Medium& medium, SignalCarrier carrier, const sim::Vector3d& p_W) {
  if (carrier == SignalCarrier::any) return true;
  return medium.in_water(p_W) == (carrier == SignalCarrier::acoustic);
}

}  // namespace devices
