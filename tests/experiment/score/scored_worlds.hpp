// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include "experiment/score/scoring.hpp"
#include "shoal/pose_t.hpp"
#include "tests/devices/world_fixture.hpp"

namespace scored_worlds {

/// A rover that stands at (1, 2); `more`: keys of the world, after two metrics of its position.
inline std::string scored_world(const std::string& more = "") {
  return test::rover_world(
      "        - {name: drive, type: differential_drive, left_joint: left, right_joint: right, "
      "wheel_radius_m: 0.1, track_m: 0.5}\n",
      "", "    position_m: [1, 2, 0]\n",
      "metrics:\n"
      "  - {name: good, type: position_error, vehicle: r1, channel: good}\n"
      "  - {name: late, type: position_error, vehicle: r1, channel: late, from_s: 0.5}\n" +
          more);
}

struct ScoredWorld {
  explicit ScoredWorld(const std::string& more = "") : test(scored_world(more)), scoring(test.world) {}

  void run_for(double time_s) {
    const sim::Time end = test.world.now() + sim::from_seconds(time_s);
    while (test.world.now() < end) {
      test.world.step();
      scoring.after_step();
    }
  }
  /// An estimate for a time that lies `age_s` back.
  void estimate(const std::string& channel, double x_m, double y_m, double age_s = 0) {
    shoal::pose_t pose{};
    pose.utime = test.world.epoch_us() + test.world.now().count() - sim::from_seconds(age_s).count();
    pose.pos[0] = x_m;
    pose.pos[1] = y_m;
    pose.pos[2] = 77;  // heights do not count
    test.send(channel, pose);
  }

  test::TestWorld test;
  experiment::Scoring scoring;
};

}  // namespace scored_worlds
