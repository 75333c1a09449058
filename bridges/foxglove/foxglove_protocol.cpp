// SPDX-License-Identifier: BSD-3-Clause
#include "bridges/foxglove/foxglove_protocol.hpp"

#include <spdlog/spdlog.h>

#include <algorithm>
#include <utility>

#include "bridges/foxglove/foxglove_services.hpp"
#include "bridges/foxglove/foxglove_session.hpp"
#include "bridges/web/http_check.hpp"

namespace bridges::foxglove {

// --- Functions for all threads

void Protocol::introduce(ServerInfo info) {
  exchange_.put([&](Box& box) { box.info = std::move(info); });
}

void Protocol::message(std::int64_t utime, std::string_view channel, std::span<const std::byte> payload) {
  topics_.gather(exchange_, utime, channel, payload);
}

void Protocol::show_time(std::int64_t utime) {
  if (clients() > 0) exchange_.put([&](Box& box) { box.time = utime; });
}

void Protocol::jump(std::int64_t utime) {
  if (clients() == 0) return;
  exchange_.put([&](Box& box) {
    box.waiting.add_jump(utime);
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
  return !is_token_ || has_token(query, is_token_);
}

std::unique_ptr<WebSession> Protocol::open(WebLink& link) {
  auto session = std::make_unique<Session>(*this, link);
  exchange_.add(*session);
  topics_.add(*session);
  session->time_ = time_;
  exchange_.count_client(1);
  return session;
}

void Protocol::left(const Session& session) {
  exchange_.remove(session);
  topics_.remove(session);
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
  for (ros2::ChannelMessage& entry : box.waiting.messages) {
    if (entry.channel.empty())
      process_jump(entry.utime);
    else
      topics_.encode(entry);
  }
  if (box.time) {
    time_ = box.time;
    for (Session* session : exchange_.sessions()) session->time_ = box.time;
  }
  if (box.state) process(*box.state);
  for (const Reply& reply : box.replies) process(reply);
  for (Session* session : exchange_.sessions()) {
    session->count_dropped(box.waiting.dropped);
    session->link_.wake();
  }
}

/// Viewers take an earlier time as a jump and forget what they have, so that it comes first.
void Protocol::process_jump(std::int64_t utime) {
  time_ = utime;
  for (Session* session : exchange_.sessions()) {
    session->jump(utime);
    for (const auto& [topic, id] : session->by_topic_)
      if (topics_.topics()[topic].latched) topics_.send_latched(*session, topic);
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

void Protocol::count_subscription(std::size_t topic, int change) {
  if (change > 0) ++subscriptions_;
  topics_.count_subscription(topic, change);
}

}  // namespace bridges::foxglove
