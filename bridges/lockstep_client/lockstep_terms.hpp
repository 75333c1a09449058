// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <string>

#include "sim/run/lockstep.hpp"

namespace bridges {

/// Returns the value of a word; none for an empty one, which leaves the choice to the world.  Throws BusError with the
/// list of words.
std::optional<sim::OnTimeout> on_timeout_of(const std::string& word);

/// Returns the `text` of a join, as read by sim::read_lockstep_terms().  `on_timeout` is left to the world unless it is
/// `agreed`, and so is a `timeout_s` of 0.
std::string text_of(const sim::LockstepTerms& terms);

/// Returns the `text` of a leave, as read by sim::read_leave_terms().
std::string text_of(const sim::LeaveTerms& terms);

/// Returns the `text` of a follow, as read by sim::read_follow_terms().
std::string text_of(const sim::FollowTerms& terms);

}  // namespace bridges
