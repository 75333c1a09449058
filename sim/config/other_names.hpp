// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string_view>

namespace sim {

/// The present name of what had another one in version 0.1, such as `max_gap_s` for `longest_gap_s`; empty: none.
std::string_view renamed_to(std::string_view former);

/// The name in Shoal of what other simulators name differently, such as `hinge` for `revolute`; empty: none.
std::string_view synonym_of(std::string_view word);

}  // namespace sim
