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
#include "shoal/sim_info_t.hpp"

namespace bridges {

/// Event of a record, valid until the next one is read.
struct RecordEvent {
  std::string_view channel;
  std::int64_t utime = 0;
  std::span<const std::byte> payload;
};

/// Reader of the events of a record, an LCM event log or an MCAP file of Shoal, in the order of the file.
class RecordReader {
 public:
  virtual ~RecordReader() = default;
  /// Reads the next event; returns false at the end.
  virtual bool next(RecordEvent& event) = 0;
  /// Returns the problems found so far, such as `byte 4711: 28 bytes between events were skipped`.
  virtual std::vector<std::string> problems() const = 0;
};

/// Opens a record; a name that ends with .mcap is that of an MCAP file, of which the messages of LCM channels are read,
/// not those that repeat them in standard types.  Throws BusError when the file cannot be opened, is not a regular file
/// or not of its format; an empty file is a log.
std::unique_ptr<RecordReader> open_record(const std::string& path);

/// Decodes the sim.info of a record.  Its world and versions, which are printed, have no control characters: the record
/// may be a stranger's.  Throws shoal::MessageError.
shoal::sim_info_t read_run_info(std::span<const std::byte> payload);

}  // namespace bridges
