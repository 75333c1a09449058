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

/// What look() begins with, for those who read it in the error of another process.
inline constexpr const char* another_simulator = "another simulator";

/// Looks for other simulators on the buses of a run, before it publishes anything: two on one bus would answer the same
/// clients, and mix their reports.  The question goes out when this is made, so that the answers come while the world
/// is built.
class OtherSimulators {
 public:
  struct BusToAsk {
    std::string url;
    sim::Bus* network;
  };
  /// Has what was published sent, and waits for messages up to the given time, or returns earlier.
  using Wait = std::function<void(std::chrono::milliseconds)>;

  /// `shared`: the run is to share its buses; it does not look, but the others are told of it.
  OtherSimulators(const std::vector<BusToAsk>& buses, bool shared);

  /// Waits until the others had their time to answer.  Says who is there: `another simulator answers on URL`; nothing:
  /// nobody.  The buses are left alone after that.
  std::optional<std::string> look(const Wait& wait);

  /// The run knows that it may not be alone.
  bool shared() const { return shared_; }
  /// Whose question a request is: of another run that starts.
  enum class Asker { nobody, this_run, another_run, another_run_that_shares };
  Asker who_asks(const shoal::sim_control_request_t& request) const;

 private:
  struct Line {
    std::string url;
    sim::Bus* network;
    std::unique_ptr<sim::Mailbox> requests, replies, clock, tick;
  };
  void ask(sim::Bus& network);
  std::optional<std::string> take(Line& line);
  /// True when another run that starts was answered for the first time.
  bool answer_questions(Line& line);
  bool is_answered(Line& line) const;

  std::vector<Line> lines_;
  bool shared_;
  std::int32_t id_;
  std::set<std::int32_t> met_;  // other runs that start at the same time
  std::chrono::steady_clock::time_point asked_at_;
};

}  // namespace bridges
