// SPDX-License-Identifier: BSD-3-Clause
#include "bridges/rosbridge/rosbridge_protocol.hpp"

#include <spdlog/spdlog.h>

#include <algorithm>
#include <utility>

#include "bridges/base/json_text.hpp"
#include "bridges/rosbridge/rosbridge_message.hpp"
#include "bridges/rosbridge/rosbridge_session.hpp"
#include "bridges/web/http_check.hpp"

namespace bridges::rosbridge {

// --- Functions for all threads

void Protocol::message(std::int64_t utime, std::string_view channel, std::span<const std::byte> payload) {
  topics_.gather(exchange_, utime, channel, payload);
}

void Protocol::set_commands(std::vector<CommandTopic> commands) {
  exchange_.put([&](Box& box) { box.commands = std::move(commands); });
}

void Protocol::release() {
  if (held_.load() > 0) exchange_.put([](Box&) {});
}

void Protocol::reply(const Request& request, bool ok, const std::string& text) {
  std::string answer = service_response_text(request.service, request.id, true, {{"success", ok}, {"message", text}});
  exchange_.put([&](Box& box) { box.replies.push_back({request.client, std::move(answer)}); });
}

// --- Functions of the thread of the server

std::size_t Protocol::max_message_bytes() const {
  return max_client_message_bytes;
}

bool Protocol::admits(std::string_view query) const {
  return !is_token_ || has_token(query, is_token_);
}

std::unique_ptr<WebSession> Protocol::open(WebLink& link) {
  auto session = std::make_unique<Session>(*this, link);
  exchange_.add(*session);
  topics_.add(*session);
  exchange_.count_client(1);
  return session;
}

void Protocol::left(const Session& session) {
  exchange_.remove(session);
  topics_.remove(session);
  exchange_.count_client(-1);
}

void Protocol::warn_of_drops() {
  if (std::exchange(warned_of_drops_, true)) return;
  spdlog::warn(
      "a rosbridge client reads more slowly than messages come: some are dropped and the client is notified (further "
      "clients are not reported here)");
}

void Protocol::deliver(Box box) {
  if (box.commands) {
    commands_.clear();
    for (CommandTopic& each : *box.commands) commands_.insert_or_assign(each.topic, std::move(each));
  }
  for (ros2::ChannelMessage& message : box.waiting.messages) {
    utime_ = message.utime;
    topics_.encode(message);
    // A subscription may have waited for the topic that began with this message.
    for (Session* session : exchange_.sessions()) session->bind_new_topics();
  }
  for (Session* session : exchange_.sessions()) {
    for (Reply& reply : box.replies)
      if (reply.client == session->link_.number()) session->answer(std::move(reply.text));
    session->count_dropped(box.waiting.dropped);
    session->link_.wake();
  }
}

void Protocol::count_subscription(std::size_t topic, int change) {
  if (change > 0) ++subscriptions_;
  topics_.count_subscription(topic, change);
}

Protocol::Bytes Protocol::publish_text(std::size_t topic, const Bytes& cdr) {
  auto known = shown_.find(topic);
  if (known == shown_.end()) {
    const ros2::Topic& of = topics_.topics()[topic];
    std::string begin = R"({"op":"publish","topic":)" + json_text(nlohmann::json(of.name)) + ",\"msg\":";
    known = shown_.emplace(topic, Shown{RosType(of.type, of.schema), std::move(begin), nullptr, nullptr}).first;
  }
  Shown& shown = known->second;
  if (shown.cdr != cdr) {
    std::string text;
    if (shown.text) text.reserve(shown.text->size() + shown.begin.size());
    text += shown.begin;
    append_json(shown.type, *cdr, text);
    text += '}';
    shown.cdr = cdr;
    shown.text = std::make_shared<const std::string>(std::move(text));
  }
  return shown.text;
}

const RosType& Protocol::command_type(const CommandTopic::Type& type) {
  const auto known = command_types_.find(type.name);
  if (known != command_types_.end()) return known->second;
  return command_types_.emplace(type.name, RosType(type.name, schema_of(graph(), type.name))).first->second;
}

}  // namespace bridges::rosbridge
