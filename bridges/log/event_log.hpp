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

/// An event in the memory of the reader, until it reads on.
struct LogEventView {
  std::int64_t number = 0;
  std::int64_t utime = 0;
  std::string_view channel;
  std::span<const std::byte> payload;
  std::uint64_t offset = 0;  ///< where in the file it begins
};

/// Reads an LCM event log, also a damaged one: lengths are bounded by the file, what is not an event is skipped
/// and reported, an event cut off at the end (the writer was killed) ends the reading.
class EventLogReader {
 public:
  /// Throws BusError when the file cannot be opened or is not a regular file.
  explicit EventLogReader(const std::string& path);

  /// In the order of the file.  Empty at the end.
  std::optional<LogEvent> next();
  /// The same without a copy.  False at the end.
  bool next(LogEventView& event);
  /// So far, such as `byte 4711: 28 bytes between events were skipped`.
  const std::vector<std::string>& problems() const { return problems_; }
  std::uint64_t file_bytes() const { return file_bytes_; }

 private:
  enum class Outcome { event, garbage, truncated };

  Outcome read_event(LogEventView& event);
  /// Moves to the next sync word behind here, or to the end.
  void find_sync();
  /// Has the bytes of the file from at_ on in memory, at least `size` unless it ends before.  How many there are.
  std::size_t fill(std::size_t size);
  const unsigned char* here() const { return buffer_.data() + (at_ - buffer_start_); }

  FileDescriptor file_;
  std::vector<unsigned char> buffer_;
  std::uint64_t buffer_start_ = 0;  // in the file
  std::size_t buffered_ = 0;
  std::uint64_t file_bytes_ = 0;
  std::uint64_t at_ = 0;
  std::vector<std::string> problems_;
};

/// Writes an LCM event log: whole events, through blocks that another thread writes.
class EventLogWriter {
 public:
  explicit EventLogWriter(FileDescriptor file) : file_(std::move(file)) {}

  /// All return false when a write failed so far; errno has the reason.
  bool write(std::int64_t number, std::int64_t utime, std::string_view channel, std::span<const std::byte> payload);
  /// Bytes of another log.
  bool write(std::span<const std::byte> bytes);
  /// Lets the thread write what there is, and does not wait for it.
  bool hand_over();
  /// Waits until all is written.
  bool flush();

 private:
  /// Space for `size` bytes in the block; null: writing has failed.
  std::byte* room(std::size_t size);

  FileWriter file_;
  FileWriter::Block block_;
};

}  // namespace bridges
