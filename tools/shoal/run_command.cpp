#include <spdlog/spdlog.h>

#include <charconv>
#include <iostream>
#include <memory>

#include "shoal/message_writer.hpp"
#include "tools/experiment/runner.hpp"
#include "tools/shoal/commands.hpp"

namespace tools {

namespace {

struct RunArguments {
  std::string world;
  sim::LoadOptions load;
  RunOptions run;
  std::string speed;
  std::optional<double> duration_s;
  std::string log_level = "info";
};

/// `max` or a number.
std::optional<double> parse_speed(const std::string& text) {
  if (text.empty()) return std::nullopt;
  if (text == "max") return 0.0;
  try {
    std::size_t used = 0;
    const double speed = std::stod(text, &used);
    if (used == text.size() && speed >= 0.001 && speed <= 1e6) return speed;
  } catch (const std::exception&) {
  }
  throw CLI::ValidationError("--speed", "must be 'max' or from 0.001 to 1e6, got '" + text + "'");
}

std::string check_seed(const std::string& text) {
  std::int64_t seed = 0;
  const char* end = text.data() + text.size();
  const auto [at, error] = std::from_chars(text.data(), end, seed);
  const bool good = error == std::errc{} && at == end && seed >= 0;
  return good ? "" : "must be a whole number from 0 to 9223372036854775807, got '" + text + "'";
}

int run(RunArguments& arguments) {
  spdlog::set_level(spdlog::level::from_str(arguments.log_level));
  arguments.load.allow_plugins = arguments.run.launch;
  arguments.run.speed = parse_speed(arguments.speed);
  arguments.run.duration_s = arguments.duration_s;
  arguments.load.encode_message = shoal::encode_own_message;
  const sim::LoadedWorld loaded = sim::load_world(arguments.world, arguments.load);
  catch_signals(true);
  const Summary summary = run_world(loaded, arguments.run);
  if (!summary.error.empty()) std::cerr << "shoal: " << summary.error << '\n';
  if (summary.steps > 0 && !arguments.run.quiet) std::cout << summary.to_text();
  if (summary.steps > 0 && !arguments.run.results.empty() && !arguments.run.quiet)
    std::cout << "  results in " << arguments.run.results << "/ (summary.json, tracks.png)\n";
  return summary.exit_code;
}

}  // namespace

void add_run_command(CLI::App& app, int& exit_code) {
  CLI::App* command = app.add_subcommand("run", "Run a world");
  const auto arguments = std::make_shared<RunArguments>();
  command->add_option("WORLD", arguments->world, "world file")->required();
  command->add_option("--duration", arguments->duration_s, "simulated seconds; 0: until told to quit")
      ->check(number_from(0, 1e9));
  command->add_option("--speed", arguments->speed, "times real time, from 0.001 to 1e6, or max");
  command->add_option("--seed", arguments->load.seed, "of every random stream")->check(check_seed);
  command->add_option("--set", arguments->load.sets, "path=value: change a value of the world file")
      ->type_size(1)
      ->allow_extra_args(false);
  command->add_option("--bus", arguments->run.bus, "lcm, or none: within the process only")
      ->check(CLI::IsMember({"lcm", "none"}));
  command->add_option("--lcm-url", arguments->run.lcm_url, "instead of LCM_DEFAULT_URL and the default");
  command->add_option("--record", arguments->run.record, "write an LCM event log, stamped with simulated time");
  command->add_flag("--overwrite", arguments->run.overwrite, "the record may replace a file");
  command->add_option("--results", arguments->run.results, "directory for summary.json, CSV files and plots");
  command->add_flag("!--no-pictures", arguments->run.pictures, "results without plots");
  command->add_flag("--paused", arguments->run.paused, "wait for a resume on sim.control");
  command->add_flag("--launch", arguments->run.launch, "start the programs that the world names");
  command->add_option("--threads", arguments->run.threads, "threads that follow rays; 0: one for each processor")
      ->check(CLI::Range(0, 256));
  command->add_option("--await", arguments->run.await, "lockstep clients, started by hand, to wait for")
      ->delimiter(',')
      ->type_size(1)
      ->allow_extra_args(false);
  add_plugin_option(*command);
  command->add_flag("!--no-serial-ports", arguments->run.serial_ports,
                    "do not open the pseudo-terminals and FIFOs of devices");
  command->add_flag("--quiet", arguments->run.quiet, "no progress and no summary");
  command->add_option("--log-level", arguments->log_level, "what is said on stderr")
      ->check(CLI::IsMember({"debug", "info", "warn", "error", "off"}));
  command->footer(
      "Examples:\n"
      "  shoal run worlds/minimal.yaml --duration 10 --speed 1\n"
      "  shoal run worlds/coop_land.yaml --launch --results results/coop_land --record coop.lcm\n"
      "  shoal run worlds/coop_land.yaml --seed 7 --set vehicles.rover3.devices.modem.loss_probability=0.2");
  command->callback([arguments, &exit_code] { exit_code = run(*arguments); });
}

}  // namespace tools
