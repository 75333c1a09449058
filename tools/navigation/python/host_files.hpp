// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <span>

#include "tools/navigation/python/python_host.hpp"

namespace navigation {

/// Returns the files of tools/navigation/python/host.
std::span<const HostFile> host_files();

}  // namespace navigation
