// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include "bridges/base/file_descriptor.hpp"

namespace tools {

/// Keeps other runs out of a results folder while this one writes there.  A run that dies lets go of it.
class ResultsLock {
 public:
  /// Makes the folder.  Throws RunError when another run has it or it cannot be made.
  explicit ResultsLock(const std::string& directory);

 private:
  bridges::FileDescriptor folder_;
};

}  // namespace tools
