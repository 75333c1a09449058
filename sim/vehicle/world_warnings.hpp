// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <utility>
#include <vector>

#include "sim/config/warnings.hpp"
#include "sim/state/state_archive.hpp"
#include "sim/vehicle/step_clock.hpp"

namespace sim {

/// Warnings of a world, written to the log.
class WorldWarnings {
 public:
  /// `clock` must outlive this.
  explicit WorldWarnings(const StepClock& clock) : clock_(clock) {}

  /// Returns the warnings found while the world, or an entity in it, is built.  A world that is rebuilt after a restore
  /// does not repeat them.
  Warnings& building() { return building_; }
  /// Reports an error of a client or an event, with the time of the world.  All errors are counted; the same line is
  /// logged once, and at most 100 lines are logged.
  void bad_message(const std::string& who, const std::string& text);
  /// Logs a warning with the time of the world.  It is not counted.
  void warn(const std::string& who, const std::string& text) const;
  /// Keeps a warning for the end of the run, with the time of the world: the first of each `who`, at most 100.
  void keep_for_end(const std::string& who, const std::string& text);
  /// Returns the kept warnings, in the order of time.
  const std::vector<std::string>& kept() const { return kept_; }
  /// Logs a fault that a device has found in itself, as warn(), and passes it to the listener.
  void device_fault(const std::string& device, const std::string& text) const;
  /// Sets the listener of device_fault(); null: none.
  void listen_to_device_faults(std::function<void(const std::string& device, const std::string& text)> listener) {
    fault_listener_ = std::move(listener);
  }

  std::int64_t bad_messages() const { return bad_messages_; }
  void visit_state(StateArchive& archive) { archive(bad_messages_, lines_, kept_of_, kept_); }

 private:
  const StepClock& clock_;
  Warnings building_;
  std::int64_t bad_messages_ = 0;
  std::vector<std::string> lines_;           // of bad messages
  std::vector<std::string> kept_of_, kept_;  // who, and the line about it
  std::function<void(const std::string&, const std::string&)> fault_listener_;
};

}  // namespace sim
