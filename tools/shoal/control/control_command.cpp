// SPDX-License-Identifier: BSD-3-Clause
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <memory>
#include <sstream>
#include <thread>

#include "experiment/run/runner.hpp"
#include "sim/config/message_text.hpp"
#include "tools/shoal/commands/commands.hpp"
#include "tools/shoal/control/control_session.hpp"

namespace tools {

namespace {

using namespace std::chrono_literals;
struct ControlArguments {
  std::string command;
  std::string text;
  double value = 0;
  std::string client = "shoal-control-" + std::to_string(getpid());
  std::string lcm_url;
  std::string run;
  double timeout_s = 5;
  bool hold_here = false;
};

const std::vector<std::string> known_requests = {"pause",  "resume",   "step",    "speed", "quit",  "until",
                                                 "rewind", "snapshot", "restore", "where", "scene", "spawn",
                                                 "remove", "describe", "bus",     "do",    "leave"};

/// Reads the text: `@FILE` is replaced by the content of the file, `-` by standard input.
std::string text_of(const std::string& argument) {
  if (argument != "-" && !argument.starts_with("@")) return argument;
  std::ostringstream text;
  if (argument == "-") {
    text << std::cin.rdbuf();
  } else {
    std::ifstream file(argument.substr(1));
    const bool folder = std::filesystem::is_directory(argument.substr(1));
    if (!file || folder)
      throw CLI::ValidationError("TEXT",
                                 "cannot read '" + argument.substr(1) + "'" + (folder ? ": it is a folder" : ""));
    text << file.rdbuf();
  }
  return text.str();
}

/// Returns whether a run is paused because of this request, so that it must be resumed.
bool leaves_paused(const std::string& command, const std::string& reply) {
  return (command == "pause" || command == "rewind" || command == "restore") &&
         reply.find(", paused") != std::string::npos;
}

int control(const ControlArguments& arguments) {
  const bool known = std::find(known_requests.begin(), known_requests.end(), arguments.command) != known_requests.end();
  // Reject a misspelled request; the simulator decides about unknown ones.
  if (const std::string meant = sim::closest_name(arguments.command, known_requests); !known && !meant.empty())
    throw command_line::UsageError("unknown request '" + sim::shortened(sim::printable(arguments.command)) +
                                   "'; did you mean '" + meant + "'?");
  // Send the request and print the reply.
  const std::string text = text_of(arguments.text);
  experiment::catch_signals(false);
  ControlSession session({arguments.client, arguments.lcm_url, arguments.run, arguments.timeout_s});
  const auto reply = session.send_request(arguments.command, text, arguments.value);
  if (!reply) {
    std::cerr << "shoal control: " << session.no_answer() << '\n';
    return exit_timeout;
  }
  (reply->ok ? std::cout : std::cerr) << reply->text << (reply->text.empty() ? "ok\n" : "\n") << std::flush;
  if (!reply->ok) return exit_failed;
  if (leaves_paused(arguments.command, reply->text))
    std::cerr << "paused; continue with `shoal control resume"
              << (arguments.lcm_url.empty() ? "" : " --lcm-url '" + arguments.lcm_url + "'")
              << (arguments.run.empty() ? "" : " --run '" + arguments.run + "'") << "`\n";
  // A vehicle that depends on its client remains as long as the client reports that it is alive.
  while (arguments.hold_here && experiment::caught_signal() == 0) {
    if (!session.send_request("alive", "", 0) && experiment::caught_signal() == 0) return exit_timeout;
    std::this_thread::sleep_for(500ms);
  }
  if (arguments.hold_here) session.send_request("leave", "", 0);
  return exit_ok;
}

}  // namespace

static void add_control_command(CLI::App& app, int& exit_code) {
  CLI::App* command = app.get_subcommand("control");
  const auto arguments = std::make_shared<ControlArguments>();
  add_log_level_option(*command);
  // Request.
  command
      ->add_option("COMMAND", arguments->command,
                   command_line::alternatives(known_requests) + " (docs/reference/messages.md)")
      ->required();
  command->add_option("TEXT", arguments->text, "text of the request; @FILE: contents of the file; -: standard input");
  command->add_option("--value", arguments->value, "number of the request: steps, speed (or max), seconds")
      ->type_name("NUMBER")
      ->transform(command_line::number_or_word(-1e12, 1e12, "max").description(""));
  // Client and connection.
  command->add_option("--client", arguments->client, "client name to use in requests; default shoal-control-PID")
      ->type_name("NAME");
  command
      ->add_option("--run", arguments->run,
                   "folder of the run, with its key in run.key; default: the key in SHOAL_RUN_KEY, if set")
      ->type_name("DIR");
  command->add_option("--timeout", arguments->timeout_s, "wall seconds to wait for the answer")
      ->type_name("S")
      ->check(number_from(0.01, 1e6))
      ->capture_default_str();
  command->add_flag("--stay", arguments->hold_here, "keep a vehicle spawned with `with_client: true` until Ctrl-C");
  add_lcm_url_option(*command, arguments->lcm_url);
  // End of the help and action.
  command_line::set_help_end(
      *command, {{"shoal control pause", "shoal control step --value 10", "shoal control until --value 90",
                  "shoal control until storm  # an event of the world",
                  "shoal control rewind --value 30  # paused then, until `shoal control resume`",
                  "shoal control rewind run --value 30  # continues immediately", "shoal control snapshot before_dive",
                  "shoal control restore before_dive",
                  "shoal control spawn '{name: rover7, file: rover.yaml, position_m: [2, 0, 0]}'",
                  "shoal control spawn @my_robot.yaml", "shoal control quit --run results/dive1",
                  "shoal control remove rover7", "shoal control do '{fault: {device: rover1/lidar, kind: stuck}}'"},
                 {{0, "executed"},
                  {1, "refused; the reason is on stderr"},
                  {2, "wrong usage"},
                  {4, "bus or file error"},
                  {5, "no simulator answered in time"}},
                 {}});
  command->callback([arguments, &exit_code] { exit_code = control(*arguments); });
}

SHOAL_COMMAND(connect, "control", "Send a request to a running simulator and print its answer", add_control_command);

}  // namespace tools
