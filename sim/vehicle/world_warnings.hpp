// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "sim/config/warnings.hpp"
#include "sim/state/state_archive.hpp"
#include "sim/vehicle/step_clock.hpp"

namespace sim {

/// What a world warns of, in the log.
class WorldWarnings {
 public:
  /// `clock` must outlive this.
  explicit WorldWarnings(const StepClock& clock) : clock_(clock) {}

  /// What is found while the world, or something in it, is built.  A world that is rebuilt after a restore does not
  /// repeat them.
  Warnings& building() { return building_; }
  /// Something that a client or an event did wrong, with the time of the world.  All are counted; the same line is
  /// logged once, and at most 100 lines are.
  void bad_message(const std::string& who, const std::string& text);
  /// Something that is worth knowing, with the time of the world.  Not counted.
  void warn(const std::string& who, const std::string& text) const;

  std::int64_t bad_messages() const { return bad_messages_; }
  void visit_state(StateArchive& archive) { archive(bad_messages_, lines_); }

 private:
  const StepClock& clock_;
  Warnings building_;
  std::int64_t bad_messages_ = 0;
  std::vector<std::string> lines_;  // of bad messages
};

}  // namespace sim
