// SPDX-License-Identifier: BSD-3-Clause
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <memory>
#include <optional>
#include <sstream>
#include <thread>

#include "bridges/lcm/lcm_listener.hpp"
#include "bridges/lockstep_client/wait_warning.hpp"
#include "bridges/signing/signed_message.hpp"
#include "shoal/message_codec.hpp"
#include "shoal/sim_control_reply_t.hpp"
#include "shoal/sim_control_request_t.hpp"
#include "sim/config/message_text.hpp"
#include "tools/experiment/run/runner.hpp"
#include "tools/shoal/commands.hpp"

namespace tools {

namespace {

using namespace std::chrono_literals;
using Clock = std::chrono::steady_clock;

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
                                                 "remove", "describe", "do",      "leave"};

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

/// Requests and their replies.  A request is sent again only if it was lost, because it might be executed twice: a run
/// that has not started yet does not receive it.
class Session {
 public:
  explicit Session(const ControlArguments& arguments) : arguments_(arguments), lcm_(arguments.lcm_url) {
    lcm_.listen("sim.control.reply");
    const auto key = arguments.run.empty() ? bridges::run_key_from_environment() : bridges::read_run_key(arguments.run);
    if (key) signer_.emplace(*key, arguments.client);
  }

  /// Returns the reply; nothing when none arrived in time.
  std::optional<shoal::sim_control_reply_t> send_request(const std::string& command, const std::string& text,
                                                         double value) {
    const Clock::time_point deadline =
        Clock::now() + std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double>(arguments_.timeout_s));
    bridges::WaitWarning audit_entry("shoal control: waiting for a simulator to answer on 'sim.control.reply', at " +
                                     lcm_.url());
    const std::int32_t request = ++id_, question = ++id_;
    send(request, command, text, value);
    // Requests are answered in order.  When the query, which changes nothing, is answered and the request is not, the
    // simulator has not received the request.
    while (Clock::now() < deadline && caught_signal() == 0) {
      auto reply =
          await_reply(request, question, std::min<Clock::time_point>(deadline, Clock::now() + 1s), audit_entry);
      if (!reply) {
        send(question, "alive", "", 0);
        continue;
      }
      if (reply->id == request) return reply;
      send(request, command, text, value);
      return await_reply(request, request, deadline, audit_entry);
    }
    return std::nullopt;
  }

  const std::string& url() const { return lcm_.url(); }

 private:
  void send(std::int32_t id, const std::string& command, const std::string& text, double value) {
    shoal::sim_control_request_t request{};
    request.id = id;
    request.client = arguments_.client;
    request.command = command;
    request.text = text;
    request.value = value;
    const sim::Bytes payload = shoal::encode(request);
    lcm_.publish("sim.control", signer_ ? signer_->sign("sim.control", payload) : payload);
  }

  /// Returns the reply to one of two requests.
  std::optional<shoal::sim_control_reply_t> await_reply(std::int32_t id, std::int32_t other_id,
                                                        Clock::time_point deadline, bridges::WaitWarning& audit_entry) {
    while (Clock::now() < deadline && caught_signal() == 0) {
      audit_entry.look();
      const auto message = lcm_.next(50ms);
      if (!message || message->channel != "sim.control.reply") continue;
      try {
        auto reply = shoal::decode<shoal::sim_control_reply_t>(message->payload, shoal::Finite::any);
        if ((reply.id == id || reply.id == other_id) && reply.client == arguments_.client) return reply;
      } catch (const shoal::MessageError&) {
        // An unrelated message on the channel.
      }
    }
    return std::nullopt;
  }

  const ControlArguments& arguments_;
  bridges::LcmListener lcm_;
  std::optional<bridges::MessageSigner> signer_;  // unset: there is no key
  std::int32_t id_ = static_cast<std::int32_t>(getpid()) * 1000;
};

int control(const ControlArguments& arguments) {
  const bool known = std::find(known_requests.begin(), known_requests.end(), arguments.command) != known_requests.end();
  // Reject a misspelt request; the simulator decides about unknown ones.
  if (const std::string meant = sim::closest_name(arguments.command, known_requests); !known && !meant.empty())
    throw command_line::UsageError("unknown request '" + sim::shortened(sim::printable(arguments.command)) +
                                   "'; did you mean '" + meant + "'?");
  // Send the request and print the reply.
  const std::string text = text_of(arguments.text);
  catch_signals(false);
  Session session(arguments);
  const auto reply = session.send_request(arguments.command, text, arguments.value);
  if (!reply) {
    std::cerr << "shoal control: no simulator answered within " << arguments.timeout_s << " s at " << session.url()
              << "; is one running there? see `shoal doctor`\n";
    return exit_timeout;
  }
  (reply->ok ? std::cout : std::cerr) << reply->text << (reply->text.empty() ? "ok\n" : "\n") << std::flush;
  if (!reply->ok) return exit_failed;
  if (leaves_paused(arguments.command, reply->text))
    std::cerr << "paused; continue with `shoal control resume"
              << (arguments.lcm_url.empty() ? "" : " --lcm-url '" + arguments.lcm_url + "'")
              << (arguments.run.empty() ? "" : " --run '" + arguments.run + "'") << "`\n";
  // A vehicle that depends on its client remains as long as the client reports that it is alive.
  while (arguments.hold_here && caught_signal() == 0) {
    if (!session.send_request("alive", "", 0) && caught_signal() == 0) return exit_timeout;
    std::this_thread::sleep_for(500ms);
  }
  if (arguments.hold_here) session.send_request("leave", "", 0);
  return exit_ok;
}

}  // namespace

void add_control_command(CLI::App& app, int& exit_code) {
  CLI::App* command = app.add_subcommand("control", "Send a request to a running simulator and print its answer");
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
  command->add_option("--client", arguments->client, "client name to use in requests; without it shoal-control-PID")
      ->type_name("NAME");
  command
      ->add_option("--run", arguments->run,
                   "folder of the run, with its key in run.key; without it the key in SHOAL_RUN_KEY, if set")
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

}  // namespace tools
