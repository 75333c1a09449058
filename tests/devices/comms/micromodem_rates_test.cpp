// SPDX-License-Identifier: BSD-3-Clause
#include "devices/comms/micromodem_rates.hpp"

#include <gmock/gmock.h>

#include "devices/comms/micromodem.hpp"
#include "tests/fidelity/closed_forms.hpp"

namespace {

TEST(Micromodem, PacketsLastAsTheTableSays) {
  int found = 0;
  for (const auto& form : test::all_closed_forms()) {
    if (form.name != "micromodem_packet_time") continue;
    for (const auto& rate : devices::micromodem_rates()) {
      if (rate.bit_rate_bps != form.at("bps")) continue;
      EXPECT_EQ(rate.frame_bytes, form.at("frame_bytes"));
      EXPECT_EQ(rate.frames, form.at("frames"));
      EXPECT_NEAR(devices::micromodem_packet_s(rate, rate.frames) - devices::micromodem_probe_s, form.expected, 1e-6);
      ++found;
    }
  }
  EXPECT_EQ(found, 6);
  // Rate 6 with its probe: 3.25 s.
  const auto& last = devices::micromodem_rates().back();
  EXPECT_NEAR(devices::micromodem_packet_s(last, last.frames), 3.25, 0.25);
}

}  // namespace
