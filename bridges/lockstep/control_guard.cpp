// SPDX-License-Identifier: BSD-3-Clause
#include "bridges/lockstep/control_guard.hpp"

#include <algorithm>
#include <limits>

#include "bridges/signing/signed_message.hpp"
#include "sim/config/message_text.hpp"

namespace bridges {

ControlGuard::Opened ControlGuard::open(std::string_view channel, std::span<const std::byte> payload) {
  Opened opened;
  if (!is_signed(payload)) {
    // The content is returned even if refused: the service needs the client's name to answer it and for the audit.
    opened.content.assign(payload.begin(), payload.end());
    if (key_) opened.refusal = needs_key_text;
    return opened;
  }
  SignedMessage message = read_signed(payload);
  opened.content = std::move(message.content);
  if (!key_) return opened;
  const std::string called = "the message is signed by '" + sim::printable(message.sender) + "', but ";
  // The MAC covers the channel, so that a signed message cannot be replayed on another one.
  if (!has_mac_of(*key_, channel, payload)) {
    opened.refusal = called + "not with the key of this run for channel '" + std::string(channel) + "'";
    return opened;
  }
  opened.signer = message.sender;
  if (const std::string why = refusal_of(message, channel, opened.came_before); !why.empty())
    opened.refusal = called + why;
  return opened;
}

std::string ControlGuard::refusal_of(const SignedMessage& message, std::string_view channel, bool& came_before) {
  const std::int64_t counter = message.counter;
  if (counter <= 0) return "its counter must be above 0, got " + std::to_string(counter);
  // Find or add the sender.
  const Name key{message.sender, message.session};
  auto known = senders_.find(key);
  if (known == senders_.end()) {
    if (counter <= floor_)
      return "its counter " + std::to_string(counter) + " is not above " + std::to_string(floor_) +
             ": start from the wall clock in microseconds";
    if (senders_.size() >= max_senders) make_room();
    by_age_.push_back(key);
    known = senders_.emplace(key, Sender{{}, std::prev(by_age_.end())}).first;
  }
  // Compare with its last counter on this channel.
  Sender& sender = known->second;
  const auto last = sender.counters.find(channel);
  came_before = last != sender.counters.end() && counter <= last->second;
  if (came_before)
    return "its counter " + std::to_string(counter) + " is not above the last one, " + std::to_string(last->second) +
           ": it was sent before, and was received again";
  sender.counters.insert_or_assign(std::string(channel), counter);
  by_age_.splice(by_age_.end(), by_age_, sender.place);
  return "";
}

void ControlGuard::make_room() {
  const auto oldest = senders_.find(by_age_.front());
  for (const auto& [channel, counter] : oldest->second.counters) floor_ = std::max(floor_, counter);
  senders_.erase(oldest);
  by_age_.pop_front();
}

}  // namespace bridges
