// SPDX-License-Identifier: BSD-3-Clause
#include "viewer/server/message_feed.hpp"

#include <algorithm>
#include <set>

#include "viewer/page_data/message_frame.hpp"

namespace viewer {

void MessageFeed::subscribe(int client, const std::vector<Subscription>& subscriptions) {
  std::vector<Reader> readers;
  const std::vector<Reader>& before = readers_[client];
  for (const Subscription& subscription : subscriptions) {
    // Messages that the page already has are not sent again.
    const auto same = std::find_if(before.begin(), before.end(), [&](const Reader& reader) {
      return reader.subscription.channel == subscription.channel;
    });
    readers.push_back(same == before.end() ? Reader{subscription} : Reader{subscription, same->due, same->sent});
    channels_.try_emplace(subscription.channel);
  }
  readers_[client] = std::move(readers);
  drop_unread_channels();
}

void MessageFeed::remove(int client) {
  if (readers_.erase(client) > 0) drop_unread_channels();
}

void MessageFeed::drop_unread_channels() {
  std::set<std::string_view> read;
  for (const auto& [client, readers] : readers_)
    for (const Reader& reader : readers) read.insert(reader.subscription.channel);
  std::erase_if(channels_, [&](const auto& channel) {
    if (read.contains(channel.first)) return false;
    bytes_ -= channel.second.payload.size();
    return true;
  });
  // Without subscribers the past is not needed either.
  if (channels_.empty()) {
    past_.clear();
    past_bytes_ = 0;
  }
}

void MessageFeed::take(std::string_view channel, std::span<const std::byte> payload, std::int64_t time_us) {
  if (channels_.empty()) return;
  const auto place = channels_.find(channel);
  if (place == channels_.end()) return;
  set(place->second, payload, time_us);
  if (past_mode_ == Past::kept) keep(channel, payload, time_us);
}

void MessageFeed::set(Channel& place, std::span<const std::byte> payload, std::int64_t time_us) {
  if (bytes_ - place.payload.size() + payload.size() > max_bytes) return;
  bytes_ += payload.size() - place.payload.size();
  place.payload.assign(payload.begin(), payload.end());
  place.time_us = time_us;
  place.number = ++last_number_;
  place.frame.reset();
}

void MessageFeed::keep(std::string_view channel, std::span<const std::byte> payload, std::int64_t time_us) {
  if (payload.size() > max_past_bytes) return;
  past_bytes_ += payload.size();
  past_.push_back({std::string(channel), time_us, sim::Bytes(payload.begin(), payload.end())});
  constexpr std::size_t max_messages = 100'000;
  while (past_bytes_ > max_past_bytes || past_.size() > max_messages) {
    past_bytes_ -= past_.front().payload.size();
    past_.pop_front();
  }
}

void MessageFeed::discard() {
  for (auto& [name, channel] : channels_) channel = {};
  bytes_ = 0;
  for (auto& [client, readers] : readers_)
    for (Reader& reader : readers) reader.due = {};
}

void MessageFeed::rewind(std::int64_t time_us) {
  discard();
  while (!past_.empty() && past_.back().time_us > time_us) {
    past_bytes_ -= past_.back().payload.size();
    past_.pop_back();
  }
  for (const Earlier& earlier : past_) {
    const auto place = channels_.find(earlier.channel);
    if (place != channels_.end()) set(place->second, earlier.payload, earlier.time_us);
  }
}

void MessageFeed::flush() {
  if (channels_.empty()) return;
  const Clock::time_point now = Clock::now();
  for (auto& [client, readers] : readers_)
    for (Reader& reader : readers) send(client, reader, now);
}

void MessageFeed::send(int client, Reader& reader, Clock::time_point now) {
  // The calls are not at exact times: what is due within a part of their interval is sent, and counted as late as due.
  constexpr std::chrono::milliseconds early{8};
  if (reader.due > now + early) return;
  Channel& channel = channels_.find(reader.subscription.channel)->second;
  if (channel.number == 0 || channel.number == reader.sent) return;
  if (!channel.frame)
    channel.frame = std::make_shared<const std::string>(
        message_frame(shoal::embedded_types(), reader.subscription.channel, channel.payload, channel.time_us));
  server_.send_message(client, reader.subscription.channel, channel.frame);
  reader.sent = channel.number;
  const auto interval =
      std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double>(1 / reader.subscription.rate_hz));
  reader.due = std::max(reader.due, now) + interval;
}

}  // namespace viewer
