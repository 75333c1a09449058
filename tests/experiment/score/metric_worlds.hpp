// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include "experiment/score/link_counts.hpp"
#include "experiment/score/metric.hpp"
#include "experiment/score/scoring.hpp"
#include "shoal/estimate_t.hpp"
#include "shoal/twist_command_t.hpp"
#include "sim/world/world_editor.hpp"
#include "sim/world/world_state.hpp"
#include "tests/devices/world_fixture.hpp"

namespace metric_worlds {

/// A rover that stands at (1, 2), 3 m west of a crate; `metrics`: the list.
inline std::string metric_world(const std::string& metrics) {
  return test::rover_world(
      "        - {name: drive, type: differential_drive, left_joint: left, right_joint: right, "
      "wheel_radius_m: 0.1, track_m: 0.5}\n",
      "  - {name: crate, fixed: true, position_m: [4.5, 2, 0.5], parts: [{shape: box, size_m: [1, 1, 1]}]}\n",
      "    position_m: [1, 2, 0]\n",
      "zones: [{name: goal, shape: box, position_m: [3, 2, 0], size_m: [1, 4, 4]}]\n"
      "metrics:\n" +
          metrics);
}

struct MetricWorld {
  explicit MetricWorld(const std::string& metrics) : test(metric_world(metrics)), scoring(test.world) {}

  void run_for(double time_s) {
    const sim::Time end = test.world.now() + sim::from_seconds(time_s);
    while (test.world.now() < end) {
      test.world.step();
      scoring.after_step();
    }
  }
  void drive(double forward_mps) {
    shoal::twist_command_t command{};
    command.forward_mps = forward_mps;
    test.send("r1.drive.cmd", command);
  }
  sim::Vector3d position_m() const { return test.world.find_vehicle("r1")->X_WV().translation(); }
  double figure(const std::string& name) const { return scoring.figures().at(name); }

  /// An estimate that is off by `error_m`, for now plus `ahead_s`.
  void estimate(const sim::Vector3d& error_m, const Eigen::Matrix3d& covariance_m2, double ahead_s = 0) {
    shoal::estimate_t message{};
    message.utime = test.world.epoch_us() + (test.world.now() + sim::from_seconds(ahead_s)).count();
    const sim::Vector3d p = position_m() + error_m;
    for (int i = 0; i < 3; ++i) message.position_m[i] = p[i];
    for (int i = 0; i < 9; ++i) message.covariance_m2[i] = covariance_m2(i / 3, i % 3);
    message.clock_error_s = std::nan("");
    test.send("est", message);
  }

  test::TestWorld test;
  experiment::Scoring scoring;
};

inline Eigen::Matrix3d some_covariance() {
  Eigen::Matrix3d P;
  P << 4, 1.5, 0.2, 1.5, 1, 0.1, 0.2, 0.1, 9;
  return P;
}

// A rover that stands still may creep by some 0.01 mm.
inline constexpr double creep_m = 1e-4;

}  // namespace metric_worlds
