// SPDX-License-Identifier: BSD-3-Clause
#include "devices/comms/ais_slots.hpp"

#include <algorithm>
#include <cmath>

namespace devices {

std::int64_t ais_interval_slots(AisStation station, double speed_mps, bool moored, bool turning) {
  const double knots = std::round(speed_mps * 36'000 / 1852) / 10;                               // as it is sent
  const auto seconds = [](std::int64_t thirds) { return thirds * ais_slots_per_minute / 180; };  // of thirds
  if (station == AisStation::class_b) return seconds(knots > 2 ? 3 * 30 : 3 * 180);
  if (moored) return seconds(knots > 3 ? 3 * 10 : 3 * 180);
  if (knots > 23) return seconds(3 * 2);
  if (knots > 14) return seconds(turning ? 3 * 2 : 3 * 6);
  return seconds(turning ? 10 : 3 * 10);
}

void AisReservations::forget_before(std::int64_t slot) {
  std::erase_if(slots_, [&](std::int64_t reserved) { return reserved < slot; });
}

bool AisReservations::has(std::int64_t slot) const {
  return std::find(slots_.begin(), slots_.end(), slot) != slots_.end();
}

std::int64_t choose_ais_slot(std::int64_t nominal, std::int64_t interval, int length, const AisReservations& reserved,
                             sim::Random& random) {
  const std::int64_t half = std::max<std::int64_t>(interval / 10, 2);
  std::vector<std::int64_t> candidates;
  for (std::int64_t slot = nominal - half; slot <= nominal + half; ++slot) {
    bool is_free = true;
    for (int i = 0; i < length; ++i) is_free &= !reserved.has(slot + i);
    if (is_free) candidates.push_back(slot);
  }
  constexpr std::size_t enough = 4;
  if (candidates.size() < enough)
    return nominal - half + random.integer_below(static_cast<std::uint32_t>(2 * half + 1));
  return candidates[random.integer_below(static_cast<std::uint32_t>(candidates.size()))];
}

}  // namespace devices
