// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include "experiment/score/scoring.hpp"
#include "tests/devices/comms/modem_fixture.hpp"

namespace bounded_worlds {

/// A submarine that starts with 10 m, and 100 m east of it a boat with GPS of 0.5 m; both stand still.
inline std::string bounded_world(const std::string& metrics) {
  return test::modem_sea(
      {{"auv", "[0, 0, -10]",
        "{name: dvl, type: dvl, scale_std: 0.03}, {name: modem, type: acoustic_modem}, "
        "{name: ahrs, type: ahrs, heading_noise: {bias_std: 0.05, gauss_markov_std: 0.02}}",
        "clock: {offset_s: 0.001}"},
       {"boat", "[100, 0, 0]",
        "{name: gps, type: gps, position_m: [0, 0, 1], rate_hz: 1, phase_s: 0, horizontal_noise: {gaussian_std: 0.5}}, "
        "{name: modem, type: acoustic_modem, position_m: [0, 0, -1]}",
        ""},
       {"rock", "[0, 50, -10]", "", ""}},
      "metrics:\n" + metrics);
}

inline constexpr const char* bound_with_clock =
    "  - {name: b, type: bound, vehicle: auv, start_std_m: 10, from_s: 1, known: [clock]}\n";

struct BoundedWorld {
  explicit BoundedWorld(const std::string& metrics) : test(bounded_world(metrics)), scoring(test.world) {}

  void run_for(double time_s) {
    const sim::Time end = test.world.now() + sim::from_seconds(time_s);
    while (test.world.now() < end) {
      test.world.step();
      scoring.after_step();
    }
  }
  /// Sends packets by the boat, one every 5 s, and waits for them.
  void send(int packets) {
    for (int i = 0; i < packets; ++i) {
      test.send("boat.modem.cmd", test::bytes_to("here"));
      run_for(5);
    }
  }
  double figure(const std::string& name) const { return scoring.figures().at(name); }

  test::TestWorld test;
  experiment::Scoring scoring;
};

}  // namespace bounded_worlds
