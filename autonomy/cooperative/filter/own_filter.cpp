// SPDX-License-Identifier: BSD-3-Clause
#include "autonomy/cooperative/filter/own_filter.hpp"

#include <stdexcept>
#include <string>

namespace navigation {

double sender_clock_variance_m2(const Setup& setup, int sender, Time since_start) {
  const DeviceErrors& errors = setup.team[static_cast<std::size_t>(sender)].errors;
  const double t_s = seconds(since_start);
  const double variance_s2 = errors.clock_s * errors.clock_s + errors.clock_drift * errors.clock_drift * t_s * t_s +
                             errors.clock_walk_srts * errors.clock_walk_srts * t_s;
  return setup.sound_speed_mps * setup.sound_speed_mps * variance_s2;
}

std::optional<Position> position_in(std::span<const std::uint8_t> payload) {
  PayloadReader reader(payload);
  return read_position(reader);
}

Bytes payload_of(const Position& position) {
  Bytes bytes;
  PayloadWriter writer(bytes);
  write_position(writer, position);
  return bytes;
}

void need_bytes(const Setup& setup, const char* algorithm, std::size_t needed) {
  if (setup.payload_bytes < needed)
    throw std::invalid_argument(std::string(algorithm) + " needs frames with " + std::to_string(needed) +
                                " bytes of payload, these have " + std::to_string(setup.payload_bytes));
}

}  // namespace navigation
