// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <chrono>
#include <cstdint>
#include <map>
#include <span>
#include <string>
#include <string_view>

#include "bridges/web/web_server.hpp"
#include "viewer/page_data/traffic_counts.hpp"
#include "viewer/page_data/traffic_history.hpp"
#include "viewer/server/message_feed.hpp"

namespace viewer {

/// Message traffic as shown on pages: the channels with their counts, who received from whom, and the messages
/// of the channels that a page has subscribed to.
class PageTraffic {
 public:
  /// `server` must outlive this.
  PageTraffic(bridges::WebServer& server, MessageFeed::Past past)
      : server_(server), feed_(server, past), keeps_past_(past == MessageFeed::Past::kept) {}

  /// Takes a message that was published at a simulated time.
  void take(std::string_view channel, std::span<const std::byte> payload, std::int64_t time_us);
  /// Counts a message only.
  void count(std::string_view channel, std::span<const std::byte> payload);
  /// Carries out the requests `subscribe` and `left`, and refuses `series`; returns false for another request.
  bool handle(const bridges::ViewRequest& request);
  /// Sends what is due: messages, and once per second of wall time the counts if they have changed.  `scene`: JSON,
  /// whose `number` changes with it.
  void flush(std::int64_t time_us, const std::string& scene, int number);
  /// Takes counts and messages back to a time, because the run was rewound: the counts to within 0.1 s, or more for
  /// times that are long ago or if there are more than 100 channels.
  void rewind(std::int64_t time_us);
  /// Sets the counts, at another time of a log.
  void set_counts(TrafficCounts counts);
  MessageFeed& feed() { return feed_; }

 private:
  using Clock = std::chrono::steady_clock;

  void send_counts(std::int64_t time_us);
  void send_links(std::int64_t time_us);
  void send_modems(std::int64_t time_us);
  void mark_before(std::int64_t time_us);
  std::string vehicle_of(const std::string& channel) const;

  bridges::WebServer& server_;
  MessageFeed feed_;
  TrafficCounts counts_;
  const bool keeps_past_;
  TrafficHistory history_;  // if the past is kept
  std::int64_t newest_us_ = 0;
  bool channels_changed_ = false, links_changed_ = false;
  std::int64_t links_sent_ = 0;
  int clients_ = 0;
  int scene_number_ = -1;
  std::map<std::string, std::string, std::less<>> vehicles_;  // by channel; and each vehicle by its name
  Clock::time_point next_counts_{};
};

/// Sends `{"op":"reply","ok":false}` with the id of the request.
void refuse(bridges::WebServer& server, const bridges::ViewRequest& request, const std::string& text);

}  // namespace viewer
