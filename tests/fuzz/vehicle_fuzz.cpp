#include "sim/world/load_world.hpp"
#include "sim/world/vehicle_loader.hpp"
#include "tests/fuzz/memory_file.hpp"

// A vehicle file, from disk and as a spawn request over the bus.

SHOAL_FUZZ_TARGET(vehicle) {
  static const sim::LoadedWorld world = sim::load_world_text("shoal: 1\nmedium: {water: {}}\n", "worlds/fuzz.yaml");
  fuzz::allow<sim::ConfigError>([&] {
    const fuzz::MemoryFile file(input);
    sim::load_vehicle(file.path());
  });
  fuzz::allow<sim::ConfigError>([&] {
    const std::string text(fuzz::text_of(input));
    const std::string self_contained = sim::self_contained_spawn(world.config, text);
    sim::read_spawn_request(world.config, text);
    sim::read_journalled_spawn(world.config, self_contained);
  });
}
