// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <chrono>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string_view>

#include "bridges/rosbridge/rosbridge_protocol.hpp"
#include "bridges/web/web_server.hpp"
#include "experiment/run/run_page.hpp"

namespace viewer {

/// Clients of rosbridge v2 at the port of the live page.
class RosbridgeView {
 public:
  /// `may_control`: clients may command vehicles and control the run.  `server` must outlive this.
  RosbridgeView(bridges::WebServer& server, bool may_control);

  int clients() const { return protocol_->clients(); }
  /// Offers the commands that the vehicles of the world take now; serve() keeps this up to date.
  void show_commands(const sim::World& world);
  /// Passes a message on, published at this UTC, with the next flush().
  void message(std::int64_t utime, std::string_view channel, std::span<const std::byte> payload) {
    protocol_->message(utime, channel, payload);
  }
  void flush() { protocol_->flush(); }
  /// Returns true once after there were new subscriptions.
  bool take_subscribed();
  /// Sends what was held back and is due, at most some thirty times per second of wall time.
  void release();
  /// Carries out the requests of the clients.  `publish`: gives commands to the run; empty: it takes none.
  void serve(const sim::World& world, const experiment::RunPage::Execute& execute,
             const experiment::RunPage::Publish& publish);

 private:
  using Clock = std::chrono::steady_clock;

  const std::shared_ptr<bridges::rosbridge::Protocol> protocol_;
  std::uint64_t subscriptions_ = 0;
  std::optional<std::uint64_t> generation_;  // of the world, of the last commands
  Clock::time_point next_release_{};
};

}  // namespace viewer
