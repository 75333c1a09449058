// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "bridges/foxglove/foxglove_protocol.hpp"

namespace bridges::foxglove {

/// One client of Protocol: its subscriptions, and what waits for it.
class Session final : public WebSession, public ros2::TopicReader {
 public:
  Session(Protocol& protocol, WebLink& link) : protocol_(protocol), link_(link) {}
  ~Session() override;
  void receive(std::string_view bytes, bool is_text) override;
  bool next(WebFrame& frame) override;
  bool has_subscribed(std::size_t topic) const override { return by_topic_.contains(topic); }
  void push(const ros2::Topic& topic, const ros2::ChannelMessage& from, const Bytes& cdr) override;

 private:
  friend class Protocol;

  /// Message that waits.
  struct Data {
    std::uint32_t subscription = 0;
    std::int64_t utime = 0;
    Bytes payload;
    std::string channel;  ///< LCM channel, of a latched topic
  };

  void receive_text(std::string_view bytes);
  void receive_binary(std::string_view bytes);
  void subscribe(const Subscription& subscription);
  void unsubscribe(std::uint32_t id);
  void call(ServiceCall call);
  void set_parameters(const ClientText& message);
  void request(Request request);
  bool may(Control control) const { return protocol_.info_ && protocol_.info_->control == control; }
  /// Queues an answer, and closes the connection of a client that does not read its answers.
  void answer(std::string bytes, bool is_text = true);
  void report(StatusLevel level, std::string_view text) { answer(status_text(level, text)); }
  void push_latched(Data data);
  /// Counts messages that this client does not get.
  void count_dropped(std::uint64_t count);
  void jump(std::int64_t utime);
  void show_parameters(const PlaybackState& state);
  std::string next_advertisement();
  std::string next_drop_report();

  Protocol& protocol_;
  WebLink& link_;
  bool introduced_ = false, closing_ = false;
  std::size_t advertised_ = 0;                     // topics
  std::map<std::uint32_t, std::size_t> topic_of_;  // by subscription
  std::map<std::size_t, std::uint32_t> by_topic_;  // subscription
  std::set<std::string> parameters_;               // whose changes it gets
  bool gets_parameters_ = false, gets_playback_ = false;
  struct Answer {
    Bytes bytes;
    bool is_text;
  };
  std::deque<Answer> answers_;
  std::optional<std::int64_t> time_;
  WebQueue<Data> latched_, data_;
  std::uint64_t dropped_ = 0;
  std::chrono::steady_clock::time_point next_drop_report_{};
};

}  // namespace bridges::foxglove
