// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace experiment {

struct BugOptions {
  std::string directory;     ///< results of the run
  std::string record;        ///< of the run; empty: the only one in the folder
  std::string out;           ///< the archive; empty: DIRECTORY/bug.tar.gz
  double last_s = 10;        ///< simulated seconds of the record
  std::int64_t max_MB = 64;  ///< limit of the record's part, before compression
  bool files = true;         ///< includes copies of small files that the world names; their hashes are always included
};

/// Contents of a bug report.
struct BugReport {
  std::string path;
  std::vector<std::string> inside;    ///< one line per file: name, size, description
  std::vector<std::string> left_out;  ///< omitted files with the reason
};

/// Packs the files that developers need to investigate a run into one archive: world, summary, versions, logs and the
/// end of the record.  Includes only plain files of the run's folder, the record and files that the world names. Throws
/// std::runtime_error when the folder is not that of a run, the record is not of this run, or a file cannot be read or
/// written.
BugReport write_bug_report(const BugOptions& options);

}  // namespace experiment
