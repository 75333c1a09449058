// SPDX-License-Identifier: BSD-3-Clause
#include <filesystem>
#include <iostream>
#include <memory>
#include <sstream>

#include "bridges/log/record_file.hpp"
#include "experiment/process/browser.hpp"
#include "experiment/process/world_programs.hpp"
#include "experiment/run/runner.hpp"
#include "experiment/run/version.hpp"
#include "experiment/snapshot/run_identity.hpp"
#include "experiment/world_files/world_by_name.hpp"
#include "messages/yaml/message_writer.hpp"
#include "sim/base/log.hpp"
#include "sim/base/number.hpp"
#include "tools/command_line/declared_options.hpp"
#include "tools/shoal/commands/commands.hpp"
#include "tools/shoal/commands/live_page.hpp"
#include "tools/shoal/options/shared_options.hpp"

namespace tools {

namespace {

struct RunArguments {
  std::string world;
  sim::LoadOptions load;
  experiment::RunOptions run;
  std::string speed;
  std::string from;
  std::string snapshot_at;
  std::optional<double> duration_s;
  bool with_page = false;
  bool watch = false;
  bool open = false;
  experiment::ViewOptions view;
};

/// Parses times in s: `10,20.5`.
std::vector<double> parse_times(const std::string& text) {
  std::vector<double> times;
  std::istringstream in(text);
  for (std::string part; std::getline(in, part, ',');) {
    const auto time_s = sim::exact_number<double>(part);
    if (!time_s || !(*time_s >= 0 && *time_s <= 1e9))
      throw CLI::ValidationError("--snapshot-at", "must be times from 0 to 1e9 s, got '" + part + "'");
    times.push_back(*time_s);
  }
  return times;
}

/// Loads the world of a snapshot, with the values that the command line sets.
sim::LoadedWorld load_from(RunArguments& arguments) {
  if (arguments.load.seed) throw CLI::ValidationError("--seed", "cannot be changed in a snapshot");
  arguments.run.from = experiment::read_snapshot(arguments.from);
  arguments.run.from_file = arguments.from;
  experiment::check_version(*arguments.run.from, arguments.from, experiment::short_version());
  experiment::check_files(*arguments.run.from, arguments.from);
  experiment::allow_files(arguments.run.from->files, arguments.load);
  return sim::load_world_text(arguments.run.from->resolved_world, arguments.from, arguments.load);
}

/// Reads the world, and checks the arguments of its programs.
sim::LoadedWorld load_with_programs(RunArguments& arguments) {
  sim::LoadedWorld loaded = arguments.from.empty()
                                ? sim::load_world(experiment::world_file(arguments.world), arguments.load)
                                : load_from(arguments);
  experiment::read_programs(loaded, {arguments.run.launch, arguments.load.allow_paths});
  return loaded;
}

/// Runs a world, and prints its summary.  Returns the exit code.
int run_loaded(const sim::LoadedWorld& loaded, RunArguments& arguments) {
  // As fast as possible there is little to see.
  arguments.run.speed = parse_speed(arguments.speed);
  if (arguments.with_page && arguments.speed.empty() && loaded.config.run.speed == 0) {
    arguments.run.speed = 1;
    sim::log_info("--view: running in real time; --speed max runs as fast as possible");
  }
  const experiment::Summary summary = experiment::run_world(loaded, arguments.run);
  if (!summary.error.empty()) std::cerr << "shoal: " << summary.error << '\n';
  // Print the summary even if it could not be saved: on stderr when stdout leads to the same full disk.
  std::error_code ignored;
  const bool saved = arguments.run.results.empty() ||
                     std::filesystem::is_regular_file(arguments.run.results + "/summary.json", ignored);
  if (summary.steps > 0 && (!arguments.run.quiet || !saved)) std::cout << summary.to_text() << std::flush;
  if (summary.steps > 0 && !std::cout && !saved) std::cerr << summary.to_text();
  if (summary.steps > 0 && !arguments.run.results.empty() && !arguments.run.quiet && saved)
    std::cout << "  results in " << arguments.run.results << "/ (summary.json, tracks.png)\n";
  if (summary.ended == "fault" || summary.ended == "error")
    std::cerr << experiment::bug_hint(arguments.run.results, arguments.run.record) << '\n';
  return summary.exit_code;
}

int run(RunArguments& arguments) {
  // Transfer the options of the command line.
  arguments.load.allow_plugins = arguments.run.launch;
  arguments.load.serial_ports = arguments.run.serial_ports;
  arguments.run.duration_s = arguments.load.duration_s = arguments.duration_s;
  arguments.load.encode_message = shoal::encode_own_message;
  arguments.load.special_files = arguments.run.special_files;
  // Check combinations of options.
  if (arguments.world.empty() == arguments.from.empty())
    throw command_line::UsageError("needs either a WORLD or --from FILE");
  if (!arguments.run.await.empty() && arguments.run.bus == "none")
    throw CLI::ValidationError("--await", "needs the LCM bus: clients cannot join on --bus none");
  arguments.run.snapshot_at_s = parse_times(arguments.snapshot_at);
  const bool nowhere = arguments.run.snapshots.empty() && arguments.run.results.empty();
  if (nowhere && (!arguments.snapshot_at.empty() || arguments.run.snapshot_every_s))
    throw CLI::ValidationError("--snapshot-at", "needs --snapshots DIR or --results DIR");
  // Clients of rosbridge connect to the port of the page.
  arguments.with_page = arguments.with_page || arguments.view.rosbridge || arguments.view.rosbridge_control;
  experiment::Browser browser;
  if (arguments.open) arguments.view.opened = [&browser](const std::string& url) { browser.open(url); };
  if (arguments.with_page) {
    load_library("page");
    arguments.run.page = live_page->page(arguments.view);
  }
  // Topics of ROS 2 in an MCAP record.
  if (bridges::is_mcap_name(arguments.run.record)) load_library("ros2");
  const bool writes = !arguments.run.results.empty() || !arguments.run.record.empty();
  if (arguments.watch && (writes || !arguments.from.empty()))
    throw CLI::ValidationError("--watch", "cannot be given with --results, --record or --from");
  if (arguments.watch) {
    experiment::catch_signals(true);
    return live_page->run_watched(
        experiment::world_file(arguments.world), arguments.run, arguments.view,
        [&] { return load_with_programs(arguments); },
        [&](const sim::LoadedWorld& loaded) { return run_loaded(loaded, arguments); });
  }
  const sim::LoadedWorld loaded = load_with_programs(arguments);
  experiment::catch_signals(true);
  return run_loaded(loaded, arguments);
}

void add_snapshot_options(CLI::App& command, RunArguments& arguments) {
  // Snapshot files.
  command.add_option("--from", arguments.from, "continue from a snapshot file instead of the start of a WORLD")
      ->type_name("FILE");
  command
      .add_option("--snapshot-at", arguments.snapshot_at, "write snapshot files at these times in s, such as 10,20.5")
      ->type_name("TIMES");
  command
      .add_option("--snapshot-every", arguments.run.snapshot_every_s, "interval between snapshots in simulated seconds")
      ->type_name("S")
      ->check(number_from(0.001, 1e9));
  command.add_option("--snapshots", arguments.run.snapshots, "directory of snapshot files; default RESULTS/snapshots")
      ->type_name("DIR");
  // Rewinding.
  command
      .add_option("--rewind-s", arguments.run.rewind_s,
                  "how far the run can be rewound, in simulated seconds; default 60 on a bus or terminal")
      ->type_name("S")
      ->check(number_from(0, 1e6));
  command.add_option("--rewind-mb", arguments.run.rewind_MB, "memory for the rewind history, MB")
      ->type_name("MB")
      ->check(number_from(1, 1e5))
      ->capture_default_str();
}

void add_output_options(CLI::App& command, RunArguments& arguments) {
  CLI::Option* record =
      command.add_option("--record", arguments.run.record, "write an LCM event log, or an MCAP file (*.mcap)")
          ->type_name("FILE");
  command
      .add_option("--record-mb", arguments.run.record_mb,
                  "size of the record, MB: above it messages are thinned evenly; those needed for replay are kept")
      ->type_name("MB")
      ->check(number_from(0.1, 1e9))
      ->needs(record);
  command.add_flag("--overwrite", arguments.run.overwrite, "let the record and snapshots replace existing files");
  command.add_flag("--special-files", arguments.run.special_files,
                   "let the world and the record be pipes or devices, such as /dev/stdin");
  command.add_option("--results", arguments.run.results, "directory for summary.json, CSV files and plots")
      ->type_name("DIR");
  command.add_flag_callback(
      "--no-plots", [&] { arguments.run.plots = false; }, "results without plots");
  command.add_flag("--quiet", arguments.run.quiet, "print neither progress nor summary");
}

void add_bus_options(CLI::App& command, RunArguments& arguments) {
  // Buses and control.
  command.add_option("--bus", arguments.run.bus, "lcm, or none for a run within the process only")
      ->type_name("BUS")
      ->check(one_of({"lcm", "none"}).description(""));
  add_lcm_url_option(command, arguments.run.lcm_url);
  command.add_flag("--lcm-shared", arguments.run.lcm_shared,
                   "start even if another simulator is on the bus; otherwise the exit code is 4");
  auto* key = command.add_flag("--control-key", arguments.run.control_key,
                               "require the key of the run for control, even if its bus does not leave this machine");
  command
      .add_flag("--open-control", arguments.run.open_control,
                "allow control without a key, even if a bus leaves this machine; for trusted networks only")
      ->excludes(key);
  // Programs and serial ports.
  command.add_flag("--launch", arguments.run.launch, "start the programs that the world names");
  command_line::add_name_list(command, "--await", arguments.run.await,
                              "lockstep clients to wait for, started by hand: NAME,NAME,...")
      ->type_name("NAMES");
  command.add_flag_callback(
      "--no-serial-ports", [&] { arguments.run.serial_ports = false; },
      "do not open the pseudo-terminals and FIFOs of devices");
  command
      .add_option("--run-name", arguments.run.name, "value of {run} in paths of serial ports and commands of processes")
      ->type_name("NAME")
      ->capture_default_str();
}

}  // namespace

static void add_run_command(CLI::App& app, int& exit_code) {
  CLI::App* command = app.get_subcommand("run");
  const auto arguments = std::make_shared<RunArguments>();
  add_log_level_option(*command);
  // World, time and seed.
  command->add_option("WORLD", arguments->world, "world file, or the name of a shipped world (shoal list)");
  command->add_option("--duration", arguments->duration_s, "simulated seconds; forever: until a request to quit")
      ->type_name("S")
      ->transform(command_line::number_or_word(1e-6, 1e9, "forever"));
  command->add_option("--speed", arguments->speed, "times real time, from 0.001 to 1e6, or max")->type_name("FACTOR");
  command->add_option("--seed", arguments->load.seed, "seed of every random stream")
      ->type_name("N")
      ->check(command_line::seed());
  add_set_option(*command, arguments->load.sets);
  add_allow_path_option(*command, arguments->load);
  // Control, output and snapshots.
  command->add_flag("--paused", arguments->run.paused, "wait for a resume on sim.control");
  command->add_flag_callback(
      "--no-keys", [arguments] { arguments->run.keys = false; }, "ignore the keys of the terminal");
  add_bus_options(*command, *arguments);
  add_output_options(*command, *arguments);
  command->add_flag("--view", arguments->with_page, "serve a live page of the run in 3-D, and print its address");
  command->add_flag("--watch", arguments->watch, "with --view: rerun the world whenever one of its files is saved")
      ->needs("--view");
  add_open_option(*command, arguments->open)->needs("--view");
  add_page_options(*command, arguments->view);
  command->add_flag("--rosbridge-control", arguments->view.rosbridge_control,
                    "as --rosbridge; any local client may command vehicles, and pause, rewind and change the run");
  command
      ->add_option("--drive-profile", arguments->view.drive_profile,
                   "profile with which pages drive vehicles; see `shoal drive --print-profile`")
      ->type_name("FILE");
  add_snapshot_options(*command, *arguments);
  add_threads_option(*command, arguments->run.threads);
  add_plugin_option(*command);
  // End of the help and action.
  command_line::set_help_end(
      *command, {{"shoal run worlds/minimal.yaml --duration 10 --speed 1",
                  "shoal run worlds/coop_land.yaml --launch --results results/coop_land --record coop.lcm",
                  "shoal run worlds/coop_underwater.yaml --launch --view",
                  "shoal run worlds/minimal.yaml --rosbridge-control --view-port 9090",
                  "shoal run my_world.yaml --bus none --view --watch",
                  "shoal run worlds/coop_land.yaml --duration 20 --snapshot-at 10 --snapshots snaps",
                  "shoal run --from snaps/branch0_step1000.snapshot --set vehicles.rover3.devices.lidar.rate_hz=5",
                  "shoal run worlds/coop_land.yaml --seed 7 --set vehicles.rover3.devices.modem.loss_probability=0.2"},
                 {{0, "the run ended; no rule of the world failed"},
                  {1, "a rule of the world or one of its programs failed"},
                  {2, "wrong usage, or a mistake in the world"},
                  {3, "physics fault"},
                  {4, "bus or file error"},
                  {5, "a lockstep client did not join or answer in time, or a step took longer than 'limits' allows"},
                  {129, "ended by SIGHUP; 130 by SIGINT; 143 by SIGTERM"}},
                 {}});
  command->callback([arguments, &exit_code] { exit_code = run(*arguments); });
}

SHOAL_COMMAND(run, "run", "Run a world", add_run_command);

}  // namespace tools
