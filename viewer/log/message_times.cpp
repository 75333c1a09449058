// SPDX-License-Identifier: BSD-3-Clause
#include "viewer/log/message_times.hpp"

#include "shoal/wire_value.hpp"

namespace viewer {

std::optional<std::int64_t> stamp_of(std::span<const std::byte> payload) {
  constexpr std::size_t fingerprint_bytes = 8, stamp_bytes = 8;
  if (payload.size() < fingerprint_bytes + stamp_bytes) return std::nullopt;
  return static_cast<std::int64_t>(shoal::big_endian<std::uint64_t>(payload.data() + fingerprint_bytes));
}

void MessageTimes::take(std::string_view channel, std::span<const std::byte> payload, std::int64_t stamp_us) {
  stamp_us_ = stamp_us;
  if (channel != "sim.clock" && channel != "sim.state" && channel != "sim.bodies" && channel != "sim.info") return;
  const auto utime = stamp_of(payload);
  if (!utime) return;
  simulated_us_ = *utime;
  offset_us_ = *utime - stamp_us;
  is_simulated_ = offset_us_ == 0;
}

}  // namespace viewer
