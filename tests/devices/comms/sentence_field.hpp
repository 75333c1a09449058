// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include "sim/nmea/nmea.hpp"

namespace test {

/// Field `i` of an NMEA sentence, counted from the one after its name as 1.
inline std::string field(const std::string& sentence, std::size_t i) {
  sim::NmeaSentence parsed;
  sim::parse_nmea("$" + sentence, parsed);
  return parsed.at(i);
}

}  // namespace test
