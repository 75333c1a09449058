// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <span>

#include "autonomy/cooperative/python/python_host.hpp"

namespace navigation {

/// Returns the files of autonomy/cooperative/python/host.
std::span<const HostFile> host_files();

}  // namespace navigation
