// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <optional>

namespace autonomy {

/// Time division: `slots` senders take turns of `slot_s` each, by the time of their own clocks.
class Tdma {
 public:
  struct Params {
    int slot = 0;   ///< the own one, from 0
    int slots = 1;  ///< in a cycle
    double slot_s = 10;
    /// The slot is not begun in its last seconds: a packet and the way of its sound have to fit into the rest.
    double guard_s = 5;
  };

  /// Throws std::invalid_argument unless 0 <= slot < slots and 0 <= guard_s < slot_s.
  explicit Tdma(const Params& params);

  /// Whether to send now; true once for each turn.  A clock that is set back silences it for two cycles at most.
  bool take_turn(std::int64_t utime);

 private:
  Params params_;
  std::int64_t slot_us_;
  std::int64_t guard_us_;
  std::optional<std::int64_t> last_turn_;
};

/// The guard time of who does not know how long a packet is: turns begin in the first second of the slot only, in a
/// slot of less than 2 s in its first half.  Stamps that come once a second give a turn in each.
double default_guard_s(double slot_s);

}  // namespace autonomy
