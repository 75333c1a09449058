// SPDX-License-Identifier: BSD-3-Clause
#include <csignal>
#include <iostream>
#include <memory>

#include "bridges/lcm/tcpq_server.hpp"
#include "sim/base/log.hpp"
#include "tools/command_line/checks.hpp"
#include "tools/shoal/commands/commands.hpp"

namespace tools {

namespace {

constexpr double bytes_per_MB = 1e6;

const bridges::TcpqServer* served = nullptr;  // for the handler of signals

void stop_serving(int /*signal*/) {
  served->stop();
}

int serve(const bridges::TcpqServer::Options& options) {
  bridges::TcpqServer server(options, [](const std::string& line) { sim::log_warn("{}", line); });
  served = &server;
  struct sigaction action {};
  action.sa_handler = stop_serving;
  for (const int signal : {SIGINT, SIGTERM, SIGHUP}) sigaction(signal, &action, nullptr);
  std::cout << "LCM server: tcpq://" << options.host << ':' << server.port() << std::endl;
  if (!options.host.starts_with("127."))
    sim::log_warn("every program that reaches {} can publish on this bus; a run on it is controlled with its key only",
                  options.host);
  server.run();
  std::cout << server.messages() << " messages\n";
  return exit_ok;
}

}  // namespace

static void add_tcpq_command(CLI::App& app, int& exit_code) {
  CLI::App* command = app.get_subcommand("tcpq");
  const auto options = std::make_shared<bridges::TcpqServer::Options>();
  const auto waiting_MB = std::make_shared<double>(64);
  add_log_level_option(*command);
  command->add_option("--host", options->host, "IPv4 address to listen on; 0.0.0.0: all of this machine")
      ->type_name("ADDRESS")
      ->capture_default_str();
  command->add_option("--port", options->port, "port to listen on; 0: any free one")
      ->type_name("PORT")
      ->check(command_line::whole_from(0, 65535))
      ->capture_default_str();
  command
      ->add_option("--max-waiting-mb", *waiting_MB,
                   "what may wait for a client that does not read, before it is cut, MB")
      ->type_name("MB")
      ->check(number_from(0.001, 1e4))
      ->capture_default_str();
  command_line::set_help_end(*command,
                             {{"shoal tcpq", "shoal tcpq --host 192.168.1.7",
                               "shoal run worlds/minimal.yaml --lcm-url tcpq://192.168.1.7:7700"},
                              {{0, "ended by a signal"}, {2, "wrong usage"}, {4, "the port or the network fails"}},
                              {}});
  command->callback([options, waiting_MB, &exit_code] {
    options->max_waiting_bytes = static_cast<std::size_t>(*waiting_MB * bytes_per_MB);
    exit_code = serve(*options);
  });
}

SHOAL_COMMAND(connect, "tcpq", "Serve LCM over TCP, for machines without multicast between them", add_tcpq_command);

}  // namespace tools
