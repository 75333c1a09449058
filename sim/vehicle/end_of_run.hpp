// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

namespace sim {

/// Why and how the world itself ends the run.
struct EndOfRun {
  std::string text;
  bool passed = true;
  template <typename Archive>
  void visit_state(Archive& archive) {
    archive(text, passed);
  }
};

}  // namespace sim
