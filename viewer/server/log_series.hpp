// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <deque>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

#include "bridges/log/event_log.hpp"
#include "bridges/web/web_server.hpp"
#include "viewer/log/log_index.hpp"
#include "viewer/page_data/page_request.hpp"

namespace viewer {

/// Values of a field over time; NaN where a message has none.
struct Series {
  std::vector<std::int64_t> t_us;
  std::vector<double> values;
};

/// Reads a series from the log: all values, or if they are more than the points that were asked for, the smallest and
/// the largest of each of equal intervals, in their order.  Throws PageRequestError when there is no such channel,
/// field or number in this range, or when the reading is not done by `deadline`.
Series read_series(bridges::EventLogReader& log, const LogIndex& index, const SeriesRequest& request,
                   std::chrono::steady_clock::time_point deadline);

/// Thread that answers the requests `series` of pages from a log, each within a second.
class LogSeries {
 public:
  /// `index` is that of the file `path`; it and `server` must outlive this.
  LogSeries(const std::string& path, const LogIndex& index, bridges::WebServer& server);
  ~LogSeries();
  LogSeries(const LogSeries&) = delete;
  LogSeries& operator=(const LogSeries&) = delete;

  /// Answers a request, later; at once if it is invalid.
  void request(const bridges::ViewRequest& request);

 private:
  using Clock = std::chrono::steady_clock;
  struct Job {
    bridges::ViewRequest request;
    SeriesRequest series;
    Clock::time_point deadline;
  };

  void run();
  void answer(const Job& job);

  const LogIndex& index_;
  bridges::WebServer& server_;
  bridges::EventLogReader log_;
  std::mutex mutex_;
  std::condition_variable wake_;
  std::deque<Job> jobs_;
  bool ends_ = false;
  std::thread thread_;
};

}  // namespace viewer
