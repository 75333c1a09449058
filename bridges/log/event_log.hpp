// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "bridges/base/bus_error.hpp"
#include "bridges/base/file_descriptor.hpp"
#include "bridges/base/file_writer.hpp"
#include "sim/bus/bus.hpp"

namespace bridges {

struct LogEvent {
  std::int64_t number = 0;
  std::int64_t utime = 0;
  std::string channel;
  sim::Bytes payload;
  std::uint64_t offset = 0;  ///< where in the file it begins
};

/// Event in the memory of the reader, valid until the next read.
struct LogEventView {
  std::int64_t number = 0;
  std::int64_t utime = 0;
  std::string_view channel;
  std::span<const std::byte> payload;
  std::uint64_t offset = 0;  ///< where in the file it begins
};

/// Reader of an LCM event log, also of a damaged one: lengths are bounded by the file size, bytes that are not an event
/// are skipped and reported, and a truncated event at the end (the writer was killed) ends the reading.
class EventLogReader {
 public:
  /// Throws BusError when the file cannot be opened or is not a regular file.
  explicit EventLogReader(const std::string& path);

  /// Returns the next event in the order of the file; none at the end.
  std::optional<LogEvent> next();
  /// Reads the next event without a copy; returns false at the end.
  bool next(LogEventView& event);
  /// Continues at the event that begins at this offset in the file.
  void seek(std::uint64_t offset);
  /// Returns the problems found so far, such as `byte 4711: 28 bytes between events were skipped`.
  const std::vector<std::string>& problems() const { return problems_; }
  std::uint64_t file_bytes() const { return file_bytes_; }

 private:
  enum class Outcome { event, garbage, truncated };

  Outcome read_event(LogEventView& event);
  /// Moves to the next sync word, or to the end.
  void find_sync();
  /// Buffers the bytes of the file from at_ on, at least `size` unless the file ends before.  Returns the number of
  /// buffered bytes.
  std::size_t fill(std::size_t size);
  const unsigned char* here() const { return buffer_.data() + (at_ - buffer_start_); }

  FileDescriptor file_;
  std::vector<unsigned char> buffer_;
  std::uint64_t buffer_start_ = 0;  // offset in the file
  std::size_t buffered_ = 0;
  std::uint64_t file_bytes_ = 0;
  std::uint64_t at_ = 0;
  std::vector<std::string> problems_;
};

/// Writer of an LCM event log: whole events, in blocks that another thread writes.
class EventLogWriter {
 public:
  explicit EventLogWriter(FileDescriptor file) : file_(std::move(file)) {}

  /// Writes an event.  This and the functions below return false after a failed write; errno has the reason.
  bool write(std::int64_t number, std::int64_t utime, std::string_view channel, std::span<const std::byte> payload);
  /// Writes bytes of another log.
  bool write(std::span<const std::byte> bytes);
  /// Passes the present block to the thread, without waiting.
  bool hand_over();
  /// Waits until everything is written.
  bool flush();

 private:
  /// Returns space for `size` bytes in the block; null when writing has failed.
  std::byte* room(std::size_t size);

  FileWriter file_;
  FileWriter::Block block_;
};

/// Finds where the time stamps of a log go back, as in logs that were joined, or after a clock was set back.
class TimeOrder {
 public:
  /// Call for each event, in the order of the log.
  void add(std::int64_t utime, std::string_view channel);
  /// Returns a line about the first event before its predecessor, with the number of such events; none: there is none.
  std::optional<std::string> problem() const;
  /// Time from the earliest to the latest event, s.
  double span_s() const;

 private:
  std::uint64_t events_ = 0, back_ = 0, first_event_ = 0;
  std::int64_t last_ = 0, earliest_ = 0, latest_ = 0;
  double first_back_s_ = 0;
  std::string first_channel_;
};

}  // namespace bridges
