// SPDX-License-Identifier: BSD-3-Clause
#include <spdlog/spdlog.h>

#include "bridges/base/bus_error.hpp"
#include "bridges/lcm/lcm_connection.hpp"
#include "tests/fuzz/fuzz_input.hpp"
#include "tools/autonomy/acomms/tdma.hpp"
#include "tools/autonomy/behaviours/behaviour_text.hpp"
#include "tools/autonomy/behaviours/waypoint_text.hpp"
#include "tools/command_line/arguments.hpp"
#include "tools/command_line/checks.hpp"

// Words of command lines: options with their checks, LCM URLs, waypoints, behaviours and slots.

namespace {

void parse_line(const std::string& text) {
  CLI::App app("fuzz", "shoal");
  app.require_subcommand(1);
  std::string name, world;
  double number = 0;
  std::int64_t seed = 0;
  std::vector<std::string> sets;
  bool flag = false;
  CLI::App* run = app.add_subcommand("run", "Run a world");
  run->add_option("world", world, "world file");
  run->add_option("--duration", number, "seconds")->check(command_line::number_from(0, 1e9));
  run->add_option("--threads,-t", seed, "threads")->check(command_line::whole_from(0, 256));
  run->add_option("--seed", seed, "seed")->check(command_line::seed());
  run->add_option("--bus", name, "bus")->check(command_line::one_of({"lcm", "none"}));
  run->add_option("--set", sets, "set")->check(command_line::setting());
  run->add_option("--record", name, "record")->check(command_line::not_empty());
  run->add_flag("--quiet,-q", flag, "quiet");
  CLI::App* log = app.add_subcommand("log", "Logs");
  log->require_subcommand(1);
  log->add_subcommand("info", "Info")->add_option("log", name, "log")->required();

  std::vector<std::string> words;
  std::size_t at = 0;
  while (at <= text.size()) {
    const std::size_t end = std::min(text.find('\n', at), text.size());
    words.push_back(text.substr(at, end - at));
    at = end + 1;
  }
  command_line::Arguments arguments = command_line::read_arguments(app, words);
  command_line::command_path(*arguments.command);
  if (arguments.help || !arguments.wrong.empty()) return;
  fuzz::allow<CLI::ParseError, command_line::UsageError>([&] { app.parse(std::move(arguments.for_cli11)); });
}

}  // namespace

SHOAL_FUZZ_TARGET(command_line) {
  fuzz::Reader reader(input);
  const std::size_t kind = reader.below(6);
  const std::string text(fuzz::text_of(reader.rest()));
  fuzz::allow<std::invalid_argument, bridges::BusError>([&] {
    switch (kind) {
      case 0:
        parse_line(text);
        break;
      case 1:
        if (text.find('\0') == text.npos) bridges::lcm_endpoint(bridges::resolve_lcm_url(text));
        break;
      case 2:
        autonomy::parse_waypoints(text);
        break;
      case 3:
        autonomy::parse_start(text);
        break;
      case 4:
        autonomy::make_behaviour(text, {{0, 0}, {1, 1}}, 1.0, true);
        break;
      default:
        autonomy::parse_slot(text);
    }
  });
}
