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

// Repetition of lost messages, common to both ends of the lockstep.

/// Time within which a message in transit arrives; after it, the message is requested.
constexpr std::chrono::milliseconds resend_grace{1};
/// Intervals of the repetition of unanswered messages: exponential back-off from the first, doubled up to the last.
constexpr std::chrono::milliseconds first_resend_interval{20}, last_resend_interval{250};

inline std::chrono::milliseconds next_resend_interval(std::chrono::milliseconds interval) {
  return std::min(2 * interval, last_resend_interval);
}

/// Sends the messages `first` to `count` - 1 of a list, in bundles of up to 60 kB, which limits the effect of a lost
/// one.  `head`: fields common to all bundles.  `message_at`: returns channel and bytes of an index of the list.
struct ResentMessage {
  const std::string& channel;
  std::span<const std::byte> payload;
};
void send_bundles(shoal::sim_resent_t head, std::size_t first, std::size_t count,
                  const std::function<ResentMessage(std::size_t place)>& message_at,
                  const std::function<void(const shoal::sim_resent_t&)>& send);

/// Returns the bytes of a message in a bundle.
std::span<const std::byte> bytes_of(const shoal::sim_payload_t& message);

}  // namespace bridges
