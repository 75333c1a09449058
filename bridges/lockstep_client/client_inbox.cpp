// SPDX-License-Identifier: BSD-3-Clause
#include "bridges/lockstep_client/client_inbox.hpp"

#include <algorithm>

#include "bridges/lockstep_client/resend.hpp"
#include "sim/base/crc32.hpp"

namespace bridges {
namespace {

/// Channels of the handshake and its reports: no tick names their messages, and handlers are called on arrival.
constexpr std::string_view unnamed_channels[] = {"sim.ack",    "sim.control", "sim.control.reply", "sim.hash",
                                                 "sim.info",   "sim.inputs",  "sim.audit",         "sim.resend",
                                                 "sim.resent", "sim.tick"};

constexpr std::size_t max_recent = 8192;
constexpr std::size_t max_held = 100'000;
/// Number of ticks after which an unnamed message is no longer expected in a list.
constexpr int hold_ticks = 3;

}  // namespace

bool ClientInbox::is_named(std::string_view channel) {
  return std::find(std::begin(unnamed_channels), std::end(unnamed_channels), channel) == std::end(unnamed_channels);
}

void ClientInbox::add_channel(const std::string& channel) {
  if (!places_.emplace(channel, names_.size()).second) return;
  names_.push_back(channel);
  held_.emplace_back();
}

bool ClientInbox::hold(Received& message) {
  const auto place = places_.find(message.channel);
  if (place == places_.end()) return false;
  std::deque<Held>& held = held_[place->second];
  held.push_back({sim::crc32(message.payload), std::move(message.payload)});
  if (held.size() > max_held) held.pop_front();  // if a tick names it, it is requested
  return true;
}

bool ClientInbox::expect(const shoal::sim_due_t& due) {
  std::vector<Named> named;
  for (std::size_t i = 0; i < due.channel.size(); ++i) {
    const auto channel = static_cast<std::size_t>(due.channel[i]);
    if (channel >= names_.size()) return false;
    named.push_back({channel, static_cast<std::uint32_t>(due.crc[i]), false, {}});
  }
  named_ = std::move(named);
  return true;
}

bool ClientInbox::complete() {
  bool all = true;
  for (Named& named : named_) {
    if (named.there) continue;
    std::deque<Held>& held = held_[named.channel];
    // Equal messages on a channel are interchangeable, so the checksum identifies them.
    const auto found = std::find_if(held.begin(), held.end(), [&](const Held& each) { return each.crc == named.crc; });
    if (found == held.end()) {
      all = false;
      continue;
    }
    named.payload = std::move(found->payload);
    named.there = true;
    held.erase(found);
  }
  return all;
}

std::int32_t ClientInbox::first_missing() const {
  const auto missing = std::find_if(named_.begin(), named_.end(), [](const Named& named) { return !named.there; });
  return static_cast<std::int32_t>(missing - named_.begin());
}

void ClientInbox::add(std::int32_t first, const std::vector<shoal::sim_payload_t>& messages) {
  if (first < 0) return;
  for (std::size_t i = 0; i < messages.size(); ++i) {
    const std::size_t place = static_cast<std::size_t>(first) + i;
    if (place >= named_.size()) return;
    Named& named = named_[place];
    const std::span<const std::byte> bytes = bytes_of(messages[i]);
    // A resent message is recognized by its place and its checksum; the first copy counts.
    if (named.there || sim::crc32(bytes) != named.crc) continue;
    named.payload.assign(bytes.begin(), bytes.end());
    named.there = true;
    ++counts_.requested;
  }
}

void ClientInbox::hand_over(const Handle& handle) {
  for (Named& named : std::exchange(named_, {})) {
    // Skip a message that was handled before a tick named it.
    if (early_.erase({named.channel, named.crc}) > 0) continue;
    remember({named.channel, named.crc});
    handle(std::string(names_[named.channel]), named.payload);  // a copy: handlers may add channels
  }
  hand_over_unnamed(handle);
}

void ClientInbox::hand_over_unnamed(const Handle& handle) {
  for (std::size_t i = 0; i < held_.size(); ++i) {
    std::deque<Held> keep;
    for (Held& held : std::exchange(held_[i], {})) {
      if (recent_.contains({i, held.crc})) {
        ++counts_.repeated;
      } else if (++held.ticks < hold_ticks) {
        // The tick that names a message may come after it; messages that no tick names are handed over after some
        // ticks.
        keep.push_back(std::move(held));
      } else {
        ++counts_.unnamed;
        remember({i, held.crc});
        if (early_.size() < max_recent) early_.insert({i, held.crc});
        handle(std::string(names_[i]), held.payload);
      }
    }
    held_[i].swap(keep);
  }
}

void ClientInbox::remember(const Key& key) {
  if (!recent_.insert(key).second) return;
  recent_order_.push_back(key);
  if (recent_order_.size() <= max_recent) return;
  recent_.erase(recent_order_.front());
  early_.erase(recent_order_.front());
  recent_order_.pop_front();
}

void ClientInbox::drop_held() {
  for (std::deque<Held>& held : held_) held.clear();
}

void ClientInbox::discard() {
  drop_held();
  recent_.clear();
  recent_order_.clear();
  early_.clear();
}

}  // namespace bridges
