// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include "bridges/base/file_descriptor.hpp"

namespace experiment {

/// Lock of a results folder against other runs while this one writes there.  It is released when the process ends.
class ResultsLock {
 public:
  /// Creates and locks the folder.  Throws RunError when another run holds the lock or the folder cannot be created.
  explicit ResultsLock(const std::string& directory);

 private:
  bridges::FileDescriptor folder_;
};

}  // namespace experiment
