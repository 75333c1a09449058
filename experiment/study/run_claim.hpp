// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <string>

#include "bridges/base/file_descriptor.hpp"

namespace experiment {

/// Claim on the folder of a run against other processes that execute the same study.  It ends with the process, however
/// that ends, and on network file systems that have locks.
class RunClaim {
 public:
  /// Creates the folder, below `root`: that of the study.  Throws std::runtime_error when that is not possible, or a
  /// part of it is a symbolic link.
  RunClaim(const std::string& root, const std::string& directory);
  /// Returns the process that has the folder; none when it is claimed by this object now.
  const std::optional<std::string>& owner() const { return owner_; }

 private:
  bridges::FileDescriptor file_;
  std::optional<std::string> owner_;
};

}  // namespace experiment
