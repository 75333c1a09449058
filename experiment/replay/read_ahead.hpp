// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <condition_variable>
#include <cstddef>
#include <cstdint>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "bridges/log/event_log.hpp"

namespace experiment {

/// Reads an LCM event log in its own thread, a few blocks ahead of the reader of the events.
class ReadAhead {
 public:
  /// Throws bridges::BusError when the file cannot be opened.
  explicit ReadAhead(const std::string& path);
  ~ReadAhead();
  ReadAhead(const ReadAhead&) = delete;
  ReadAhead& operator=(const ReadAhead&) = delete;

  /// Reads the next event in the order of the file; the view is valid until the next call.  Returns false at the end.
  bool next(bridges::LogEventView& event);

 private:
  struct Event {
    std::int64_t number, utime;
    std::uint64_t offset;
    std::size_t begin, channel_bytes, payload_bytes;  // in the block
  };
  struct Block {
    std::vector<Event> events;
    std::vector<std::byte> bytes;
    bool last = false;
  };

  void read();
  void fill(Block& block);
  bool wait_for_block();

  bridges::EventLogReader file_;
  Block current_;  // being read by next()
  std::size_t at_ = 0;
  std::mutex mutex_;
  std::condition_variable changed_;
  std::optional<Block> ready_, used_;  // ready_: next block for the reader of events; used_: returned for reuse of its
                                       // memory
  bool stop_ = false;
  std::thread thread_;
};

}  // namespace experiment
