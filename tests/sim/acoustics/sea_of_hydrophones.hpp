// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include "tests/sim/acoustics/hydrophone.hpp"

namespace test {

/// A vehicle that goes ahead at a speed.
inline std::string vehicle(const std::string& name, const std::string& position_m, const std::string& keys = "",
                           double speed_mps = 0, double yaw_deg = 0) {
  const std::string drive = "        - {name: drive, type: naive_drive, start_speed_mps: " + std::to_string(speed_mps) +
                            ", max_speed_mps: 30}\n";
  return "  - name: " + name + "\n    position_m: " + position_m + "\n    rpy_deg: [0, 0, " + std::to_string(yaw_deg) +
         "]\n    model:\n"
         "      shoal: 1\n      vehicle: float\n      bodies:\n"
         "        - {name: hull, kinematic: true, parts: [{shape: sphere, radius_m: 0.2}]}\n      devices:\n"
         "        - {name: phone, type: test_hydrophone" +
         keys + "}\n" + (speed_mps > 0 ? drive : "");
}

inline std::string sea(const std::string& acoustics, const std::string& vehicles, const std::string& objects = "") {
  return "shoal: 1\nname: sea\nphysics: {step_s: 0.01}\n"
         "medium: {water: {sound_speed_mps: 1500}}\n"
         "acoustics: " +
         acoustics + "\n" + objects + "vehicles:\n" + vehicles;
}

/// 32 bytes by FH-FSK.
inline sim::Signal message(double source_level_dB = 185) {
  sim::Signal signal;
  signal.source_level = sim::Decibels{source_level_dB};
  signal.duration = std::chrono::milliseconds(3200);
  signal.bit_rate_bps = 80;
  signal.bits = 256;
  return signal;
}

/// Messages for a hydrophone that it lost for this cause.
inline std::int64_t lost(TestWorld& test, const std::string& name, sim::SignalLoss why) {
  return phone(test, name).transducer().counts().lost[static_cast<std::size_t>(why)];
}

}  // namespace test
