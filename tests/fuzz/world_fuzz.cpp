// SPDX-License-Identifier: BSD-3-Clause
#include "experiment/process/process_check.hpp"
#include "messages/yaml/message_writer.hpp"
#include "sim/config/warnings.hpp"
#include "sim/world_file/config_warnings.hpp"
#include "sim/world_file/load_world.hpp"
#include "tests/fuzz/fuzz_target.hpp"

// A world file from a stranger: read and checked as by `shoal check`, not built.

SHOAL_FUZZ_TARGET(world) {
  sim::LoadOptions options;
  options.encode_message = shoal::encode_own_message;
  fuzz::allow<sim::ConfigError>([&] {
    const auto loaded = sim::load_world_text(std::string(fuzz::text_of(input)), "worlds/fuzz.yaml", options);
    sim::Warnings warnings;
    sim::warn_of_config(loaded.config, loaded.resolved, warnings);
    experiment::warn_of_processes(loaded, warnings);
    experiment::warn_of_missing_programs(loaded, warnings);
  });
}
