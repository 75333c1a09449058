// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <map>
#include <memory>
#include <string>
#include <string_view>

#include "bridges/rosbridge/rosbridge_message.hpp"
#include "bridges/rosbridge/rosbridge_protocol.hpp"

namespace bridges::rosbridge {

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
  using Clock = std::chrono::steady_clock;

  /// Message that waits.
  struct Data {
    std::size_t topic = 0;
    Bytes cdr;
  };
  /// What one `subscribe` asks for.
  struct Terms {
    std::chrono::milliseconds throttle{0};
    std::size_t queue_length = 0;
  };
  /// Subscription of a name, by any number of `subscribe`; each message is sent once.  The least of their intervals and
  /// lengths hold.
  struct Subscription {
    std::map<std::string, Terms> terms;  ///< by id
    std::string type;                    ///< demanded; empty: any
    bool bound = false;                  ///< there is such a topic
    std::size_t topic = 0;
    Terms effective;
    Clock::time_point due{};  ///< of the next message
    std::deque<Bytes> held;   ///< until they are due
    std::size_t waiting = 0;  ///< messages in data_
  };
  using Subscriptions = std::map<std::string, Subscription, std::less<>>;

  void carry_out(const ClientMessage& message);
  void subscribe(const ClientMessage& message);
  void unsubscribe(const ClientMessage& message);
  void end(Subscriptions::iterator subscription);
  void set_terms(Subscription& subscription);
  /// Connects a subscription with the topic of its name, if there is one.
  void bind(Subscriptions::iterator subscription, std::size_t topic);
  /// Connects subscriptions with topics that did not exist before.
  void bind_new_topics();
  void advertise(const ClientMessage& message);
  void publish(const ClientMessage& message);
  const CommandTopic& command_topic(const std::string& topic) const;
  void call(const ClientMessage& message);
  void call_run(const ClientMessage& message);
  void require_control() const;
  /// Queues an answer, and closes the connection of a client that does not read its answers.
  void answer(std::string text);
  void report(Level level, std::string_view text, std::string_view id = {});
  void queue(Subscription& subscription, const Bytes& cdr);
  Data take_first();
  void release_due();
  /// Counts messages that this client does not get.
  void count_dropped(std::uint64_t count);
  std::string next_drop_report();

  Protocol& protocol_;
  WebLink& link_;
  bool closing_ = false;
  Level level_ = Level::warning;
  Subscriptions subscriptions_;  // by name
  std::map<std::size_t, Subscription*> by_topic_;
  std::size_t bound_ = 0;                          // topics that bind_new_topics() has seen
  std::size_t terms_ = 0;                          // of all subscriptions
  std::map<std::string, std::string> advertised_;  // type by topic
  WebQueue<std::string> answers_;
  WebQueue<Data> data_;
  std::uint64_t dropped_ = 0;
  Clock::time_point next_drop_report_{};
};

}  // namespace bridges::rosbridge
