// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "sim/director/script.hpp"
#include "sim/world/world_editor.hpp"
#include "sim/world/world_state.hpp"
#include "tests/devices/world_fixture.hpp"

namespace event_worlds {

/// A ball that falls forever beside what the events say.
inline std::string event_world(const std::string& events, const std::string& more = "") {
  return "shoal: 1\nphysics: {step_s: 0.01, gravity_mps2: 0}\n"
         "objects:\n"
         "  - {name: ball, position_m: [0, 0, 5], parts: [{shape: sphere, radius_m: 0.1, mass_kg: 1}]}\n"
         "  - {name: crate, present: false, position_m: [9, 0, 5], parts: [{shape: box, mass_kg: 1}]}\n" +
         more + "events:\n" + events;
}

/// The steps at whose start something was published on `tick`.
inline std::vector<std::int64_t> ticks(test::TestWorld& test, double time_s) {
  const auto mailbox = test.bus.open_mailbox("tick", 1000);
  std::vector<std::int64_t> steps;
  while (sim::to_seconds(test.world.now()) < time_s - 1e-9) {
    test.world.step();
    while (mailbox->take()) steps.push_back(test.world.step_number() - 1);
  }
  return steps;
}

inline const std::string tick = "do: [{publish: {channel: tick, type: shoal.utime_t}}]}\n";

inline const std::string drive =
    "        - {name: drive, type: differential_drive, left_joint: left, right_joint: right,\n"
    "           wheel_radius_m: 0.1, track_m: 0.5, max_torque_Nm: 20}\n";

inline const std::string go =
    "  - {name: go, at: 0, do: [{publish: {channel: r1.drive.cmd, type: shoal.twist_command_t, "
    "value: {forward_mps: 1}}}]}\n";

}  // namespace event_worlds
