// SPDX-License-Identifier: BSD-3-Clause
#include <set>

#include "messages/yaml/message_writer.hpp"
#include "sim/bus/in_process_bus.hpp"
#include "sim/world/world.hpp"
#include "sim/world/world_state.hpp"
#include "sim/world_file/load_world.hpp"
#include "sim/world_file/vehicle_config.hpp"
#include "tests/fuzz/fuzz_target.hpp"

// A small world from a stranger: built, run for some steps, saved and restored.

namespace {

/// Much of anything is slow for a good reason.
bool is_small(const sim::WorldConfig& world) {
  constexpr int max_entities = 12;
  static const std::set<std::string> rays{"camera",    "lidar", "lidar3d",      "imaging_sonar", "side_scan",
                                          "multibeam", "sonar", "range_beacon", "marine_radar"};
  int entities = static_cast<int>(world.vehicles.size());
  for (const sim::ObjectConfig& object : world.objects) {
    if (object.any_part([](const sim::PartConfig& part) { return part.terrain; })) return false;
    entities += object.count > max_entities ? max_entities + 1 : object.count * static_cast<int>(object.bodies.size());
  }
  for (const sim::VehicleInstance& vehicle : world.vehicles)
    for (const sim::DeviceConfig& device : vehicle.config->devices)
      if (rays.contains(device.type)) return false;
  return entities <= max_entities;
}

}  // namespace

SHOAL_FUZZ_TARGET(world_run) {
  constexpr std::size_t max_bytes = 3000;
  if (input.size() > max_bytes) return;
  sim::LoadOptions options;
  options.encode_message = shoal::encode_own_message;
  fuzz::allow<sim::ConfigError, sim::PhysicsFault>([&] {
    const auto loaded = sim::load_world_text(std::string(fuzz::text_of(input)), "worlds/fuzz.yaml", options);
    if (!is_small(loaded.config)) return;
    sim::InProcessBus bus;
    sim::World world(loaded.config, bus);
    for (int step = 0; step < 5; ++step) world.step();
    const sim::Bytes snapshot = world.state().snapshot();
    world.step();
    const std::uint64_t hash = world.state().hash();
    world.state().restore(snapshot);
    world.step();
    fuzz::require(world.state().hash() == hash, "a restored world continues as before");
  });
}
