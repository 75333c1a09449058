// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include "experiment/score/scoring.hpp"
#include "sim/world/world_state.hpp"
#include "tests/devices/world_fixture.hpp"

namespace formation_metric_fixture {

/// Two boxes without weight: the leader at the origin, the other at (-3, 4, 2).
struct TwoBoxes {
  explicit TwoBoxes(const std::string& metrics)
      : test(
            test::box_world("        []\n", "{step_s: 0.01, gravity_mps2: 0}",
                            "  - name: wing\n"
                            "    position_m: [-3, 4, 2]\n"
                            "    model:\n"
                            "      shoal: 1\n"
                            "      vehicle: box\n"
                            "      bodies: [{name: hull, parts: [{shape: box, size_m: [0.6, 0.4, 0.2], mass_kg: 1}]}]\n"
                            "metrics:\n" +
                                metrics)),
        scoring(test.world) {}

  void run_for(double time_s) {
    const sim::Time end = test.world.now() + sim::from_seconds(time_s);
    while (test.world.now() < end) {
      test.world.step();
      scoring.after_step();
    }
  }
  void move(const char* vehicle, const sim::Vector3d& v_W) {
    test.world.find_vehicle(vehicle)->bodies().front().second->set_velocity_W(v_W, sim::Vector3d::Zero());
  }
  double figure(const std::string& name) const { return scoring.figures().at(name); }

  test::TestWorld test;
  experiment::Scoring scoring;
};

}  // namespace formation_metric_fixture
