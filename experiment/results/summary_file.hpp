// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "bridges/base/file_descriptor.hpp"
#include "bridges/control/run_audit.hpp"
#include "experiment/score/rule_verdict.hpp"

namespace experiment {

/// Removes a link at the path of a file to be written, because the link would redirect the write.  Other files are
/// kept, and so are links to terminals and other devices.
void remove_link(const std::string& path);

/// File summary.json of a run, with disk space reserved from the start, so that a disk that is full at the end does not
/// lose score and hash.  The reserved space is in `summary.json.part` and `.part2` beside it, because the summary may
/// be written twice.
class SummaryFile {
 public:
  /// Reserves the space.  Throws std::runtime_error with path and reason when there is not enough.
  SummaryFile(const std::string& directory, std::size_t bytes);
  ~SummaryFile();
  SummaryFile(const SummaryFile&) = delete;
  SummaryFile& operator=(const SummaryFile&) = delete;

  /// Writes the file atomically.  Throws std::runtime_error.
  void write(const std::string& text);

 private:
  struct Room {
    std::string path;
    bridges::FileDescriptor file;
  };
  void make_room(const std::string& path, std::size_t bytes);

  std::string path_;
  std::vector<Room> rooms_;
};

/// Returns the entries of `control.audit` in summary.json.
nlohmann::ordered_json audit_json(const std::vector<bridges::AuditEntry>& audit);

/// Returns one line: `quit at 12.30 s by client 'shoal-control-4711'`.
std::string audit_text(const bridges::AuditEntry& audit_entry);

/// Returns an entry of `rules` in summary.json and study.json.
nlohmann::ordered_json json_of(const RuleVerdict& verdict);

}  // namespace experiment
