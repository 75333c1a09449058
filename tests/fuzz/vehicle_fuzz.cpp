// SPDX-License-Identifier: BSD-3-Clause
#include "sim/world_file/load_world.hpp"
#include "sim/world_file/vehicle_loader.hpp"
#include "tests/fuzz/scratch_file.hpp"

// A vehicle file, alone, in a world and as a spawn request over the bus.

SHOAL_FUZZ_TARGET(vehicle) {
  static const sim::LoadedWorld world = sim::load_world_text("shoal: 1\nmedium: {water: {}}\n", "worlds/fuzz.yaml");
  const std::string file = fuzz::write_scratch("vehicle.yaml", input);
  fuzz::allow<sim::ConfigError>([&] { sim::load_vehicle(file); });
  fuzz::allow<sim::ConfigError>([&] {
    const std::string beside = (fuzz::scratch_folder() / "world.yaml").string();
    const auto loaded = sim::load_world_text("shoal: 1\nvehicles: [{name: v, file: vehicle.yaml}]\n", beside);
    fuzz::require(loaded.config.vehicles.size() == 1, "a world that is taken has all its vehicles");
  });
  fuzz::allow<sim::ConfigError>([&] {
    const std::string text(fuzz::text_of(input));
    const std::string self_contained = sim::self_contained_spawn(world.config, text);
    sim::read_spawn_request(world.config, text);
    sim::read_journalled_spawn(world.config, self_contained);
  });
}
