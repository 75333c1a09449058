// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include "bridges/signing/run_key.hpp"

namespace tools {

/// The key of a run, new and in a file that only its user can read, as long as the run continues.
class RunKeyFile {
 public:
  /// Writes `folder`/run.key; without a folder it makes one for this run alone, in XDG_RUNTIME_DIR or /tmp.  A key that
  /// a run before left in `folder` is replaced.  Throws BusError with path and reason.
  explicit RunKeyFile(const std::string& folder);
  /// Removes the file, and the folder that was made.
  ~RunKeyFile();
  RunKeyFile(const RunKeyFile&) = delete;
  RunKeyFile& operator=(const RunKeyFile&) = delete;

  const bridges::RunKey& key() const { return key_; }
  /// Where the file is.
  const std::string& folder() const { return folder_; }

 private:
  void write() const;

  bridges::RunKey key_;
  std::string folder_;
  bool own_folder_ = false;
};

}  // namespace tools
