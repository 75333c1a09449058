#pragma once

#include <cstdint>
#include <cstdio>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "bridges/lcm/bus_error.hpp"
#include "sim/bus/bus.hpp"

namespace bridges {

struct LogEvent {
  std::int64_t number = 0;
  std::int64_t utime = 0;
  std::string channel;
  sim::Bytes payload;
  std::uint64_t offset = 0;  ///< where in the file it begins
};

/// Reads an LCM event log, also a damaged one: lengths are bounded by the file, what is no event is skipped
/// and reported, an event cut off at the end (the writer was killed) ends the reading.
class EventLogReader {
 public:
  /// Throws BusError when the file cannot be opened or is no regular file.
  explicit EventLogReader(const std::string& path);

  /// In the order of the file.  Empty at the end.
  std::optional<LogEvent> next();
  /// The same into an event whose memory is used again.  False at the end.
  bool next(LogEvent& event);
  /// So far, such as `byte 4711: 28 bytes that are no event were skipped`.
  const std::vector<std::string>& problems() const { return problems_; }
  std::uint64_t file_bytes() const { return file_bytes_; }

 private:
  struct Closer {
    void operator()(std::FILE* file) const { std::fclose(file); }
  };
  enum class Outcome { event, garbage, truncated };

  Outcome read_event(LogEvent& event);
  /// Moves to the next sync word behind here, or to the end.
  void find_sync();

  std::vector<char> buffer_ = std::vector<char>(std::size_t{1} << 20);  // of file_
  std::unique_ptr<std::FILE, Closer> file_;
  std::uint64_t file_bytes_ = 0;
  std::uint64_t at_ = 0;
  std::vector<std::string> problems_;
};

}  // namespace bridges
