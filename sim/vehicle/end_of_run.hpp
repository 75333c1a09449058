// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

namespace sim {

/// Reason and result of a run that the world itself ends.
struct EndOfRun {
  std::string text;
  bool passed = true;
  template <typename Archive>
  void visit_state(Archive& archive) {
    archive(text, passed);
  }
};

}  // namespace sim
