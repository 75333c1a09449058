// SPDX-License-Identifier: BSD-3-Clause
#include "sim/acoustics/propagation/signal.hpp"

#include "sim/state/state_archive.hpp"

namespace sim {

const char* signal_loss_word(SignalLoss loss) {
  static constexpr const char* words[signal_losses] = {
      "none",    "noise",        "interference", "half_duplex", "busy",  "captured",   "doppler",
      "blocked", "out_of_water", "receiver_off", "link",        "range", "sender_off", "shadow"};
  return words[static_cast<std::size_t>(loss)];
}

void check_loss(SignalLoss loss, const StateArchive& archive) {
  if (static_cast<int>(loss) < 0 || static_cast<int>(loss) >= signal_losses)
    archive.fail("a signal lost for an unknown cause");
}

}  // namespace sim
