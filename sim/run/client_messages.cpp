// SPDX-License-Identifier: BSD-3-Clause
#include "sim/run/client_messages.hpp"

#include <algorithm>
#include <cstdio>
#include <utility>

#include "sim/base/crc32.hpp"
#include "sim/config/message_text.hpp"

namespace sim {
namespace {

std::string text_of(const NamedMessage& named) {
  char crc[32];
  std::snprintf(crc, sizeof crc, "' with CRC-32 %08x", static_cast<unsigned>(named.crc));
  return "'" + printable(shortened(named.channel)) + crc;
}

}  // namespace

void ClientMessages::expect(const std::string& client, const std::vector<NamedMessage>& named) {
  std::vector<Expected>& list = expected_[client];
  list.clear();
  for (const NamedMessage& each : named) list.push_back({each, gate_.reads(each.channel), false, false, {}});
  match(list);
}

void ClientMessages::collect() {
  gate_.collect();
  take(gate_.waiting());
  for (auto& [client, list] : expected_) match(list);
}

void ClientMessages::take(std::vector<MessageGate::Delivery>& messages) {
  for (MessageGate::Delivery& each : messages) {
    const std::uint32_t crc = crc32(each.payload);
    const std::uint64_t arrival = arrivals_++;
    stray_bytes_ += each.payload.size();
    std::set<std::uint64_t>& of_channel = by_channel_[each.channel];
    of_channel.insert(arrival);
    by_key_[{each.channel, crc}].insert(arrival);
    strays_.emplace(arrival, Stray{std::move(each), crc});
    if (of_channel.size() > max_of_channel) drop_oldest(*of_channel.begin());
    // A client that publishes outside of its ticks must not fill the memory; the oldest message goes first.
    while (stray_bytes_ > max_bytes) drop_oldest(strays_.begin()->first);
  }
  messages.clear();
}

ClientMessages::Stray ClientMessages::take_out(Strays::iterator stray) {
  const std::uint64_t arrival = stray->first;
  Stray taken = std::move(stray->second);
  strays_.erase(stray);
  stray_bytes_ -= taken.message.payload.size();
  const auto channel = by_channel_.find(taken.message.channel);
  channel->second.erase(arrival);
  if (channel->second.empty()) by_channel_.erase(channel);
  const auto key = by_key_.find({taken.message.channel, taken.crc});
  key->second.erase(arrival);
  if (key->second.empty()) by_key_.erase(key);
  return taken;
}

void ClientMessages::drop_oldest(std::uint64_t arrival) {
  take_out(strays_.find(arrival));
  ++dropped_;
}

void ClientMessages::match(std::vector<Expected>& list) {
  if (strays_.empty()) return;
  for (Expected& expected : list) {
    if (!expected.is_read || expected.there) continue;
    const auto found = by_key_.find({expected.named.channel, expected.named.crc});
    if (found == by_key_.end()) continue;
    expected.payload = take_out(strays_.find(*found->second.begin())).message.payload;
    expected.there = true;
  }
}

bool ClientMessages::is_complete(const std::string& client) const {
  return first_missing(client) < 0;
}

std::int32_t ClientMessages::first_missing(const std::string& client) const {
  const auto found = expected_.find(client);
  if (found == expected_.end()) return -1;
  for (std::size_t i = 0; i < found->second.size(); ++i)
    if (found->second[i].is_read && !found->second[i].there) return static_cast<std::int32_t>(i);
  return -1;
}

std::vector<std::string> ClientMessages::missing_channels(const std::string& client) const {
  std::vector<std::string> channels;
  if (const auto found = expected_.find(client); found != expected_.end())
    for (const Expected& expected : found->second)
      if (expected.is_read && !expected.there) channels.push_back(expected.named.channel);
  return channels;
}

std::string ClientMessages::missing_text(const std::string& client) const {
  const auto found = expected_.find(client);
  const std::int32_t first = first_missing(client);
  if (first < 0) return "";
  const std::vector<Expected>& list = found->second;
  const auto missing = std::count_if(list.begin(), list.end(),
                                     [](const Expected& expected) { return expected.is_read && !expected.there; });
  return std::to_string(missing) + " of the " + std::to_string(list.size()) +
         " messages that it lists were not received, first " + text_of(list[static_cast<std::size_t>(first)].named);
}

std::string ClientMessages::why_not(const std::string& client, std::int32_t place, const std::string& channel,
                                    const Bytes& payload) const {
  const std::string sent = "sends again " + text_of({channel, crc32(payload)}) + " at place " + std::to_string(place);
  const auto found = expected_.find(client);
  if (found == expected_.end() || place < 0 || static_cast<std::size_t>(place) >= found->second.size())
    return sent + ", but named " + std::to_string(found == expected_.end() ? 0 : found->second.size());
  return sent + ", but named " + text_of(found->second[static_cast<std::size_t>(place)].named);
}

bool ClientMessages::add(const std::string& client, std::int32_t place, const std::string& channel,
                         const Bytes& payload) {
  const auto found = expected_.find(client);
  if (found == expected_.end()) return true;  // it has arrived meanwhile, and the list was admitted
  if (place < 0 || static_cast<std::size_t>(place) >= found->second.size()) return false;
  Expected& expected = found->second[static_cast<std::size_t>(place)];
  if (expected.named.channel != channel || expected.named.crc != crc32(payload)) return false;
  if (!expected.is_read || expected.there) return true;
  expected.payload = payload;
  expected.there = expected.sent_again = true;
  return true;
}

void ClientMessages::give_up(const std::string& client) {
  const auto found = expected_.find(client);
  if (found == expected_.end()) return;
  for (Expected& expected : found->second) expected.is_read = expected.there;
}

void ClientMessages::drop(const std::string& client, const std::vector<NamedMessage>& named) {
  for (const NamedMessage& each : named) {
    const auto found = by_key_.find({each.channel, each.crc});
    const bool there = found != by_key_.end();
    if (there) take_out(strays_.find(*found->second.begin()));
    expect_twin(client, each, there ? repeat_windows : late_windows, false);
  }
}

void ClientMessages::drop_unnamed() {
  dropped_ += strays_.size();
  discard_strays();
}

void ClientMessages::clear() {
  twins_.clear();
  for (const auto& [client, list] : expected_)
    for (const Expected& expected : list)
      if (expected.is_read) expect_twin(client, expected.named, expected.there ? repeat_windows : late_windows, false);
  expected_.clear();
  discard_strays();
  gate_.waiting().clear();
}

void ClientMessages::discard_strays() {
  strays_.clear();
  by_key_.clear();
  by_channel_.clear();
  stray_bytes_ = 0;
}

void ClientMessages::expect_twin(const std::string& client, const NamedMessage& named, std::int64_t windows,
                                 bool counts) {
  if (twins_.size() < max_twins) twins_.insert({{named.channel, named.crc}, {client, window_ + windows, counts}});
}

bool ClientMessages::is_twin(const Stray& stray) {
  const auto twin = twins_.find({stray.message.channel, stray.crc});
  if (twin == twins_.end()) return false;
  if (const std::string& client = twin->second.client; twin->second.counts) {
    if (repeated_.size() < max_names || repeated_.contains(client)) ++repeated_[client];
    if (!first_repeated_) first_repeated_ = Repeated{client, stray.message.channel};
  }
  twins_.erase(twin);
  return true;
}

void ClientMessages::next_window() {
  ++window_;
  std::erase_if(twins_, [this](const auto& entry) { return entry.second.last_window < window_; });
}

std::optional<ClientMessages::Repeated> ClientMessages::take_repeated() {
  return std::exchange(first_repeated_, std::nullopt);
}

void ClientMessages::order(std::vector<MessageGate::Delivery>& messages) {
  if (expected_.empty() && strays_.empty() && twins_.empty()) return;  // no client lists its messages
  take(messages);
  for (auto& [client, list] : expected_) {
    match(list);
    for (Expected& expected : list) {
      if (!expected.there) continue;
      expect_twin(client, expected.named, expected.sent_again ? late_windows : repeat_windows, true);
      messages.push_back({std::move(expected.named.channel), std::move(expected.payload)});
    }
  }
  expected_.clear();
  for (auto& [arrival, stray] : strays_)
    if (!is_twin(stray)) messages.push_back(std::move(stray.message));
  discard_strays();
}

}  // namespace sim
