// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

#include "sim/medium/medium_config.hpp"

namespace sim {

/// Invalid CTD file; the text completes a sentence that begins with the file.
struct CtdError : std::runtime_error {
  using std::runtime_error::runtime_error;
};

/// Depth in m at a pressure relative to the atmosphere, at 45 degrees of latitude: Fofonoff and Millard, Unesco
/// technical papers in marine science 44 (1983).
double depth_of_pressure_m(double pressure_dbar);

/// Profile of water from a cast.
struct CtdCast {
  std::vector<WaterLayerConfig> rows;  ///< of increasing depth
  std::vector<std::string> warnings;   ///< about rows that are skipped or unusual, with line and value
};

/// Reads a profile of water from the CSV text of a CTD.  The header names `depth_m` or `pressure_dbar`, `temperature_C`
/// and `salinity_psu`, and perhaps `sound_speed_mps` and `density_kgpm3`, in any order; other columns and lines that
/// begin with # are ignored.  Rows with missing values (empty, NaN, or a code such as -9.99e-29, 9999 or 99.999) are
/// skipped with a warning.  The profile is the downcast, or the upcast if that is more than twice as long; heave of up
/// to a tenth of the depth, from 2 to 5 m, is taken out.  More than `ctd_rows` rows are averaged in layers of equal
/// thickness.  Throws CtdError with the line, also for a spike of the depth and for more than one cast.
CtdCast parse_ctd(std::string_view text);
inline constexpr std::size_t ctd_rows = 200;

/// The same from a file.
CtdCast read_ctd_file(const std::string& path);

}  // namespace sim
