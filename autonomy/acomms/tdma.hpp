// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <optional>

namespace autonomy {

/// Time division multiple access: `slots` senders take turns of `slot_s` each, by their own clocks.
class Tdma {
 public:
  struct Params {
    int slot = 0;   ///< own slot, from 0
    int slots = 1;  ///< in a cycle
    double slot_s = 10;
    /// No packet is started in the last seconds of a slot: transmission and propagation must end within it.
    double guard_s = 5;
  };

  /// Throws std::invalid_argument unless 0 <= slot < slots and 0 <= guard_s < slot_s.
  explicit Tdma(const Params& params);

  /// Returns whether to send now; true once for each turn.  A clock that is set back silences the sender for two cycles
  /// at most.
  bool take_turn(std::int64_t utime);

 private:
  Params params_;
  std::int64_t slot_us_;
  std::int64_t guard_us_;
  std::optional<std::int64_t> last_turn_;
};

/// Returns the guard time for an unknown packet length: turns start only in the first second of the slot, in a slot of
/// less than 2 s in its first half.  Time stamps at 1 Hz give a turn in each slot.
double default_guard_s(double slot_s);

}  // namespace autonomy
