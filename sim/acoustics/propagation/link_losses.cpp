// SPDX-License-Identifier: BSD-3-Clause
#include "sim/acoustics/propagation/link_losses.hpp"

namespace sim {

LinkLosses link_losses(std::span<const LinkConfig> links, const std::string& source, const std::string& receiver) {
  // Whether a name of the configuration, a vehicle or a device, includes a device.
  const auto named = [](const std::string& name, const std::string& device) {
    return name.empty() || name == device ||
           (device.size() > name.size() && device[name.size()] == '/' && device.compare(0, name.size(), name) == 0);
  };
  LinkLosses sum;
  for (const LinkConfig& link : links) {
    const bool there = named(link.from, source) && named(link.to, receiver);
    const bool back = link.both_ways && named(link.to, source) && named(link.from, receiver);
    if (!there && !back) continue;
    sum.loss = sum.loss + Decibels{link.extra_loss_dB};
    sum.probability = 1 - (1 - sum.probability) * (1 - link.loss_probability);
  }
  return sum;
}

}  // namespace sim
