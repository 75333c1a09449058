// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <fstream>
#include <iterator>
#include <nlohmann/json.hpp>
#include <string>

#include "experiment/results/results.hpp"
#include "experiment/results/results_folder.hpp"
#include "experiment/run/runner.hpp"
#include "sim/config/config_node.hpp"
#include "tests/devices/world_fixture.hpp"

namespace quiet_runs {

inline std::string text_of_file(const std::string& path) {
  std::ifstream in(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

inline sim::LoadedWorld small_world(const std::string& more = "") {
  return sim::load_world_text(
      test::rover_world("        - {name: lidar, type: lidar}\n", "", "",
                        "name: small\nrun: {duration_s: 0.5, track_rate_hz: 10, seed: 7}\n" + more),
      "small.yaml");
}

inline experiment::RunOptions quiet_run() {
  experiment::RunOptions options;
  options.bus = "none";
  options.quiet = true;
  return options;
}

}  // namespace quiet_runs
