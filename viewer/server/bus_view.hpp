// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <chrono>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>

#include "viewer/log/message_times.hpp"
#include "viewer/server/page_session.hpp"

namespace viewer {

/// Live page of what is on a bus: of a run in another process.
class BusView {
 public:
  BusView(const experiment::ViewOptions& options, const std::string& version, const std::string& bus);

  std::string url() const { return session_.server.url(); }
  void message(std::string_view channel, std::span<const std::byte> payload);
  /// Sends the newest state, and answers the requests of the pages.  Call some thirty times per second.
  void flush();
  bool has_scene() const { return session_.messages.has_scene(); }

 private:
  using Clock = std::chrono::steady_clock;

  void send_hello();
  void send_status();

  PageSession session_;
  std::int64_t now_us_ = 0;
  MessageTimes times_;
  std::int64_t newest_utime_ = 0;
  const std::string version_, bus_;
  std::string world_;
  // Used to measure the rate of simulated time.
  Clock::time_point status_at_{};
  std::int64_t status_us_ = 0;
};

}  // namespace viewer
