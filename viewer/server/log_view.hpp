// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <string>

#include "bridges/log/event_log.hpp"
#include "viewer/estimates/log_estimates.hpp"
#include "viewer/log/log_distances.hpp"
#include "viewer/log/log_index.hpp"
#include "viewer/log/log_poses.hpp"
#include "viewer/log/message_times.hpp"
#include "viewer/server/log_series.hpp"
#include "viewer/server/page_session.hpp"

namespace viewer {

/// Live page of a log: plays it at any speed, and shows any time of it.  Its time is its own, not an
/// experiment::WorldTime, which paces, saves and takes back the steps of a sim::World: a log has neither, its time is
/// continuous, flows only while a client watches, and is set to any instant without simulating.
class LogView {
 public:
  /// `index` is that of the file `path`.  Both must outlive this.  Throws bridges::WebError, BusError.
  LogView(const std::string& path, const LogIndex& index, const experiment::ViewOptions& options,
          const std::string& version);

  std::string url() const { return session_.server.url(); }
  /// Shows the bodies of another log at the same time, as branch 1; before the first advance().  `difference`: where
  /// the two logs differ first.
  void compare_with(const std::string& path, const LogIndex& index, const std::optional<LogDifference>& difference);
  /// Plays the next part, as much as `wall_s` allows, and carries out the requests of the pages.
  void advance(double wall_s);
  /// Shows a time; outside of the log its start or end.
  void seek(std::int64_t time_us);

 private:
  void handle(const bridges::ViewRequest& request);
  void look(const bridges::ViewRequest& request);
  /// Sends the page the estimates of the other log at a time.
  void send_other_estimates(const bridges::ViewRequest& request, std::int64_t time_us);
  void send_event_at(std::uint64_t offset);
  /// Gives pages the last messages of their channels, after they have subscribed.
  void fill_feed();
  void serve_foxglove();
  FoxgloveView::State foxglove_state() const;
  void play_foxglove(const bridges::foxglove::PlaybackRequest& request);
  /// Passes messages on, up to the last pose at or before a time.
  void play_to(std::int64_t time_us);
  void send_status();
  void send_distances();

  const std::string path_, name_;
  const LogIndex& index_;
  bridges::EventLogReader reader_, looking_;
  PageSession session_;
  LogSeries series_;
  MessageTimes times_;
  LogPoses poses_;                 // for the requests `look`
  std::optional<LogPoses> other_;  // of the log that this one is compared with
  LogEstimates other_estimates_;
  std::int64_t other_epoch_us_ = 0;
  std::optional<LogDifference> difference_;
  std::optional<LogDistances> distances_;  // until they have been computed
  StateFrame past_;
  double now_us_;
  double speed_ = 1;
  bool paused_ = false, loop_ = false;
  int clients_ = 0;
  bool status_is_old_ = true;
  double since_status_s_ = 0;
};

}  // namespace viewer
