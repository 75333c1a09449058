// SPDX-License-Identifier: BSD-3-Clause
// Connects pairs of random poses in which the ERS-7 stands, and counts how they are reached.
//   connect_bench [PAIRS] [FIRST_SEED] [PERTURBED_WORLDS]
// Each pair has its own seed.
#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <numbers>

#include "sim/world_file/load_world.hpp"
#include "tests/project_paths.hpp"
#include "verification/motions/standing_poses.hpp"

int main(int argc, char** argv) {
  const int pairs = argc > 1 ? std::atoi(argv[1]) : 50;
  const int seed = argc > 2 ? std::atoi(argv[2]) : 1;
  motion::ConnectOptions options;
  options.worlds = argc > 3 ? std::atoi(argv[3]) : 0;
  const sim::WorldConfig world = sim::load_world(test_support::source_path("worlds/ers7_studio.yaml")).config;
  int counts[5] = {}, played = 0, tried = 0;
  for (int i = 0; i < pairs; ++i) {
    const verification::StandingPoses poses =
        verification::standing_poses(world, "dog", 2, static_cast<std::uint64_t>(seed + i));
    tried += poses.tried;
    motion::Connector connector(world, "dog", motion::held_pose("from", "ers7", poses.poses[0]), options);
    const motion::Connection connection = connector.connect(poses.poses[1]);
    ++counts[static_cast<int>(connection.kind)];
    played += connection.played;
    double error = 0;
    for (const motion::Arrival& arrival : connection.arrivals) error = std::max(error, arrival.error);
    std::printf("seed %2d: kind %d, %3d motions, %5.2f s, %.2f deg\n", seed + i, static_cast<int>(connection.kind),
                connection.played, connection.motion.end_s(), error * 180 / std::numbers::pi);
    std::fflush(stdout);
  }
  std::printf("of %d pairs arrive: straight %d, slower %d, by the stance %d, searched %d; not %d\n", pairs, counts[0],
              counts[1], counts[2], counts[3], counts[4]);
  std::printf("%d motions played; %d poses drawn for %d in which it stands\n", played, tried, 2 * pairs);
}
