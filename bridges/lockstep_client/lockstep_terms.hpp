// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <string>

#include "sim/run/lockstep.hpp"

namespace bridges {

/// What a word says; nothing of an empty one, which leaves it to the world.  Throws BusError that lists the words.
std::optional<sim::OnTimeout> on_timeout_of(const std::string& word);

/// The `text` of a join, as sim::read_lockstep_terms() reads it.  `on_timeout` is left to the world unless it is
/// `agreed`, and so is a `timeout_s` of 0.
std::string text_of(const sim::LockstepTerms& terms);

/// The `text` of a leave, as sim::read_leave_terms() reads it.
std::string text_of(const sim::LeaveTerms& terms);

/// The `text` of a follow, as sim::read_follow_terms() reads it.
std::string text_of(const sim::FollowTerms& terms);

}  // namespace bridges
