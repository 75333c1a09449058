// SPDX-License-Identifier: BSD-3-Clause
#include "sim/model/placement.hpp"

#include "sim/random/random.hpp"

namespace sim {

void PlacementConfig::read(ParamReader& in) {
  in.read_choice(
      "pattern", pattern,
      {{"grid", Pattern::grid}, {"line", Pattern::line}, {"circle", Pattern::circle}, {"random", Pattern::random}},
      "how the instances are laid out");
  in.read("spacing_m", spacing_m, above(0), "grid and line: distance between neighbors");
  in.read_or_word("columns", columns, at_least(1), {"auto"}, "grid: instances along x; auto: as square as possible");
  in.read("radius_m", radius_m, above(0), "circle: its radius; instances face outwards");
  in.read("area_m", area_m, at_least(0), "random: size of the box that places are drawn from");
  in.read("jitter_m", jitter_m, at_least(0), "maximum random offset of each place in x and in y");
  in.read("random_yaw", random_yaw, "headings are drawn from the full circle");
}

namespace {

Vector3d place_in_grid(const PlacementConfig& config, int index, int count) {
  const int columns =
      config.columns > 0 ? config.columns : static_cast<int>(std::ceil(std::sqrt(static_cast<double>(count))));
  const int rows = (count + columns - 1) / columns;
  return {(index % columns - 0.5 * (columns - 1)) * config.spacing_m,
          (index / columns - 0.5 * (rows - 1)) * config.spacing_m, 0};
}

Vector3d place_of(const PlacementConfig& config, int index, int count, Random& random) {
  switch (config.pattern) {
    case PlacementConfig::Pattern::grid:
      return place_in_grid(config, index, count);
    case PlacementConfig::Pattern::line:
      return {(index - 0.5 * (count - 1)) * config.spacing_m, 0, 0};
    case PlacementConfig::Pattern::circle: {
      const double angle = 2 * std::numbers::pi * index / count;
      return {config.radius_m * std::cos(angle), config.radius_m * std::sin(angle), 0};
    }
    case PlacementConfig::Pattern::random:
      break;
  }
  Vector3d p;
  for (int i = 0; i < 3; ++i) p[i] = (random.uniform() - 0.5) * config.area_m[i];
  return p;
}

}  // namespace

std::vector<Pose> place_instances(const PlacementConfig& config, int count, const Pose& X_WE, std::uint64_t seed,
                                  const std::string& name) {
  std::vector<Pose> poses;
  poses.reserve(static_cast<std::size_t>(count));
  Random random(seed, name + "#placement");
  // Instances draw from separate random streams.
  for (int i = 0; i < count; ++i) {
    random.begin_step(i);
    Vector3d p = place_of(config, i, count, random);
    p.x() += (2 * random.uniform() - 1) * config.jitter_m;
    p.y() += (2 * random.uniform() - 1) * config.jitter_m;
    double yaw = config.pattern == PlacementConfig::Pattern::circle ? std::atan2(p.y(), p.x()) : 0.0;
    if (config.random_yaw) yaw = (2 * random.uniform() - 1) * std::numbers::pi;
    poses.push_back(X_WE * make_pose(p, {0, 0, yaw}));
  }
  return poses;
}

}  // namespace sim
