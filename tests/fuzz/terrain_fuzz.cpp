// SPDX-License-Identifier: BSD-3-Clause
#include "sim/config/param_reader.hpp"
#include "sim/terrain/terrain.hpp"
#include "tests/fuzz/fuzz_input.hpp"
#include "tests/fuzz/memory_file.hpp"

// Height grids: ESRI ASCII, PNG, and generated ones from the keys of a world.

namespace {

void load(const sim::TerrainConfig& config) {
  const sim::Terrain terrain = sim::load_terrain(config);
  fuzz::require(terrain.grid.heights_m.size() ==
                    static_cast<std::size_t>(terrain.grid.columns) * static_cast<std::size_t>(terrain.grid.rows),
                "a grid has as many heights as points");
  terrain.grid.height(0.3, -0.4);
  terrain.area_at(1, 2);
}

void generate(const std::string& yaml) {
  sim::Diagnostics diagnostics;
  const sim::ConfigNode node = sim::parse_config_text(yaml, "fuzz.yaml", diagnostics);
  if (node.kind != sim::ConfigNode::Kind::map) return;
  sim::TerrainConfig config;
  sim::ParamReader in(node, "terrain", diagnostics);
  config.read(in);
  // Large ones are slow for a good reason, and other files are not input of this target.
  constexpr double max_points = 10'000;
  const bool large =
      config.size_m.size() == 2 && config.size_m[0] / config.cell_m * (config.size_m[1] / config.cell_m) > max_points;
  if (!diagnostics.ok() || large || is_read_from_file(config.source)) return;
  load(config);
}

}  // namespace

SHOAL_FUZZ_TARGET(terrain) {
  fuzz::Reader reader(input);
  const std::size_t kind = reader.below(5);
  const fuzz::Input rest = reader.rest();
  fuzz::allow<sim::TerrainError>([&] {
    if (kind == 4) return generate(std::string(fuzz::text_of(rest)));
    const fuzz::MemoryFile file(rest);
    sim::TerrainConfig config;
    config.file = file.path();
    config.source = kind == 3 ? sim::TerrainConfig::Source::png : sim::TerrainConfig::Source::ascii;
    config.holes = kind == 0 ? sim::Holes::error : kind == 1 ? sim::Holes::nearest : sim::Holes::linear;
    load(config);
  });
}
