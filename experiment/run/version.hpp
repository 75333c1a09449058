// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

namespace experiment {

/// Returns the version of shoal only: `0.5.0 (a1b2c3d)`.
std::string short_version();
/// Returns the versions of shoal and of the libraries it runs with.
std::string version_text();

}  // namespace experiment
