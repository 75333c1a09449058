// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <chrono>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>

#include "bridges/foxglove/foxglove_protocol.hpp"
#include "bridges/web/web_server.hpp"

namespace viewer {

/// Foxglove, Lichtblick and PlotJuggler at the port of the live page.
class FoxgloveView {
 public:
  using State = bridges::foxglove::PlaybackState;
  using Request = bridges::foxglove::Request;
  /// Answer to a request: whether it was carried out, and the text of the reply.
  using Answer = std::pair<bool, std::string>;

  /// `server` must outlive this.
  explicit FoxgloveView(bridges::WebServer& server);

  /// Introduces the run, log or bus to the clients, who wait for it.  Times: of a log.
  void introduce(const std::string& name, const std::string& version, bridges::foxglove::Control control,
                 std::int64_t start_us = 0, std::int64_t end_us = 0);
  int clients() const { return protocol_->clients(); }
  /// Passes a message on, published at this UTC, with the next flush().
  void message(std::int64_t utime, std::string_view channel, std::span<const std::byte> payload) {
    protocol_->message(utime, channel, payload);
  }
  void flush() { protocol_->flush(); }
  /// Shows a time, at most some thirty times per second of wall time.
  void show_time(std::int64_t utime);
  /// Announces that the time was set.
  void jump(std::int64_t utime) { protocol_->jump(utime); }
  /// Returns true once after there were new subscriptions.
  bool take_subscribed();
  /// Carries out the requests of the clients, then tells all the state that `state` returns.
  void serve(const std::function<State()>& state, const std::function<Answer(const Request&)>& execute);

 private:
  using Clock = std::chrono::steady_clock;

  const std::shared_ptr<bridges::foxglove::Protocol> protocol_;
  std::uint64_t subscriptions_ = 0;
  Clock::time_point next_time_{}, next_state_{};
};

}  // namespace viewer
