// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string_view>

namespace sim {

/// The name in Shoal of what other simulators name differently, such as `hinge` for `revolute`; empty: none.
std::string_view synonym_of(std::string_view word);

}  // namespace sim
