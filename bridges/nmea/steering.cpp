// SPDX-License-Identifier: BSD-3-Clause
#include "bridges/nmea/steering.hpp"

#include <cstdlib>
#include <limits>
#include <utility>

#include "sim/base/math.hpp"

namespace bridges::nmea {

std::string Steering::take(std::string_view line, std::int64_t utime) {
  sim::NmeaSentence sentence;
  switch (sim::parse_nmea(line, sentence)) {
    case sim::NmeaError::no_sentence:
      return "a line must be a sentence of NMEA 0183, which begins with $";
    case sim::NmeaError::bad_checksum:
      return "the checksum of a sentence must be the exclusive or of its characters";
    case sim::NmeaError::none:
      break;
  }
  if (is_a<Apb>(sentence)) {
    const auto apb = read<Apb>(sentence);
    return apb ? take(*apb, utime) : "APB has a field that it cannot have";
  }
  if (is_a<Rmb>(sentence)) {
    const auto rmb = read<Rmb>(sentence);
    return rmb ? take(*rmb, utime) : "RMB has a field that it cannot have";
  }
  return {};
}

std::string Steering::take(const Apb& apb, std::int64_t utime) {
  if (apb.status != 'A' || apb.lock != 'A') return "APB is not followed: its status is V, a warning";
  if (!apb.heading_deg) return "APB is not followed: it has no heading to steer";
  apb_utime_ = utime;
  steer(*apb.heading_deg + (apb.heading_reference == 'M' ? variation_deg_ : 0), utime);
  return {};
}

std::string Steering::take(const Rmb& rmb, std::int64_t utime) {
  if (apb_utime_ && std::abs(utime - *apb_utime_) < prefer_apb_us) return {};
  if (rmb.status != 'A') return "RMB is not followed: its status is V, a warning";
  if (!rmb.bearing_deg) return "RMB is not followed: it has no bearing to the destination";
  steer(*rmb.bearing_deg, utime);
  return {};
}

void Steering::steer(double heading_deg, std::int64_t utime) {
  constexpr double unchanged = std::numeric_limits<double>::quiet_NaN();
  shoal::helm_command_t command{};
  command.utime = utime;
  command.speed_mps = command.depth_m = command.altitude_m = unchanged;
  command.heading_rad = sim::wrap_angle(sim::degrees_to_radians(90 - heading_deg));
  command_ = command;
}

std::optional<shoal::helm_command_t> Steering::take_command() {
  return std::exchange(command_, std::nullopt);
}

}  // namespace bridges::nmea
