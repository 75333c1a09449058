// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>

#include "verification/bench/bench_scene.hpp"

namespace verification {

const std::vector<BenchScene>& bench_scenes() {
  static const std::vector<BenchScene> all = {land_scene(),      scale_scene(),         crowd_scene(), sea_scene(),
                                              otters_scene(),    naive_scene(),         nav_scene(),   mixed_scene(),
                                              acoustics_scene(), acoustics_rays_scene()};
  return all;
}

const BenchScene* find_bench_scene(const std::string& name) {
  const auto& all = bench_scenes();
  const auto found = std::find_if(all.begin(), all.end(), [&](const BenchScene& scene) { return scene.name == name; });
  return found != all.end() ? &*found : nullptr;
}

}  // namespace verification
