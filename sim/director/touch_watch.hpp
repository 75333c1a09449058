// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "sim/director/condition_watch.hpp"

namespace sim {

/// Makes the watch of `NAME touches NAME`.  `any`: every vehicle and object except those made of planes, on which
/// everything rests.
std::unique_ptr<ConditionWatch> make_touch_watch(const Condition& condition, Stage& stage);

}  // namespace sim
