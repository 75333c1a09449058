// SPDX-License-Identifier: BSD-3-Clause
#include "verification/bench/talkers.hpp"

#include "shoal/message_codec.hpp"
#include "shoal/modem_send_t.hpp"

namespace verification {

Talkers::Talkers(const sim::World& world, sim::Bus& bus) : bus_(bus) {
  for (const auto& vehicle : world.vehicles())
    if (world.find_device(vehicle->name() + "/modem") != nullptr) channels_.push_back(vehicle->name() + ".modem.cmd");
  shoal::modem_send_t message{};
  message.data.assign(32, 1);
  message.size = 32;
  payload_ = shoal::encode(message);
}

void Talkers::think(sim::Time now) {
  constexpr double period_s = 10;
  if (channels_.empty()) return;
  const auto count = static_cast<std::int64_t>(channels_.size());
  while (static_cast<double>(next_) * period_s / static_cast<double>(count) <= sim::to_seconds(now))
    bus_.publish(channels_[static_cast<std::size_t>(next_++ % count)], payload_, now);
}

}  // namespace verification
