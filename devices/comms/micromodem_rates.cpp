// SPDX-License-Identifier: BSD-3-Clause
#include "devices/comms/micromodem_rates.hpp"

namespace devices {

namespace {

using sim::Modulation;

constexpr MicromodemRate rates[] = {
    {0, Modulation::fsk, 4000, 80, 1, 32},    {1, Modulation::psk, 5000, 250, 3, 64},
    {2, Modulation::psk, 5000, 500, 3, 64},   {3, Modulation::psk, 5000, 1200, 2, 256},
    {4, Modulation::psk, 5000, 1300, 2, 256}, {5, Modulation::psk, 5000, 5300, 8, 256},
    {6, Modulation::psk, 5000, 490, 6, 32},
};

}  // namespace

std::span<const MicromodemRate> micromodem_rates() {
  return rates;
}

double micromodem_packet_s(const MicromodemRate& rate, int frames) {
  return micromodem_probe_s + sim::packet_duration_s(8 * std::int64_t{frames} * rate.frame_bytes, rate.bit_rate_bps);
}

double micromodem_short_s() {
  return micromodem_probe_s + sim::packet_duration_s(micromodem_short_bits, rates[0].bit_rate_bps);
}

}  // namespace devices
