// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include "shoal/message_schema.hpp"

namespace shoal {

/// The types of one .lcm text, with fingerprint and pointers to other types still missing.
std::vector<MessageSchema> parse_lcm(const LcmSource& source);

}  // namespace shoal
