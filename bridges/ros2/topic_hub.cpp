// SPDX-License-Identifier: BSD-3-Clause
#include "bridges/ros2/topic_hub.hpp"

#include <algorithm>
#include <utility>

namespace bridges::ros2 {
namespace {

/// Channels that later messages, or later readers, need.
bool is_kept(std::string_view channel) {
  return channel == "sim.info" || channel == "sim.scene" || channel == "sim.asset";
}

/// Messages of a channel that are examined although no reader has subscribed: the first ones, then some, because a
/// standard type cannot express every message.
bool is_examined(std::uint64_t seen) {
  constexpr std::uint64_t first = 20, every = 50;
  return seen < first || seen % every == 0;
}

/// Returns the same text for kept messages of which the last is enough: a scene for another, an asset for itself, whose
/// hash follows after its fingerprint and time.
std::string replacement_key(const ChannelMessage& message) {
  constexpr std::size_t hash_at = 16, hash_bytes = 24;
  std::string key = message.channel;
  if (key == "sim.asset" && message.payload.size() > hash_at + hash_bytes)
    key.append(reinterpret_cast<const char*>(message.payload.data()) + hash_at, hash_bytes);
  return key;
}

}  // namespace

bool WaitingMessages::add(Need need, std::int64_t utime, std::string_view channel, std::span<const std::byte> payload) {
  const bool full = bytes + payload.size() > max_bytes || messages.size() >= max_messages;
  if (full && need != Need::kept) {
    if (need == Need::subscribed) ++dropped;
    return false;
  }
  bytes += payload.size();
  messages.push_back({utime, std::string(channel), {payload.begin(), payload.end()}});
  return true;
}

void WaitingMessages::add_jump(std::int64_t utime) {
  if (!messages.empty() && messages.back().channel.empty()) messages.pop_back();
  messages.push_back({utime, "", {}});
}

Need TopicHub::need(std::string_view channel, std::span<const std::byte> payload, bool has_readers) {
  const auto fingerprint = static_cast<std::uint64_t>(shoal::fingerprint(payload));
  const std::lock_guard lock(channels_mutex_);
  auto known = channels_.find(channel);
  const bool is_new = known == channels_.end() || known->second.fingerprint != fingerprint;
  if (known == channels_.end()) {
    if (channels_.size() >= max_channels) return Need::none;
    known = channels_.emplace(channel, Channel{}).first;
  }
  Channel& state = known->second;
  if (is_new) state.fingerprint = fingerprint;
  const bool examined = is_new || (has_readers && is_examined(state.seen));
  ++state.seen;
  if (is_kept(channel)) return Need::kept;
  if (state.subscribed) return Need::subscribed;
  return examined ? Need::examined : Need::none;
}

void TopicHub::add(TopicReader& reader) {
  encode_set_aside();
  readers_.push_back(&reader);
}

void TopicHub::encode(ChannelMessage& message) {
  readers_.empty() ? set_aside(message) : encode_now(message);
}

/// Sets a message aside for the first reader.
void TopicHub::set_aside(ChannelMessage& message) {
  constexpr std::size_t max_bytes = std::size_t{64} << 20;
  const auto bytes_of = [](const ChannelMessage& each) { return each.payload.size() + sizeof each; };
  const std::size_t end = set_aside_.size();
  const std::size_t place =
      is_kept(message.channel) ? replaceable_.emplace(replacement_key(message), end).first->second : end;
  if (place < end) set_aside_bytes_ -= bytes_of(set_aside_[place]);
  if (place == end) set_aside_.emplace_back();
  set_aside_bytes_ += bytes_of(message);
  set_aside_[place] = std::move(message);
  if (set_aside_bytes_ > max_bytes) encode_set_aside();
}

void TopicHub::encode_set_aside() {
  for (ChannelMessage& message : std::exchange(set_aside_, {})) encode_now(message);
  replaceable_.clear();
  set_aside_bytes_ = 0;
}

void TopicHub::encode_now(ChannelMessage& message) {
  pass(message);
  if (is_kept(message.channel) && message.channel != "sim.asset") last_[message.channel] = std::move(message);
}

void TopicHub::pass(const ChannelMessage& message) {
  present_ = &message;
  table_.encode(message.channel, message.payload, *this);
  present_ = nullptr;
}

bool TopicHub::wants(const Topic& topic) {
  if (topic.encoding != "cdr") return false;
  relate(topic);
  return target_ ? target_->topic == topic.number : subscribers_[topic.number] > 0;
}

bool TopicHub::take(const Topic& topic, std::span<const std::byte> bytes) {
  const auto cdr = std::make_shared<const std::string>(reinterpret_cast<const char*>(bytes.data()), bytes.size());
  if (target_) {
    target_->reader->push(topic, *present_, cdr);
    return true;
  }
  for (TopicReader* reader : readers_)
    if (reader->has_subscribed(topic.number)) reader->push(topic, *present_, cdr);
  return true;
}

/// Notes that the present channel fills a topic.
void TopicHub::relate(const Topic& topic) {
  if (subscribers_.size() <= topic.number) {
    subscribers_.resize(topic.number + 1);
    channels_of_topic_.resize(topic.number + 1);
  }
  if (!channels_of_topic_[topic.number].insert(present_->channel).second) return;
  topics_of_channel_[present_->channel].insert(topic.number);
  if (subscribers_[topic.number] > 0) update_wanted(present_->channel);
}

void TopicHub::count_subscription(std::size_t topic, int change) {
  subscribers_[topic] += change;
  if (subscribers_[topic] > 1 || (subscribers_[topic] == 1 && change < 0)) return;
  for (const std::string& channel : channels_of_topic_[topic]) update_wanted(channel);
}

void TopicHub::update_wanted(const std::string& channel) {
  const std::set<std::size_t>& topics = topics_of_channel_[channel];
  const bool subscribed =
      std::any_of(topics.begin(), topics.end(), [this](std::size_t topic) { return subscribers_[topic] > 0; });
  const std::lock_guard lock(channels_mutex_);
  if (const auto known = channels_.find(channel); known != channels_.end()) known->second.subscribed = subscribed;
}

void TopicHub::send_latched(TopicReader& reader, std::size_t topic) {
  target_ = Target{&reader, topic};
  for (const std::string& channel : channels_of_topic_[topic])
    if (const auto last = last_.find(channel); last != last_.end()) pass(last->second);
  target_.reset();
}

}  // namespace bridges::ros2
