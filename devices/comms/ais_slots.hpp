// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <vector>

#include "sim/random/random.hpp"
#include "sim/state/state_archive.hpp"

namespace devices {

// Times of AIS transmissions by ITU-R M.1371-5.  A slot is numbered from the start of 1970: 2250 of them are a minute.

inline constexpr std::int64_t ais_slots_per_minute = 2250;
/// The last one that a snapshot may name: of the year 8000.
inline constexpr std::int64_t ais_last_slot = 7'100'000'000'000;

/// Returns the time since 1970 at which a slot begins, us.
constexpr std::int64_t ais_slot_begin_us(std::int64_t slot) {
  return (slot * 80'000 + 2) / 3;
}
/// Returns the first slot that begins at or after this time.
constexpr std::int64_t ais_slot_from(std::int64_t utc_us) {
  return (utc_us * 3 + 79'997) / 80'000;
}

enum class AisStation { class_a, class_b, receiver };

/// Returns the interval between position reports, in slots (M.1371-5, annex 1, tables 1 and 2).  `moored`: at anchor or
/// moored, of class A; `turning`: changing course, of class A.
std::int64_t ais_interval_slots(AisStation station, double speed_mps, bool moored, bool turning);

/// Slots that others have announced to use.
class AisReservations {
 public:
  void reserve(std::int64_t slot) { slots_.push_back(slot); }
  void forget_before(std::int64_t slot);
  bool has(std::int64_t slot) const;
  void visit_state(sim::StateArchive& archive) { archive(slots_); }

 private:
  std::vector<std::int64_t> slots_;
};

/// Returns the slots for the next transmission of `length` slots: any within a tenth of the interval around the nominal
/// one, at random among those that no station has reserved; among all if fewer than four are free (annex 2, 3.3.1.2).
std::int64_t choose_ais_slot(std::int64_t nominal, std::int64_t interval, int length, const AisReservations& reserved,
                             sim::Random& random);

}  // namespace devices
