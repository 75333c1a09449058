// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <chrono>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "shoal/sim_control_request_t.hpp"
#include "sim/bus/bus.hpp"

namespace bridges {

/// Prefix of the text of look(), which identifies it in the error of another process.
inline constexpr const char* another_simulator = "another simulator";

/// Detector of other simulators on the buses of a run, used before the run publishes: two simulators on one bus would
/// both answer the clients, and their reports would be mixed.  The request is sent on construction, so that answers
/// arrive while the world is built.
class OtherSimulators {
 public:
  struct BusToAsk {
    std::string url;
    sim::Bus* network;
  };
  /// Flushes published messages, and waits for messages up to the given time, or returns earlier.
  using Wait = std::function<void(std::chrono::milliseconds)>;

  /// `shared`: the run shares its buses; it does not check for other simulators, but notifies them.
  OtherSimulators(const std::vector<BusToAsk>& buses, bool shared);

  /// Waits for answers of other simulators.  Returns the description of one, `another simulator answers on URL`; none
  /// when there is none.  The buses are not used after that.
  std::optional<std::string> look(const Wait& wait);

  /// Returns whether the user allows other simulators on the buses.
  bool shared() const { return shared_; }
  /// Sender of a request.
  enum class Requester { none_of_ours, this_run, another_run, another_run_that_shares };
  Requester requester_of(const shoal::sim_control_request_t& request) const;

 private:
  struct Link {
    std::string url;
    sim::Bus* network;
    std::unique_ptr<sim::Mailbox> requests, replies, clock, tick;
  };
  void send_request(sim::Bus& network);
  std::optional<std::string> take(Link& link);
  /// Answers requests; returns true when another starting run was answered for the first time.
  bool answer_requests(Link& link);
  bool is_answered(Link& link) const;

  std::vector<Link> links_;
  bool shared_;
  std::int32_t id_;
  std::set<std::int32_t> met_;  // other runs that start at the same time
  std::chrono::steady_clock::time_point asked_at_;
};

}  // namespace bridges
