// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <memory>

#include "sim/script/event_config.hpp"
#include "sim/state/state_archive.hpp"

namespace sim {

class Stage;
class Zones;

/// Detects when the condition of an event becomes true.
class ConditionWatch {
 public:
  virtual ~ConditionWatch() = default;
  /// Returns how often the condition became true since the last call; called once in each step.
  virtual int count_new(Stage& stage) = 0;
  virtual void visit_state(StateArchive& archive) = 0;
};

/// Makes the watch of a condition; null when none is needed: no condition, or the firing of another event.
std::unique_ptr<ConditionWatch> make_watch(const Condition& condition, Stage& stage, const Zones& zones);

/// Makes the watch of `NAME touches NAME`.  `any`: every vehicle and object except those made of planes, on which
/// everything rests.
std::unique_ptr<ConditionWatch> make_touch_watch(const Condition& condition, Stage& stage);

}  // namespace sim
