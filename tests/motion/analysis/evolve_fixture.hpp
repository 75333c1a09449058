// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <memory>

#include "motion/analysis/evolve.hpp"
#include "sim/world_file/load_world.hpp"
#include "tests/project_paths.hpp"

namespace evolve_fixture {

struct Studio {
  sim::WorldConfig world = sim::load_world(test_support::source_path("worlds/ers7_studio.yaml")).config;
  std::unique_ptr<motion::GaitFamily> gait = motion::make_gait("half_ellipse", *world.vehicles.front().config);
  motion::EvolveOptions options;

  Studio() {
    options.population = 4;
    options.worlds = 2;
    options.walk = {.warm_up_s = 0.2, .measured_s = 0.5};
    options.threads = 2;
  }
  motion::Evolution evolution() const { return {world, "dog", *gait, options}; }
};

}  // namespace evolve_fixture
