// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include "bridges/signing/run_key.hpp"

namespace experiment {

/// New key of a run, in a file that only its user can read, for the duration of the run.
class RunKeyFile {
 public:
  /// Writes `folder`/run.key; without a folder it creates one for this run, in XDG_RUNTIME_DIR or /tmp.  Replaces a key
  /// of an earlier run in `folder`.  Throws BusError with path and reason.
  explicit RunKeyFile(const std::string& folder);
  /// Removes the file, and the folder if it was created here.
  ~RunKeyFile();
  RunKeyFile(const RunKeyFile&) = delete;
  RunKeyFile& operator=(const RunKeyFile&) = delete;

  const bridges::RunKey& key() const { return key_; }
  /// Folder of the file.
  const std::string& folder() const { return folder_; }

 private:
  void write() const;

  bridges::RunKey key_;
  std::string folder_;
  bool own_folder_ = false;
};

}  // namespace experiment
