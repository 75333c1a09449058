// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <string>

namespace bridges {

/// Locks an open file or folder against other runs, for as long as the file stays open; the lock is released when the
/// process ends.  Returns std::nullopt on success, else the owner of the lock, such as `process 1234 (shoal run
/// world.yaml)`.
std::optional<std::string> lock_against_others(int file);

}  // namespace bridges
