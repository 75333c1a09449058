// SPDX-License-Identifier: BSD-3-Clause
#include "bridges/lockstep_client/resend.hpp"

namespace bridges {

namespace {

constexpr std::size_t bundle_bytes = 60'000;
/// Approximate bytes of channel and lengths of a message.
constexpr std::size_t message_head_bytes = 80;

}  // namespace

void send_bundles(shoal::sim_resent_t bundle, std::size_t first, std::size_t count,
                  const std::function<ResentMessage(std::size_t place)>& message_at,
                  const std::function<void(const shoal::sim_resent_t&)>& send) {
  for (std::size_t at = first; at < count;) {
    bundle.first = static_cast<std::int32_t>(at);
    bundle.message.clear();
    // A bundle fits into one UDP datagram, so that it needs no reassembly; a larger message is sent alone.
    for (std::size_t bytes = 0; at < count; ++at) {
      const ResentMessage message = message_at(at);
      bytes += message.payload.size() + message_head_bytes;
      if (bytes > bundle_bytes && !bundle.message.empty()) break;
      shoal::sim_payload_t& payload = bundle.message.emplace_back();
      payload.channel = message.channel;
      payload.size = static_cast<std::int32_t>(message.payload.size());
      const auto* data = reinterpret_cast<const std::uint8_t*>(message.payload.data());
      payload.data.assign(data, data + message.payload.size());
    }
    bundle.count = static_cast<std::int32_t>(bundle.message.size());
    send(bundle);
  }
}

std::span<const std::byte> bytes_of(const shoal::sim_payload_t& message) {
  return {reinterpret_cast<const std::byte*>(message.data.data()), message.data.size()};
}

}  // namespace bridges
