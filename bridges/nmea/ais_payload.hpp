// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "shoal/ais_t.hpp"

namespace bridges::nmea {

// The bits of AIS messages, by ITU-R M.1371-5, annex 8, and their sentences AIVDM and AIVDO, by IEC 61162-1.

/// Returns a message as six-bit characters of a sentence.  Types 1, 5, 18 and 24; empty for others.  `utc_second`: of
/// the position, for types 1 and 18.
std::string ais_payload(const shoal::ais_t& message, int utc_second);

/// Reads the six-bit characters of a message of these types; none for other types, other characters and other lengths.
/// Fields without a value are NaN.  Own, channel and slot are not in the payload.
std::optional<shoal::ais_t> read_ais_payload(std::string_view payload);

/// Returns the sentences of a message, without line ends: AIVDO when it is the station's own, else AIVDM.  `group`: 0
/// to 9, marks the sentences of one message that needs two.
std::vector<std::string> ais_sentences(const shoal::ais_t& message, int utc_second, int group);

}  // namespace bridges::nmea
