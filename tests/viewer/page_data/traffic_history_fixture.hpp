// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include "shoal/message_codec.hpp"
#include "shoal/sim_sound_t.hpp"
#include "viewer/page_data/traffic_history.hpp"

namespace traffic_history_fixture {

/// A message of 5 bytes and 0.4 s.
inline void send(viewer::TrafficCounts& counts, const std::string& kind = "message") {
  shoal::sim_sound_t sound{};
  sound.source = "a/modem";
  sound.kind = kind;
  sound.bytes = 5;
  sound.duration_us = 400'000;
  counts.take("sim.sound", shoal::encode(sound));
}

}  // namespace traffic_history_fixture
