// SPDX-License-Identifier: BSD-3-Clause
#include "sim/medium/current_grid.hpp"
#include "sim/terrain/height_grid.hpp"
#include "tests/fuzz/fuzz_input.hpp"
#include "tests/fuzz/memory_file.hpp"

// Maps of a current: CSV, or two ESRI grids.

SHOAL_FUZZ_TARGET(current) {
  fuzz::Reader reader(input);
  const bool is_csv = reader.below(2) == 0;
  const std::size_t first_size = is_csv ? 0 : reader.number<std::uint16_t>();
  const fuzz::MemoryFile first(reader.bytes(first_size)), second(reader.rest());
  sim::CurrentConfig config;
  config.type = sim::CurrentConfig::Type::grid;
  if (is_csv) {
    config.file = second.path();
  } else {
    config.east_file = first.path();
    config.north_file = second.path();
  }
  for (const auto outside : {sim::CurrentConfig::Outside::zero, sim::CurrentConfig::Outside::edge}) {
    config.outside = outside;
    fuzz::allow<sim::TerrainError>([&] {
      const sim::CurrentGrid grid(config);
      for (const double at : {0.0, 0.5, -3.0, 1e9, -1e9})
        fuzz::require(grid.velocity_W(at, -at).allFinite(), "a current is a number everywhere");
    });
  }
}
