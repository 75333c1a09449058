// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "bridges/ros2/converter.hpp"
#include "shoal/message_schema.hpp"

namespace bridges::ros2 {

/// Topic for viewers and tools of ROS 2, filled by one LCM channel or, such as `/tf`, by several.
struct Topic {
  std::size_t number = 0;   ///< from 0, in the order of their first messages
  std::string name;         ///< such as `/rover1/lidar/scan`
  std::string encoding;     ///< `cdr`, or `lcm` for payloads that are kept as they are
  std::string type;         ///< such as `sensor_msgs/msg/LaserScan`; empty without a schema
  std::string schema;       ///< text in `ros2msg`
  std::string lcm_channel;  ///< empty: several
  std::string lcm_type;     ///< of the topic with all messages of a channel, else empty
  bool latched = false;     ///< a later subscriber needs the last message
};

/// Receiver of the messages of topics.
class TopicSink {
 public:
  virtual ~TopicSink() = default;
  /// Returns false for a topic whose messages need not be made.
  virtual bool wants(const Topic& /*topic*/) { return true; }
  /// Receives a message; `bytes` is valid during the call.  False ends the present message, such as after a failed
  /// write.
  virtual bool take(const Topic& topic, std::span<const std::byte> bytes) = 0;
  /// Receives the error of a payload that its type does not permit.
  virtual void invalid(std::string_view /*channel*/, const std::string& /*error*/) {}
};

/// Sink of nothing: for messages that only explain others.
class NoTopics final : public TopicSink {
 public:
  bool wants(const Topic&) override { return false; }
  bool take(const Topic&, std::span<const std::byte>) override { return true; }
};

/// Topics of LCM channels, for MCAP files and live viewers: each channel has one with all its messages in CDR, and
/// further ones with those that a standard type of ROS 2 can express.  Payloads of unknown types, and invalid ones, are
/// on `/CHANNEL/bytes` as they are.
class TopicTable {
 public:
  /// `types` must outlive this.
  explicit TopicTable(const shoal::MessageTypes& types = shoal::embedded_types()) : types_(&types) {}

  /// Encodes a message for all topics that `sink` wants, and adds those that are new.  Returns false if take() did.
  bool encode(std::string_view channel, std::span<const std::byte> payload, TopicSink& sink);
  /// Returns all topics by their numbers; references become invalid with the next message.
  const std::vector<Topic>& topics() const { return topics_; }
  /// Returns whether there is a topic for messages of this channel and type.
  bool has(std::string_view channel, std::uint64_t fingerprint) const;

 private:
  /// Topics of an LCM channel for one type.
  struct Route {
    struct Standard {
      const Converter* converter = nullptr;
      std::optional<std::size_t> topic;  ///< none: not needed until now
    };
    std::size_t topic = 0;
    std::vector<Standard> standard;
  };

  Route& route_of(std::string_view channel, const shoal::MessageSchema& schema);
  bool encode_standard(Route& route, std::string_view channel, std::span<const std::byte> payload, TopicSink& sink);
  bool keep_bytes(std::string_view channel, std::span<const std::byte> payload, TopicSink& sink);
  std::size_t standard_topic(const Converter& converter, std::string_view channel);
  /// Returns a topic that no other owner has: the proposed one, or one with a number.
  std::string own_topic(const std::string& topic, const std::string& owner);
  std::size_t add(Topic topic);

  const shoal::MessageTypes* types_;
  std::vector<Topic> topics_;
  std::map<std::string, std::map<std::uint64_t, Route>, std::less<>> routes_;  // by channel and fingerprint
  std::map<std::string, std::size_t, std::less<>> raw_topics_;
  std::map<std::string, std::size_t> common_topics_;  // topics that several LCM channels share, such as /tf
  std::map<std::string, std::string> topic_owners_;   // LCM channel and type of each topic
  ConverterContext context_;
  std::vector<std::byte> cdr_;
};

}  // namespace bridges::ros2
