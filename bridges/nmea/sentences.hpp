// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "sim/nmea/nmea.hpp"

namespace bridges::nmea {

// The sentences of NMEA 0183 (IEC 61162-1) as types, each with the fields of its sentence in their order and units:
// knots, degrees clockwise, meters.  An absent field is empty in the sentence.

using Number = std::optional<double>;

/// UTC in microseconds since 1970, with the resolution of a sentence: 10 ms.  A sentence without a date has the time of
/// day only.
using Utc = std::optional<std::int64_t>;

/// Recommended minimum data of a satellite receiver.
struct Rmc {
  static constexpr std::string_view type = "RMC";
  Utc time;
  char status = 'V';  ///< A: valid, V: warning
  Number latitude_deg, longitude_deg;
  Number speed_kn;       ///< over ground
  Number course_deg;     ///< over ground, true
  Number variation_deg;  ///< of the compass, positive to the east
  char mode = 'N';       ///< A: autonomous, D: differential, N: no fix
};

/// Fix of a satellite receiver.
struct Gga {
  static constexpr std::string_view type = "GGA";
  Utc time;
  Number latitude_deg, longitude_deg;
  int quality = 0;  ///< 0: none, 1: autonomous, 2: differential
  int satellites = 0;
  Number hdop;        ///< dilution of precision
  Number altitude_m;  ///< of the antenna above mean sea level
  Number geoid_m;     ///< of mean sea level above the ellipsoid
};

/// True heading.
struct Hdt {
  static constexpr std::string_view type = "HDT";
  Number heading_deg;
};

/// Course and speed over ground.
struct Vtg {
  static constexpr std::string_view type = "VTG";
  Number course_deg, magnetic_course_deg;
  Number speed_kn, speed_kmph;
  char mode = 'N';  ///< as in RMC
};

/// Heading, and speed through the water.
struct Vhw {
  static constexpr std::string_view type = "VHW";
  Number heading_deg, magnetic_heading_deg;
  Number speed_kn, speed_kmph;
};

/// Depth below the transducer.
struct Dbt {
  static constexpr std::string_view type = "DBT";
  Number depth_ft, depth_m, depth_fathoms;
};

/// Depth below the transducer, and the place of the transducer.
struct Dpt {
  static constexpr std::string_view type = "DPT";
  Number depth_m;
  Number offset_m;  ///< positive: from the transducer to the water line, negative: to the keel
};

/// Wind.
struct Mwv {
  static constexpr std::string_view type = "MWV";
  Number angle_deg;      ///< where it comes from, from the bow, 0 to 360
  char reference = 'R';  ///< R: relative to the vessel (apparent), T: true
  Number speed;
  char unit = 'N';    ///< N: knots, M: m/s, K: km/h
  char status = 'V';  ///< A: valid
};

/// Rate of turn.
struct Rot {
  static constexpr std::string_view type = "ROT";
  Number degpmin;     ///< negative: the bow turns to port
  char status = 'V';  ///< A: valid
};

/// A quantity of a transducer.
struct Xdr {
  static constexpr std::string_view type = "XDR";
  char kind = 'A';  ///< A: angle, P: pressure, C: temperature, D: depth
  Number value;
  char unit = 'D';  ///< D: degrees, P: pascal, B: bar, C: Celsius, M: meters
  std::string name;
};

/// Autopilot sentence B: the heading to steer to a waypoint.
struct Apb {
  static constexpr std::string_view type = "APB";
  char status = 'V';  ///< A: valid, V: a receiver warns
  char lock = 'V';    ///< A: valid, V: cycle lock warning of a receiver
  Number cross_track_nmi;
  char steer = 'L';  ///< L or R: where to steer to
  char cross_track_unit = 'N';
  char arrived = 'V';         ///< A: the arrival circle was entered
  char passed = 'V';          ///< A: the perpendicular at the waypoint was passed
  Number origin_bearing_deg;  ///< from the origin to the destination
  char origin_reference = 'T';
  std::string waypoint;
  Number bearing_deg;  ///< from the vessel to the destination
  char bearing_reference = 'T';
  Number heading_deg;            ///< to steer
  char heading_reference = 'T';  ///< T: true, M: magnetic
};

/// Recommended minimum navigation to a waypoint.
struct Rmb {
  static constexpr std::string_view type = "RMB";
  char status = 'V';  ///< A: valid, V: warning
  Number cross_track_nmi;
  char steer = 'L';
  std::string origin, waypoint;
  Number latitude_deg, longitude_deg;  ///< of the destination
  Number range_nmi;
  Number bearing_deg;  ///< to the destination, true
  Number closing_kn;
  char arrived = 'V';
  char mode = 'A';
};

/// Returns the whole sentence, without its line end.  `talker`: two characters, such as GP.
template <class Sentence>
std::string format(const Sentence& sentence, std::string_view talker);

/// Reads the fields; none when one of them is not what the sentence has there, or out of its range.  Fields that are
/// missing at the end count as empty, further ones are ignored, as versions of the standard differ in them.
template <class Sentence>
std::optional<Sentence> read(const sim::NmeaSentence& sentence);

/// Returns whether a sentence, of any talker, has this type.
template <class Sentence>
bool is_a(const sim::NmeaSentence& sentence) {
  return sentence.name().size() == 5 && std::string_view(sentence.name()).substr(2) == Sentence::type;
}

}  // namespace bridges::nmea
