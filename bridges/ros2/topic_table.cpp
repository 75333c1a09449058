// SPDX-License-Identifier: BSD-3-Clause
#include "bridges/ros2/topic_table.hpp"

#include <utility>

#include "bridges/ros2/cdr.hpp"
#include "bridges/ros2/ros2_names.hpp"
#include "bridges/ros2/ros2_schema.hpp"

namespace bridges::ros2 {

bool TopicTable::encode(std::string_view channel, std::span<const std::byte> payload, TopicSink& sink) {
  const shoal::MessageSchema* schema = types_->find(static_cast<std::uint64_t>(shoal::fingerprint(payload)));
  // Keep what cannot be transcoded.
  if (schema == nullptr) return keep_bytes(channel, payload, sink);
  Route* route = nullptr;
  if (const auto of_channel = routes_.find(channel); of_channel != routes_.end())
    if (const auto known = of_channel->second.find(schema->fingerprint); known != of_channel->second.end())
      route = &known->second;
  const bool is_taken = route == nullptr || sink.wants(topics_[route->topic]);
  const auto error = is_taken ? to_cdr(*schema, payload, cdr_) : shoal::validate(*schema, payload, shoal::Finite::any);
  if (error) {
    sink.invalid(channel, *error);
    return keep_bytes(channel, payload, sink);
  }
  // Pass it on to the topics of the message.
  if (route == nullptr) route = &route_of(channel, *schema);
  const Topic& topic = topics_[route->topic];
  if (is_taken && sink.wants(topic) && !sink.take(topic, cdr_)) return false;
  return encode_standard(*route, channel, payload, sink);
}

bool TopicTable::has(std::string_view channel, std::uint64_t fingerprint) const {
  const auto of_channel = routes_.find(channel);
  if (of_channel != routes_.end() && of_channel->second.contains(fingerprint)) return true;
  return raw_topics_.contains(channel);
}

TopicTable::Route& TopicTable::route_of(std::string_view channel, const shoal::MessageSchema& schema) {
  Topic topic;
  topic.type = type_name(schema.name);
  topic.name = own_topic(topic_of(channel), std::string(channel) + " " + topic.type);
  topic.encoding = "cdr";
  topic.schema = schema_text(schema);
  topic.lcm_channel = channel;
  topic.lcm_type = schema.name;
  Route route;
  route.topic = add(std::move(topic));
  for (const Converter* converter : ConverterTable::instance().of(schema.name))
    route.standard.push_back({converter, std::nullopt});
  return routes_[std::string(channel)].emplace(schema.fingerprint, std::move(route)).first->second;
}

bool TopicTable::encode_standard(Route& route, std::string_view channel, std::span<const std::byte> payload,
                                 TopicSink& sink) {
  for (Route::Standard& each : route.standard) {
    if (each.topic && !sink.wants(topics_[*each.topic])) continue;
    if (!each.converter->convert(payload, channel, context_, cdr_)) continue;
    if (!each.topic) each.topic = standard_topic(*each.converter, channel);
    const Topic& topic = topics_[*each.topic];
    if (sink.wants(topic) && !sink.take(topic, cdr_)) return false;
  }
  return true;
}

std::size_t TopicTable::standard_topic(const Converter& converter, std::string_view channel) {
  const bool common = converter.topic.starts_with('/');
  Topic topic;
  topic.name = converter.topic_for(channel);
  // One topic for all channels, such as /tf: the name must not get a number.
  if (common)
    if (const auto known = common_topics_.find(topic.name); known != common_topics_.end()) return known->second;
  const std::string proposed = topic.name;
  topic.name = own_topic(proposed, (common ? "" : std::string(channel)) + " " + converter.ros_type);
  topic.encoding = "cdr";
  topic.type = converter.ros_type;
  topic.schema = standard_schema_text(converter.ros_type);
  if (!common) topic.lcm_channel = channel;
  // What is published once must reach those who subscribe later.
  topic.latched = proposed == "/tf_static" || proposed == "/scene" || proposed == "/surfaces_fixed";
  const std::size_t number = add(std::move(topic));
  if (common) common_topics_.emplace(proposed, number);
  return number;
}

bool TopicTable::keep_bytes(std::string_view channel, std::span<const std::byte> payload, TopicSink& sink) {
  // Raw topics need no type, so channels of unknown types are still recorded.
  auto known = raw_topics_.find(channel);
  if (known == raw_topics_.end()) {
    Topic topic;
    topic.name = own_topic(topic_of(channel) + "/bytes", std::string(channel) + " lcm");
    topic.encoding = "lcm";
    topic.lcm_channel = channel;
    known = raw_topics_.emplace(channel, add(std::move(topic))).first;
  }
  const Topic& topic = topics_[known->second];
  return !sink.wants(topic) || sink.take(topic, payload);
}

std::string TopicTable::own_topic(const std::string& topic, const std::string& owner) {
  std::string own = topic;
  for (int number = 2;; ++number) {
    const auto [known, fresh] = topic_owners_.emplace(own, owner);
    if (fresh || known->second == owner) return own;
    own = topic + "_" + std::to_string(number);
  }
}

std::size_t TopicTable::add(Topic topic) {
  topic.number = topics_.size();
  topics_.push_back(std::move(topic));
  return topics_.size() - 1;
}

}  // namespace bridges::ros2
