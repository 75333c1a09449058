// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include "tests/devices/sound_positioning/acoustic_probe.hpp"

namespace lbl_fixture {

inline std::string lbl_device(const std::string& keys = "") {
  return "{name: s, truth: true, rate_hz: 100, phase_s: 0, type: lbl" + keys + "}";
}

inline std::string mooring(const std::string& name, const std::string& position_m, const std::string& more = "",
                           const std::string& network = "lbl") {
  return test::float_at(name, position_m, "{name: t, type: transponder, network: " + network + more + "}");
}

inline std::string lbl_world(const std::string& keys, const std::string& others) {
  return test::sound_world(test::float_at("r1", "[0, 0, -10]", lbl_device(keys)) + others);
}

}  // namespace lbl_fixture
