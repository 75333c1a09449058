// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <limits>
#include <string>
#include <vector>

#include "sim/script/action.hpp"

namespace sim {

/// Condition of an event.
struct Condition {
  enum class Kind {
    none,
    enters,  ///< subject: vehicle or any; object: zone
    leaves,
    inside,   ///< as enters, and counts a vehicle that is inside at the start
    touches,  ///< vehicles or objects
    message,  ///< subject: channel
    faster,   ///< subject: vehicle or any
    fires,    ///< subject: event
  };
  Kind kind = Kind::none;
  std::string subject;
  std::string object;
  double speed_mps = 0;
};

/// Configuration of an event: actions at given times, periodically, or when a condition becomes true.
struct EventConfig {
  std::string name;
  std::vector<double> at_s;
  double every_s = 0;  ///< period; 0: not periodic
  double from_s = 0;
  double until_s = std::numeric_limits<double>::infinity();
  double jitter_s = 0;
  Condition when;
  double delay_s = 0;
  std::int64_t times = 0;  ///< maximum number of firings; 0: no limit
  double probability = 1;
  std::vector<ActionEntry> actions;
  SourcePlace place;

  void read(ParamReader& in);
  /// Whether a time or a condition lets it fire; otherwise only `trigger` and requests do.
  bool fires_by_itself() const { return !at_s.empty() || every_s > 0 || when.kind != Condition::Kind::none; }

 private:
  void read_times(ParamReader& in);
};

/// Reads the text of `when:`.  Errors are reported at the key; names must be declared.
Condition parse_condition(ParamReader& in, const char* key);

}  // namespace sim
