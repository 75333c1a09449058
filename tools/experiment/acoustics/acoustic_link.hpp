// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "sim/acoustics/acoustics_config.hpp"
#include "sim/acoustics/directivity.hpp"
#include "sim/acoustics/modulation.hpp"
#include "sim/medium/medium.hpp"

namespace tools {

/// What is sent in one piece: all of its bits must come through.
struct AcousticPacket {
  sim::Modulation modulation = sim::Modulation::fsk;
  double bit_rate_bps = 80;
  std::int64_t bytes = 32;
  std::string name;                    ///< such as `fsk_80_32`
  std::optional<double> bandwidth_Hz;  ///< unset: that of the link
};

/// Of the text `fsk:80:32` (modulation, bit/s, bytes).  Nothing when it is something else.
std::optional<AcousticPacket> parse_packet(const std::string& text);

/// A frame of each rate of the WHOI Micro-Modem, 0 to 6, in its own bandwidth.
std::vector<AcousticPacket> micromodem_packets();

/// An end of a link.
struct LinkEnd {
  sim::Vector3d p_W = sim::Vector3d::Zero();
  sim::Matrix3d R_WS = sim::Matrix3d::Identity();
  sim::DirectivityConfig directivity;
  int group = -1;                      ///< of the vehicle there
  std::optional<double> detection_dB;  ///< of the transducer there, if there is one
};

struct AcousticLink {
  LinkEnd from, to;
  sim::Decibels source_level{185};  ///< re 1 uPa at 1 m, on the axis
  double centre_Hz = 25000;
  double bandwidth_Hz = 4000;
  sim::Decibels detection{6};  ///< over the noise, which the receiver needs to notice anything
  sim::Decibels coding_gain{0};
};

/// What becomes of the level on its way.
struct LinkBudget {
  double range_m = 0;
  double travel_time_s = 0;
  double absorption_dBpkm = 0;
  double wind_mps = 0;
  sim::Decibels from_gain, spreading, absorption, to_gain;  ///< all are added; losses are negative
  std::optional<sim::Decibels> echoes;  ///< multipath: all inside the window over the first path, phases averaged
  std::optional<sim::Decibels> late;    ///< multipath: level of what disturbs
  double delay_spread_s = 0;            ///< multipath: rms
  sim::Decibels level;                  ///< of the direct path at the receiver
  sim::Decibels noise_per_Hz, noise_reduction;  ///< the second by the receiver's directivity
  sim::Decibels noise;                          ///< in the band, after that
  sim::Decibels snr;                            ///< of the direct path
};

/// Without fading.  `water_depth_m`: of a flat bottom, for echoes, where the world's `multipath:` does not say it;
/// unset: no bottom.
LinkBudget link_budget(const AcousticLink& link, const sim::AcousticsConfig& acoustics, const sim::Medium& medium,
                       std::optional<double> water_depth_m = {});

/// That a packet comes through: the mean over fades and phases of the echoes (none without `fading:` and `multipath:`).
double delivery_probability(const AcousticLink& link, const AcousticPacket& packet,
                            const sim::AcousticsConfig& acoustics, const sim::Medium& medium,
                            std::optional<double> water_depth_m = {});

/// The table that `shoal acoustics` prints.
std::string budget_text(const AcousticLink& link, const LinkBudget& budget, const sim::AcousticsConfig& acoustics);
/// One row per packet: Eb/N0, bit errors and success without fading, delivery with it.
std::string packets_text(const AcousticLink& link, const LinkBudget& budget, const std::vector<AcousticPacket>& packets,
                         const std::vector<double>& delivered);

/// A row of a table over range.
struct RangeRow {
  LinkBudget budget;
  std::vector<double> delivered;  ///< by packet
};
/// The receiver moves away from the sender at constant depth; ranges below the difference in depth are left out.
std::vector<RangeRow> over_range(const AcousticLink& link, const std::vector<AcousticPacket>& packets,
                                 const std::vector<double>& ranges_m, const sim::AcousticsConfig& acoustics,
                                 const sim::Medium& medium, std::optional<double> water_depth_m = {});
std::string csv_text(const std::vector<RangeRow>& rows, const std::vector<AcousticPacket>& packets);
/// Ratio of signal and noise, and delivery, against range.  Throws std::runtime_error when gnuplot fails.
void draw_over_range(const std::vector<RangeRow>& rows, const std::vector<AcousticPacket>& packets,
                     const std::string& title, const std::string& png);

}  // namespace tools
