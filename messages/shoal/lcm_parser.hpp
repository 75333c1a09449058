// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include "shoal/message_schema.hpp"

namespace shoal {

/// Returns the types of one .lcm text, without fingerprints and pointers to other types.
std::vector<MessageSchema> parse_lcm(const LcmSource& source);

}  // namespace shoal
