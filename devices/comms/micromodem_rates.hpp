// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <span>

#include "sim/acoustics/modulation.hpp"

namespace devices {

/// A packet type of the WHOI Micro-Modem.
struct MicromodemRate {
  int number;
  sim::Modulation modulation;
  double bandwidth_Hz;
  double bit_rate_bps;  ///< of the data, in the burst
  int frames;           ///< of a packet, at most
  int frame_bytes;
};

/// In the order of their numbers, 0 to 6.  Figures: the packet table of the Micro-Modem (acomms.whoi.edu, and Goby's
/// mm_driver).
std::span<const MicromodemRate> micromodem_rates();

/// The probe before each packet, s: what a packet of rate 6 takes with it (3.25 s) less what its bits take.
inline constexpr double micromodem_probe_s = 0.3;
/// Bits of a short packet (cycle init, ping, reply, acknowledgement, mini-packet): 13 of data, two addresses of 7 and 5
/// that tell its kind.  They are sent as rate 0 is.
inline constexpr int micromodem_short_bits = 32;

/// Of the sound of a packet with this many frames; all frames of a packet are filled up.  s.
double micromodem_packet_s(const MicromodemRate& rate, int frames);
/// Of a short packet, s.
double micromodem_short_s();

}  // namespace devices
