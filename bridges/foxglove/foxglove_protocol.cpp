// SPDX-License-Identifier: BSD-3-Clause
#include "bridges/foxglove/foxglove_protocol.hpp"

#include <spdlog/spdlog.h>

#include <algorithm>
#include <utility>

#include "bridges/foxglove/foxglove_services.hpp"
#include "bridges/foxglove/foxglove_session.hpp"
#include "shoal/message_codec.hpp"

namespace bridges::foxglove {
namespace {

/// Channels that later messages, or later clients, need.
bool is_kept(std::string_view channel) {
  return channel == "sim.info" || channel == "sim.scene" || channel == "sim.asset";
}

/// Messages of a channel that are examined although no client has subscribed: the first ones, then some, because a
/// standard type cannot express every message.
bool is_examined(std::uint64_t seen) {
  constexpr std::uint64_t first = 20, every = 50;
  return seen < first || seen % every == 0;
}

}  // namespace

// --- Functions for all threads

void Protocol::introduce(ServerInfo info) {
  exchange_.put([&](Box& box) { box.info = std::move(info); });
}

void Protocol::message(std::int64_t utime, std::string_view channel, std::span<const std::byte> payload) {
  const auto fingerprint = static_cast<std::uint64_t>(shoal::fingerprint(payload));
  const bool kept = is_kept(channel);
  exchange_.put([&](Box& box) {
    // Decide whether it is of use
    auto known = channels_.find(channel);
    const bool is_new = known == channels_.end() || known->second.fingerprint != fingerprint;
    if (known == channels_.end()) {
      if (channels_.size() >= max_channels) return false;
      known = channels_.emplace(channel, Channel{}).first;
    }
    Channel& state = known->second;
    if (is_new) state.fingerprint = fingerprint;
    const bool examined = is_new || (clients() > 0 && is_examined(state.seen));
    ++state.seen;
    if (!kept && !state.subscribed && !examined) return false;

    // The thread of the server empties the box at once unless the machine is overloaded
    const bool full =
        box.bytes + payload.size() > max_undelivered_bytes || box.entries.size() >= max_undelivered_messages;
    if (full && !kept) {
      if (state.subscribed) ++box.dropped;
      return false;
    }
    box.bytes += payload.size();
    box.entries.push_back({utime, std::string(channel), {payload.begin(), payload.end()}});
    return true;
  });
}

void Protocol::show_time(std::int64_t utime) {
  if (clients() > 0) exchange_.put([&](Box& box) { box.time = utime; });
}

void Protocol::jump(std::int64_t utime) {
  if (clients() == 0) return;
  exchange_.put([&](Box& box) {
    // Several jumps without a message between are one.
    if (!box.entries.empty() && box.entries.back().channel.empty()) box.entries.pop_back();
    box.entries.push_back({utime, "", {}});
    box.time.reset();
  });
}

void Protocol::set_state(const PlaybackState& state) {
  if (clients() > 0) exchange_.put([&](Box& box) { box.state = state; });
}

void Protocol::reply(const Request& request, bool ok, std::string text) {
  exchange_.put([&](Box& box) { box.replies.push_back({request, ok, std::move(text)}); });
}

// --- Functions of the thread of the server

bool Protocol::admits(std::string_view query) const {
  if (!is_token_) return true;
  while (!query.empty()) {
    const std::size_t end = std::min(query.find('&'), query.size());
    const std::string_view part = query.substr(0, end);
    if (part.starts_with("t=") && is_token_(part.substr(2))) return true;
    query.remove_prefix(std::min(end + 1, query.size()));
  }
  return false;
}

std::unique_ptr<WebSession> Protocol::open(WebLink& link) {
  auto session = std::make_unique<Session>(*this, link);
  exchange_.add(*session);
  session->time_ = time_;
  exchange_.count_client(1);
  return session;
}

void Protocol::left(const Session& session) {
  exchange_.remove(session);
  if (exchange_.count_client(-1) == 0) time_.reset();  // it is not set any more
}

void Protocol::warn_of_drops() {
  if (std::exchange(warned_of_drops_, true)) return;
  spdlog::warn(
      "a Foxglove client reads more slowly than messages come: some are dropped and the client is notified (further "
      "clients are not reported here)");
}

void Protocol::deliver(Box box) {
  if (box.info) info_ = std::move(box.info);
  for (Entry& entry : box.entries) process(entry);
  if (box.time) {
    time_ = box.time;
    for (Session* session : exchange_.sessions()) session->time_ = box.time;
  }
  if (box.state) process(*box.state);
  for (const Reply& reply : box.replies) process(reply);
  for (Session* session : exchange_.sessions()) {
    session->count_dropped(box.dropped);
    session->link_.wake();
  }
}

void Protocol::process(Entry& entry) {
  if (entry.channel.empty()) return process_jump(entry.utime);
  encode(entry);
  if (is_kept(entry.channel) && entry.channel != "sim.asset") last_[entry.channel] = std::move(entry);
}

void Protocol::encode(const Entry& entry) {
  present_ = &entry;
  table_.encode(entry.channel, entry.payload, *this);
  present_ = nullptr;
}

/// Viewers take an earlier time as a jump and forget what they have, so that it comes first.
void Protocol::process_jump(std::int64_t utime) {
  time_ = utime;
  for (Session* session : exchange_.sessions()) {
    session->jump(utime);
    for (const auto& [topic, id] : session->by_topic_)
      if (table_.topics()[topic].latched) send_latched(*session, topic);
  }
}

void Protocol::process(const PlaybackState& state) {
  const bool changed = state.status != state_.status || state.speed != state_.speed;
  state_ = state;
  if (!changed) return;
  for (Session* session : exchange_.sessions()) {
    session->show_parameters(state);
    if (session->gets_playback_) session->answer(playback_data(state, false, ""), false);
  }
}

void Protocol::process(const Reply& reply) {
  const Request& request = reply.request;
  const std::vector<Session*>& sessions = exchange_.sessions();
  const auto found = std::find_if(sessions.begin(), sessions.end(),
                                  [&](const Session* each) { return each->link_.number() == request.client; });
  // The client may have closed its connection while the run answered.
  if (found == sessions.end()) return;
  Session& session = **found;
  switch (request.kind) {
    case Request::Kind::service:
      session.answer(service_response_data(request.call.service, request.call.call, request.call.encoding,
                                           response(request.call.encoding, reply.ok, reply.text)),
                     false);
      break;
    case Request::Kind::parameter:
      if (!reply.ok) session.report(StatusLevel::error, request.command + ": " + reply.text);
      if (request.id) session.answer(parameters_text(state_, request.names, request.id));
      break;
    case Request::Kind::playback:
      session.gets_playback_ = true;
      if (!reply.ok) session.report(StatusLevel::error, reply.text);
      session.answer(playback_data(state_, request.playback.seek_us.has_value(), request.playback.id), false);
  }
}

bool Protocol::wants(const ros2::Topic& topic) {
  if (topic.encoding != "cdr") return false;
  relate(topic);
  return target_ ? target_->topic == topic.number : subscribers_[topic.number] > 0;
}

bool Protocol::take(const ros2::Topic& topic, std::span<const std::byte> bytes) {
  const auto payload = std::make_shared<const std::string>(reinterpret_cast<const char*>(bytes.data()), bytes.size());
  if (target_) {
    target_->session->push(topic, present_->utime, payload, present_->channel);
    return true;
  }
  for (Session* session : exchange_.sessions())
    if (session->has_subscribed(topic.number)) session->push(topic, present_->utime, payload, present_->channel);
  return true;
}

/// Notes that the present channel fills a topic.
void Protocol::relate(const ros2::Topic& topic) {
  if (subscribers_.size() <= topic.number) {
    subscribers_.resize(topic.number + 1);
    channels_of_topic_.resize(topic.number + 1);
  }
  if (!channels_of_topic_[topic.number].insert(present_->channel).second) return;
  topics_of_channel_[present_->channel].insert(topic.number);
  if (subscribers_[topic.number] > 0) update_wanted(present_->channel);
}

void Protocol::count_subscription(std::size_t topic, int change) {
  subscribers_[topic] += change;
  if (change > 0) ++subscriptions_;
  if (subscribers_[topic] > 1 || (subscribers_[topic] == 1 && change < 0)) return;
  for (const std::string& channel : channels_of_topic_[topic]) update_wanted(channel);
}

void Protocol::update_wanted(const std::string& channel) {
  const std::set<std::size_t>& topics = topics_of_channel_[channel];
  const bool subscribed =
      std::any_of(topics.begin(), topics.end(), [this](std::size_t topic) { return subscribers_[topic] > 0; });
  exchange_.with_box([&](Box&) {
    if (const auto known = channels_.find(channel); known != channels_.end()) known->second.subscribed = subscribed;
  });
}

void Protocol::send_latched(Session& session, std::size_t topic) {
  target_ = Target{&session, topic};
  for (const std::string& channel : channels_of_topic_[topic])
    if (const auto last = last_.find(channel); last != last_.end()) encode(last->second);
  target_.reset();
}

}  // namespace bridges::foxglove
