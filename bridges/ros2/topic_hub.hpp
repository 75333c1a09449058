// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <set>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "bridges/ros2/topic_table.hpp"

namespace bridges::ros2 {

/// Message of an LCM channel that waits to be encoded.
struct ChannelMessage {
  std::int64_t utime = 0;  ///< UTC at which it was published, us since 1970
  std::string channel;
  std::vector<std::byte> payload;
};

/// Reason to pass a message on.
enum class Need {
  none,
  examined,    ///< to see which topics it fills
  subscribed,  ///< for a reader
  kept         ///< later messages or readers depend on it: it must not be lost
};

/// Messages on their way to the thread of the readers, which empties it at once unless the machine is overloaded.
struct WaitingMessages {
  static constexpr std::size_t max_bytes = std::size_t{16} << 20;
  static constexpr std::size_t max_messages = 8192;

  /// Adds a message; returns false if there is no room for it.
  bool add(Need need, std::int64_t utime, std::string_view channel, std::span<const std::byte> payload);
  /// Returns whether the readers had better have them now than after the step.
  bool are_many() const { return messages.size() >= max_messages / 16 || bytes >= max_bytes / 16; }
  /// Adds a jump in time, which has no channel.  Several without a message between are one.
  void add_jump(std::int64_t utime);

  std::vector<ChannelMessage> messages;
  std::size_t bytes = 0;
  std::uint64_t dropped = 0;  ///< subscribed messages that found no room
};

/// Subscriber of topics of a TopicHub.
class TopicReader {
 public:
  using Bytes = std::shared_ptr<const std::string>;
  virtual ~TopicReader() = default;
  virtual bool has_subscribed(std::size_t topic) const = 0;
  /// Receives a message of a topic in CDR; `from`: the message of which it was made.
  virtual void push(const Topic& topic, const ChannelMessage& from, const Bytes& cdr) = 0;
};

/// Topics for subscribers that come and go: encodes a message only while one of its topics is subscribed, besides those
/// that show which topics there are; without a reader nothing, as what a later one needs is set aside.  need() may be
/// called in any thread, the other functions in that of the readers.
class TopicHub : private TopicSink {
 public:
  static constexpr std::size_t max_channels = 65'535;  ///< further LCM channels have no topics

  /// Decides on a message.  `has_readers`: there is a reader.  Thread-safe.
  Need need(std::string_view channel, std::span<const std::byte> payload, bool has_readers);

  /// Puts a message that is needed into `waiting` of the box of an exchange with the thread of the readers (a
  /// WebExchange), whose next flush() wakes it.  Thread-safe.
  template <class Exchange>
  void gather(Exchange& exchange, std::int64_t utime, std::string_view channel, std::span<const std::byte> payload) {
    const Need needed = need(channel, payload, exchange.clients() > 0);
    if (needed == Need::none) return;
    bool many = false;
    exchange.gather([&](auto& box) {
      const bool added = box.waiting.add(needed, utime, channel, payload);
      many = box.waiting.are_many();
      return added;
    });
    if (many) exchange.flush();
  }

  /// Adds a reader.  What was set aside is encoded first, so that there are the topics of all channels so far.
  void add(TopicReader& reader);
  void remove(const TopicReader& reader) { std::erase(readers_, &reader); }
  /// Encodes a message for the readers of its topics.
  void encode(ChannelMessage& message);
  /// Returns all topics by their numbers; references become invalid with the next message.
  const std::vector<Topic>& topics() const { return table_.topics(); }
  /// Counts a subscription of a topic that begins (1) or ends (-1).
  void count_subscription(std::size_t topic, int change);
  /// Sends a reader the last messages of a latched topic.
  void send_latched(TopicReader& reader, std::size_t topic);

 private:
  /// LCM channel, as need() sees it.
  struct Channel {
    std::uint64_t fingerprint = 0;
    std::uint64_t seen = 0;
    bool subscribed = false;  ///< a reader has subscribed to one of its topics
  };
  /// Reader and topic to which a last message is sent again.
  struct Target {
    TopicReader* reader;
    std::size_t topic;
  };

  bool wants(const Topic& topic) override;
  bool take(const Topic& topic, std::span<const std::byte> bytes) override;
  void set_aside(ChannelMessage& message);
  void encode_set_aside();
  void encode_now(ChannelMessage& message);
  void pass(const ChannelMessage& message);
  void relate(const Topic& topic);
  void update_wanted(const std::string& channel);

  std::mutex channels_mutex_;
  std::map<std::string, Channel, std::less<>> channels_;

  TopicTable table_;
  std::vector<TopicReader*> readers_;
  std::vector<ChannelMessage> set_aside_;           // in their order, while there is no reader
  std::map<std::string, std::size_t> replaceable_;  // places of those in it that a later message replaces
  std::size_t set_aside_bytes_ = 0;
  std::vector<int> subscribers_;  // by topic
  std::vector<std::set<std::string>> channels_of_topic_;
  std::map<std::string, std::set<std::size_t>, std::less<>> topics_of_channel_;
  std::map<std::string, ChannelMessage, std::less<>> last_;  // of channels with latched topics
  const ChannelMessage* present_ = nullptr;                  // that is being encoded
  std::optional<Target> target_;
};

}  // namespace bridges::ros2
