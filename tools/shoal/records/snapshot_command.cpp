// SPDX-License-Identifier: BSD-3-Clause
#include <iostream>
#include <memory>

#include "experiment/run/version.hpp"
#include "experiment/snapshot/run_identity.hpp"
#include "experiment/snapshot/snapshot_file.hpp"
#include "messages/yaml/message_writer.hpp"
#include "sim/config/message_text.hpp"
#include "sim/world/standalone_world.hpp"
#include "sim/world/world_state.hpp"
#include "sim/world_file/load_world.hpp"
#include "tools/shoal/commands/commands.hpp"

namespace tools {

namespace {

struct SnapshotArguments {
  std::string file;
  bool check = false;
  bool world = false;
};

/// Builds the world, restores it, and compares the hash.
bool restores(const experiment::Snapshot& snapshot, const std::string& path) {
  experiment::check_version(snapshot, path, experiment::short_version());
  check_files(snapshot, path);
  sim::LoadOptions load;
  load.only_own_files = true;
  load.serial_ports = false;
  experiment::allow_files(snapshot.files, load);
  load.encode_message = shoal::encode_own_message;
  const sim::LoadedWorld loaded = sim::load_world_text(snapshot.resolved_world, path, load);
  sim::StandaloneWorld world(loaded.config);
  world.state().restore(snapshot.state);
  const bool equal = world.state().hash() == snapshot.state_hash;
  std::cout << (equal ? "restores with the same hash\n" : "restores with a different hash\n");
  return equal;
}

int show(const SnapshotArguments& arguments) {
  const experiment::Snapshot snapshot = experiment::read_snapshot(arguments.file);
  if (arguments.world) {
    std::cout << snapshot.resolved_world;
    return exit_ok;
  }
  const auto printable = [](const std::string& text) { return sim::printable(sim::shortened(text)); };
  std::cout << fmt::format(
      "world {}  seed {}\n  step {} of {} us: {:.6f} s, utime {}\n  branch {}\n  written by shoal {}\n"
      "  {} bytes of state, {} of scores\n  {} vehicles:",
      printable(snapshot.world), snapshot.seed, snapshot.step, snapshot.step_us, snapshot.time_s(), snapshot.utime(),
      snapshot.branch, printable(snapshot.version), snapshot.state.size(), snapshot.scores.size(),
      snapshot.vehicles.size());
  for (const std::string& vehicle : snapshot.vehicles) std::cout << ' ' << printable(vehicle);
  std::cout << fmt::format("\n  state hash {:016x}\n", snapshot.state_hash);
  if (!arguments.check) return exit_ok;
  return restores(snapshot, arguments.file) ? exit_ok : exit_failed;
}

}  // namespace

static void add_snapshot_command(CLI::App& app, int& exit_code) {
  CLI::App* command = app.get_subcommand("snapshot");
  const auto arguments = std::make_shared<SnapshotArguments>();
  add_log_level_option(*command);
  command->add_option("FILE", arguments->file, "snapshot file")->required();
  command->add_flag("--check", arguments->check, "restore it, and compare the state hash");
  command->add_flag("--world", arguments->world, "print its world file instead");
  command_line::set_help_end(
      *command,
      {{"shoal run worlds/minimal.yaml --duration 20 --snapshot-at 10 --snapshots snaps",
        "shoal snapshot snaps/branch0_step1000.snapshot --check", "shoal run --from snaps/branch0_step1000.snapshot"},
       {{0, "good"},
        {1, "restored with a different hash"},
        {2, "wrong usage"},
        {4,
         "not a snapshot, damaged, from another build, or a changed file of its world (mesh, terrain, texture, "
         "current)"}},
       {}});
  command->callback([arguments, &exit_code] { exit_code = show(*arguments); });
}

SHOAL_COMMAND(look, "snapshot", "Show the contents of a snapshot file", add_snapshot_command);

}  // namespace tools
