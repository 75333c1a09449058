// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <stdexcept>
#include <string>
#include <system_error>
#include <utility>

#include "experiment/files/no_links.hpp"

namespace experiment {

/// File that gets its name when it is complete.  Until then it is a new file beside it, which the destructor removes;
/// what another program or library writes there by its part_name() counts as well.
template <typename Error = std::runtime_error>
class PartFile {
 public:
  /// Makes the file `path` + `ending`, in place of a file or link of this name.  Throws an Error with `path` and the
  /// reason.
  explicit PartFile(std::string path, const std::string& ending = ".part")
      : path_(std::move(path)), part_(path_ + ending) {
    try {
      file_ = make_new_file(part_);
    } catch (const std::system_error& error) {
      throw Error(path_ + ": cannot be written: " + error.code().message());
    }
  }
  ~PartFile() {
    if (!part_.empty()) unlink(part_.c_str());
  }
  PartFile(const PartFile&) = delete;
  PartFile& operator=(const PartFile&) = delete;

  const std::string& path() const { return path_; }
  const std::string& part_name() const { return part_; }
  /// Returns the descriptor of the file, for reading and writing.
  int number() const { return file_.number(); }
  /// Gives the file its name.  Throws an Error with `path` and the reason.
  void finish() {
    if (std::rename(part_.c_str(), path_.c_str()) != 0)
      throw Error(path_ + ": cannot be written: " + std::generic_category().message(errno));
    part_.clear();
  }

 private:
  const std::string path_;
  std::string part_;
  bridges::FileDescriptor file_;
};

}  // namespace experiment
