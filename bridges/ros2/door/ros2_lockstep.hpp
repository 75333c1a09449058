// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <atomic>
#include <chrono>
#include <condition_variable>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <mutex>
#include <optional>
#include <set>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "bridges/lockstep_client/lockstep_client.hpp"
#include "bridges/ros2/node/tick_exchange.hpp"

namespace bridges::ros2 {

/// Member of the lockstep in place of nodes of ROS 2: gives each tick out, after the messages that belong to it, waits
/// for the answers, and passes the commands of the tick on.  How long the world waits is the world's to decide.
class Ros2Lockstep {
 public:
  struct Options {
    std::vector<std::string> nodes;   ///< whose answers a tick needs; empty: no lockstep
    std::string name = "shoal-ros2";  ///< in the lockstep
    double period_s = 0.1;
    std::chrono::milliseconds join_timeout{30'000};
  };
  /// Channels of the world that belong to the ticks, beside the reports.
  static constexpr std::array<std::string_view, 3> world_channels{"sim.bodies", "sim.clock", "sim.state"};
  struct Links {
    /// Publishes a message of the bus that belongs to the next tick.
    std::function<void(const std::string& channel, std::span<const std::byte> payload)> pass;
    /// Returns the channels of all reports of the world; none: they are not yet known.
    std::function<std::optional<std::set<std::string>>()> channels;
    std::function<void(const Tick&)> tell;
    std::function<void(const std::string& sentence)> warn;
  };

  /// Throws BusError.
  Ros2Lockstep(const std::string& lcm_url, const Options& options, Links links);

  /// Takes part until the end of the run, or stop().  Throws BusError when the simulator does not answer, and when the
  /// world continues without the nodes.
  void run();
  /// Ends run(); may be called from another thread.
  void stop();

  // The other side, from any thread.
  void count(const std::string& topic, std::uint32_t depth);
  void add(const std::string& topic, std::optional<TickExchange::Command> command);
  void take(const Tick& answer);

 private:
  void subscribe(const std::string& channel);
  bool subscribe_to_reports();
  /// Returns the commands of a tick; none after stop().
  std::optional<std::vector<TickExchange::Command>> await_commands();
  void tell(const shoal::sim_tick_t& tick);

  const Options options_;
  const Links links_;
  LockstepClient client_;
  std::set<std::string> subscribed_;
  std::mutex mutex_;  // protects the exchange
  std::condition_variable changed_;
  TickExchange exchange_;
  bool was_contested_ = false, was_full_ = false;
  std::atomic<bool> stopped_ = false;
};

}  // namespace bridges::ros2
