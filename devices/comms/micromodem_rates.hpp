// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <span>

#include "sim/acoustics/propagation/modulation.hpp"

namespace devices {

/// Packet type of the WHOI Micro-Modem.
struct MicromodemRate {
  int number;
  sim::Modulation modulation;
  double bandwidth_Hz;
  double bit_rate_bps;  ///< bit rate of the data in the burst
  int frames;           ///< maximum number of frames of a packet
  int frame_bytes;
};

/// Returns the packet types in the order of their numbers, 0 to 6.  Source: packet table of the Micro-Modem
/// (acomms.whoi.edu, and Goby's mm_driver).
std::span<const MicromodemRate> micromodem_rates();

/// Duration of the probe before each packet, s: duration of a packet of rate 6 with the probe (3.25 s) minus that of
/// its bits.
inline constexpr double micromodem_probe_s = 0.3;
/// Number of bits of a short packet (cycle init, ping, reply, acknowledgement, mini-packet): 13 of data, two addresses
/// of 7 and 5 for its kind.  They are modulated as rate 0.
inline constexpr int micromodem_short_bits = 32;

/// Returns the duration of a packet with this number of frames, s; all frames of a packet are padded to full length.
double micromodem_packet_s(const MicromodemRate& rate, int frames);
/// Returns the duration of a short packet, s.
double micromodem_short_s();

}  // namespace devices
