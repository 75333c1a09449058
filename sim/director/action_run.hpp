// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include "sim/random/random.hpp"

namespace sim {

class Diagnostics;
class Script;
class Stage;

/// Context in which an action is executed.
struct ActionRun {
  Script& script;
  Stage& stage;
  std::string who;                     ///< such as `event 'night'`; empty: a request
  Random& random;                      ///< for random choices
  Diagnostics* diagnostics = nullptr;  ///< receives failures; null: the warnings of the world
  int depth = 0;                       ///< length of the chain of events that fired each other
};

}  // namespace sim
