// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <chrono>
#include <cstddef>
#include <functional>
#include <span>
#include <string>

#include "shoal/sim_resent_t.hpp"

namespace bridges {

// What both ends of the lockstep have in common when something is lost.

/// A message in transit arrives within this time; after it, the message is requested.
constexpr std::chrono::milliseconds resend_grace{1};
/// What was not answered is sent again after the first interval, then after twice as long, up to the last.
constexpr std::chrono::milliseconds first_resend_interval{20}, last_resend_interval{250};

inline std::chrono::milliseconds next_resend_interval(std::chrono::milliseconds interval) {
  return std::min(2 * interval, last_resend_interval);
}

/// Sends the messages `first` to `count` - 1 of a list, in bundles of up to 60 kB: the loss of one loses no more.
/// `head` has what all bundles have in common.  `message_at` gives channel and bytes of a place in the list.
struct ResentMessage {
  const std::string& channel;
  std::span<const std::byte> payload;
};
void send_bundles(shoal::sim_resent_t head, std::size_t first, std::size_t count,
                  const std::function<ResentMessage(std::size_t place)>& message_at,
                  const std::function<void(const shoal::sim_resent_t&)>& send);

/// The bytes of a message in a bundle.
std::span<const std::byte> bytes_of(const shoal::sim_payload_t& message);

}  // namespace bridges
