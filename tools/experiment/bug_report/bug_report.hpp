// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace tools {

struct BugOptions {
  std::string directory;     ///< results of the run
  std::string record;        ///< of the run; empty: the one in the folder, when there is just one
  std::string out;           ///< the archive; empty: DIRECTORY/bug.tar.gz
  double last_s = 10;        ///< simulated seconds of the record
  std::int64_t max_MB = 64;  ///< of the record's part, before it is compressed
  bool files = true;         ///< copies of small files that the world names; their hashes are there in any case
};

/// What became of it.
struct BugReport {
  std::string path;
  std::vector<std::string> inside;    ///< a line for each file: name, size, what it is
  std::vector<std::string> left_out;  ///< and why
};

/// Packs what developers need to look at a run into one archive: world, summary, versions, logs and the end of the
/// record.  Takes plain files of the run's folder, the record and files that the world names, and nothing else.
/// Throws std::runtime_error: the folder is not that of a run, the record is not of this run, or a file cannot be read
/// or written.
BugReport write_bug_report(const BugOptions& options);

/// What to type to report a run that broke; `results` and `record` as of `shoal run`, empty: none.
std::string bug_hint(const std::string& results, const std::string& record);

}  // namespace tools
