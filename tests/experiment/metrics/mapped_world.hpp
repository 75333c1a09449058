// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <string>

#include "experiment/score/map/true_map.hpp"
#include "experiment/score/scoring.hpp"
#include "shoal/estimate_t.hpp"
#include "shoal/occupancy_grid_t.hpp"
#include "sim/world/world_editor.hpp"
#include "sim/world/world_state.hpp"
#include "tests/devices/world_fixture.hpp"

namespace mapped_world {

/// A rover far from a crate of 1 m, whose map of 4 x 4 m has cells of 0.1 m.
struct MappedWorld {
  explicit MappedWorld(const std::string& metrics)
      : test(test::rover_world(
            "        - {name: drive, type: differential_drive, left_joint: left, right_joint: right, "
            "wheel_radius_m: 0.1, track_m: 0.5}\n",
            "  - {name: crate, fixed: true, position_m: [0, 0, 0.5], parts: [{shape: box, size_m: [1, 1, 1]}]}\n",
            "    position_m: [20, 2, 0]\n", "metrics:\n" + metrics)),
        scoring(test.world) {}

  void step(int times = 1) {
    for (int i = 0; i < times; ++i) {
      test.world.step();
      scoring.after_step();
    }
  }
  /// Publishes a map as the true one is now.
  void publish_truth() { publish(experiment::true_map(test.world, frame, 0.3)); }
  void publish(const experiment::GridMap& map) {
    shoal::occupancy_grid_t message{};
    message.utime = test.world.epoch_us() + test.world.now().count();
    message.cell_m = frame.cell_m;
    message.origin_m[0] = frame.origin_x_m;
    message.origin_m[1] = frame.origin_y_m;
    message.width = map.frame.width;
    message.height = map.frame.height;
    for (const experiment::Cell cell : map.cells)
      message.cells.push_back(cell == experiment::Cell::occupied ? 100 : cell == experiment::Cell::free ? 0 : -1);
    message.ncells = static_cast<std::int32_t>(message.cells.size());
    test.send("map", message);
    step();
  }
  void estimate(const sim::Vector3d& p_W, double yaw_rad) {
    shoal::estimate_t message{};
    message.utime = test.world.epoch_us() + test.world.now().count();
    message.position_m[0] = p_W.x();
    message.position_m[1] = p_W.y();
    message.yaw_rad = yaw_rad;
    test.send("est", message);
    step();
  }
  sim::Vector3d position_m() const { return test.world.find_vehicle("r1")->X_WV().translation(); }
  double figure(const std::string& name) const { return scoring.figures().at(name); }

  experiment::MapFrame frame = experiment::frame_of_area({-2, -2, 2, 2}, 0.1);
  test::TestWorld test;
  experiment::Scoring scoring;
};

}  // namespace mapped_world
