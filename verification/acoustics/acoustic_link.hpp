// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "sim/acoustics/propagation/acoustics_config.hpp"
#include "sim/acoustics/propagation/directivity.hpp"
#include "sim/acoustics/propagation/modulation.hpp"
#include "sim/medium/medium.hpp"

namespace verification {

/// Packet that is received only when all of its bits are correct.
struct AcousticPacket {
  sim::Modulation modulation = sim::Modulation::fsk;
  double bit_rate_bps = 80;
  std::int64_t bytes = 32;
  std::string name;                    ///< such as `fsk_80_32`
  std::optional<double> bandwidth_Hz;  ///< unset: that of the link
};

/// Parses the text `fsk:80:32` (modulation, bit/s, bytes).  Returns std::nullopt for any other form.
std::optional<AcousticPacket> parse_packet(const std::string& text);

/// Returns a frame of each rate of the WHOI Micro-Modem, 0 to 6, in its own bandwidth.
std::vector<AcousticPacket> micromodem_packets();

/// Pose and transducer of one end of a link.
struct LinkEnd {
  sim::Vector3d p_W = sim::Vector3d::Zero();
  sim::Matrix3d R_WS = sim::Matrix3d::Identity();
  sim::DirectivityConfig directivity;
  int group = -1;                      ///< of the vehicle at this end
  std::optional<double> detection_dB;  ///< of the transducer at this end, if it has one
};

struct AcousticLink {
  LinkEnd from, to;
  sim::Decibels source_level{185};  ///< re 1 uPa at 1 m, on the axis
  double centre_Hz = 25000;
  double bandwidth_Hz = 4000;
  sim::Decibels detection{6};  ///< SNR that the receiver needs to detect a signal
  sim::Decibels coding_gain{0};
};

/// Terms of the sonar equation of a link (Urick 1983).
struct LinkBudget {
  double range_m = 0;
  double travel_time_s = 0;
  double absorption_dBpkm = 0;
  double wind_mps = 0;
  sim::Decibels from_gain, spreading, absorption, to_gain;  ///< all are added; losses are negative
  std::optional<sim::Decibels> echoes;                      ///< multipath: all inside the window over the first path
  std::optional<sim::Decibels> late;  ///< multipath: level of the echoes outside the window, which interfere
  double delay_spread_s = 0;          ///< multipath: rms
  /// Rays: level, travel time and directions are those of the first arrival, which is a bounce in a shadow.
  bool bent = false, shadow = false;
  double launch_rad = 0, arrival_rad = 0;       ///< rays: elevations of the first arrival, upwards positive
  std::vector<sim::PathGain> ray_gains;         ///< rays: relative to the first arrival
  sim::Decibels level;                          ///< of the direct path at the receiver
  sim::Decibels noise_per_Hz, noise_reduction;  ///< noise_reduction: by the receiver's directivity
  sim::Decibels noise;                          ///< in the band, after noise_reduction
  sim::Decibels snr;                            ///< of the direct path
};

/// Whether sound travels along rays in this water.
bool sound_bends(const sim::AcousticsConfig& acoustics, const sim::Medium& medium);

/// Computes the budget without fading.  `water_depth_m`: depth of a flat bottom, for echoes, where the world's
/// `multipath:` does not set it; unset: no bottom.
LinkBudget link_budget(const AcousticLink& link, const sim::AcousticsConfig& acoustics, const sim::Medium& medium,
                       std::optional<double> water_depth_m = {});

/// Returns the probability that a packet is received: the mean over fades and phases of the echoes (none without
/// `fading:` and `multipath:`).
double delivery_probability(const AcousticLink& link, const AcousticPacket& packet,
                            const sim::AcousticsConfig& acoustics, const sim::Medium& medium,
                            std::optional<double> water_depth_m = {});

/// Returns the table that `shoal acoustics` prints.
std::string budget_text(const AcousticLink& link, const LinkBudget& budget, const sim::AcousticsConfig& acoustics);
/// Returns one row per packet: Eb/N0, bit errors and success without fading, delivery with fading.
std::string packets_text(const AcousticLink& link, const LinkBudget& budget, const std::vector<AcousticPacket>& packets,
                         const std::vector<double>& delivered);

/// Row of a table over range.
struct RangeRow {
  LinkBudget budget;
  std::vector<double> delivered;  ///< delivery probability by packet
};
/// Moves the receiver away from the sender at constant depth; omits ranges below the difference in depth.
std::vector<RangeRow> over_range(const AcousticLink& link, const std::vector<AcousticPacket>& packets,
                                 const std::vector<double>& ranges_m, const sim::AcousticsConfig& acoustics,
                                 const sim::Medium& medium, std::optional<double> water_depth_m = {});
std::string csv_text(const std::vector<RangeRow>& rows, const std::vector<AcousticPacket>& packets);
/// Ratio of signal and noise, and delivery, against range.  Throws std::runtime_error when gnuplot fails.
void draw_over_range(const std::vector<RangeRow>& rows, const std::vector<AcousticPacket>& packets,
                     const std::string& title, const std::string& png);

}  // namespace verification
