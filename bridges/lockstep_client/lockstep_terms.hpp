// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include "sim/run/lockstep.hpp"

namespace bridges {

/// The `text` of a join, as sim::read_lockstep_terms() reads it.  An empty `on_timeout` and a `timeout_s` of 0 are left
/// to the world.
std::string text_of(const sim::LockstepTerms& terms);

/// The `text` of a leave, as sim::read_leave_terms() reads it.
std::string text_of(const sim::LeaveTerms& terms);

/// The `text` of a follow, as sim::read_follow_terms() reads it.
std::string text_of(const sim::FollowTerms& terms);

}  // namespace bridges
