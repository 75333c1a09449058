// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "bridges/base/bus_error.hpp"
#include "bridges/base/file_descriptor.hpp"

namespace bridges {

enum class Existing { refuse, overwrite };

/// File into which a run records its messages.  Functions that return bool return false after a failed write; errno has
/// the reason.
class RecordFile {
 public:
  virtual ~RecordFile() = default;

  virtual bool write(std::int64_t number, std::int64_t utime, std::string_view channel,
                     std::span<const std::byte> payload) = 0;
  /// Passes buffered messages to the thread that writes, without waiting.
  virtual bool hand_over() = 0;
  /// Waits until everything is written.
  virtual bool flush() = 0;
  /// Completes the file; nothing may be written afterwards.
  virtual bool finish() = 0;
  /// Returns the end of the record so far, for branch_to().
  virtual std::uint64_t position() const = 0;
  /// Creates another file, which starts with a copy of this record up to a position.  Returns null when that is not
  /// possible, in which case the file may exist.  Throws BusError when it cannot be created.
  virtual std::unique_ptr<RecordFile> branch_to(const std::string& path, std::uint64_t position, Existing existing) = 0;
  /// Returns what a reader of the record should know, such as messages that cannot be decoded.
  virtual std::vector<std::string> problems() const { return {}; }
};

/// Returns whether this name is that of an MCAP file; all others are LCM event logs.
bool is_mcap_name(std::string_view path);
/// Creates an empty file with the lock of a record.  Throws BusError when the file exists and may not be overwritten,
/// cannot be created, or is in use by another run.
FileDescriptor create_record_file(const std::string& path, Existing existing);
/// Creates a record, in the format of its name.  Throws BusError like create_record_file().
std::unique_ptr<RecordFile> create_record(const std::string& path, Existing existing);

}  // namespace bridges
