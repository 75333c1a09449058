#include "shoal/message_writer.hpp"
#include "sim/world/load_world.hpp"
#include "tests/fuzz/fuzz_target.hpp"

// A world file from a stranger: read and checked, not built.

SHOAL_FUZZ_TARGET(world) {
  sim::LoadOptions options;
  options.encode_message = shoal::encode_own_message;
  fuzz::allow<sim::ConfigError>(
      [&] { sim::load_world_text(std::string(fuzz::text_of(input)), "worlds/fuzz.yaml", options); });
}
