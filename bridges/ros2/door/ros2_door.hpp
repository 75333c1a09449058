// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <chrono>
#include <cstdint>
#include <deque>
#include <functional>
#include <map>
#include <mutex>
#include <optional>
#include <set>
#include <span>
#include <string>
#include <string_view>
#include <thread>
#include <vector>

#include "bridges/dds/dds_participant.hpp"
#include "bridges/lcm/lcm_listener.hpp"
#include "bridges/ros2/door/ros2_lockstep.hpp"
#include "bridges/ros2/node/command_topics.hpp"
#include "bridges/ros2/node/sim_services.hpp"
#include "bridges/ros2/topic_table.hpp"
#include "bridges/signing/signed_message.hpp"
#include "shoal/sim_vehicle_t.hpp"

namespace bridges::ros2 {

/// Door between an LCM bus and ROS 2 over DDS: a node `/shoal` that publishes what is on the bus by the topics of
/// TopicTable, takes commands by those of command_topics(), and serves SimServices.  A message is encoded only while a
/// topic has a subscriber.  The thread of run() carries the bus to ROS 2, another one the opposite way.  In lockstep a
/// third one carries what belongs to the ticks.
class Ros2Door final : private TopicSink {
 public:
  struct Options {
    std::string lcm_url;       ///< empty: LCM_DEFAULT_URL, or the default of Shoal
    std::string run;           ///< folder with the key of the run; empty: SHOAL_RUN_KEY, if it is set
    bool controls = false;     ///< serves what changes the run
    bool publishes_tf = true;  ///< true poses in /tf; without them the tree is that of the localization of a user
    DdsNetwork network;
    Ros2Lockstep::Options lockstep;
  };
  struct Counts {
    std::uint64_t published = 0;  ///< messages to ROS 2
    std::uint64_t late = 0;       ///< of these, given up because a subscriber did not read
    std::uint64_t commands = 0;   ///< messages and calls from ROS 2
    std::uint64_t refused = 0;    ///< of these, not of their type
  };

  /// Throws BusError.
  explicit Ros2Door(const Options& options);
  ~Ros2Door() override;

  /// Passes messages on until `stops` returns true, asked ten times a second, or in lockstep until the end of the run.
  /// Throws BusError when LCM is lost, or the lockstep fails.
  void run(const std::function<bool()>& stops);
  const std::string& lcm_url() const { return lcm_.url(); }
  const Counts& counts() const { return counts_; }

 private:
  using Clock = std::chrono::steady_clock;
  using Endpoint = DdsParticipant::Endpoint;

  /// Vehicle whose devices take commands.
  struct Vehicle {
    bool is_described = false;
    std::vector<std::string> described;  ///< channels and types of its commands
    std::set<std::string> reports;       ///< channels
    std::vector<Endpoint> readers;
  };

  /// Answer to a client whose reader is not known yet.
  struct WaitingAnswer {
    std::size_t service;
    std::vector<std::byte> cdr;
    Clock::time_point until;
  };

  bool wants(const Topic& topic) override;
  bool take(const Topic& topic, std::span<const std::byte> bytes) override;

  void carry(const std::function<bool()>& stops);
  void add_lockstep();
  void add_services();
  void take_message(const Received& message);
  bool belongs_to_ticks(const std::string& channel);
  /// Publishes a message by its topics.
  void publish(const Received& message);
  /// Takes what the door itself needs to know.  Throws shoal::MessageError.
  void learn(const Received& message);
  void learn_vehicle(const shoal::sim_vehicle_t& vehicle);
  void forget(Vehicle& vehicle);
  std::optional<std::set<std::string>> report_channels();
  DdsQos qos_of(const Topic& topic) const;
  void look_after(Clock::time_point now);
  void publish_graph();
  std::int32_t ask(const std::string& command, double value, const std::string& text);
  void receive();
  void answer(std::size_t service, std::span<const std::byte> cdr);
  void send_answers(Clock::time_point now);
  void warn_once(const std::string& topic, const std::string& what);
  void deliver(Endpoint reader, std::span<const std::byte> cdr);
  void deliver(const CommandTopic& command, std::span<const std::byte> cdr);

  const Options options_;
  const std::string client_;
  std::mutex mutex_;  // protects all below, except the listener while it waits
  LcmListener lcm_;
  std::optional<MessageSigner> signer_;
  DdsParticipant participant_;
  TopicTable table_;
  SimServices services_;
  std::vector<Endpoint> writers_;      // by number of the topic; 0: none yet
  std::vector<std::uint32_t> depths_;  // of their histories
  std::map<Endpoint, CommandTopic> commands_;
  std::map<Endpoint, std::size_t> service_of_;
  std::vector<Endpoint> calls_, answers_;  // readers and writers of the services
  std::deque<WaitingAnswer> waiting_answers_;
  std::map<std::string, Vehicle, std::less<>> vehicles_;
  std::set<std::string, std::less<>> command_channels_, warned_;
  std::map<std::string, double, std::less<>> rates_hz_;  // of the reports, by channel; 0: each step
  std::map<std::int32_t, std::string> questions_;        // by number of the request: the vehicle
  std::vector<std::string> present_;                     // vehicles, in the last state
  bool knows_state_ = false;
  std::string world_;
  std::int64_t utime_ = 0;
  std::int32_t last_request_ = 0;
  Endpoint graph_ = 0, ticks_ = 0, tick_answers_ = 0;
  bool is_in_tick_ = false;  // the message that is published belongs to a tick
  bool graph_changed_ = true;
  Clock::time_point next_look_{}, next_question_{};
  Counts counts_;
  std::optional<Ros2Lockstep> lockstep_;
  std::thread receiver_;
};

}  // namespace bridges::ros2
