// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include "sim/random/random.hpp"

namespace sim {

class Diagnostics;
class Script;
class Stage;

/// What an action is carried out with.
struct ActionRun {
  Script& script;
  Stage& stage;
  std::string who;                     ///< such as `event 'night'`; empty: a request
  Random& random;                      ///< of its choices
  Diagnostics* diagnostics = nullptr;  ///< where failures go; null: to the world's warnings
  int depth = 0;                       ///< events that have fired each other up to this one
};

}  // namespace sim
