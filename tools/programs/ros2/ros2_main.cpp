// SPDX-License-Identifier: BSD-3-Clause
#include <CLI/App.hpp>
#include <CLI/Validators.hpp>
#include <csignal>
#include <cstdlib>
#include <iostream>
#include <optional>
#include <stdexcept>
#include <string>
#include <vector>

#include "bridges/ros2/door/ros2_door.hpp"
#include "bridges/ros2/node/node_types.hpp"
#include "tools/command_line/checks.hpp"
#include "tools/command_line/help.hpp"
#include "tools/command_line/parse.hpp"

namespace {

constexpr int exit_bus = 4;

volatile std::sig_atomic_t signal_caught = 0;

void on_signal(int signal) {
  signal_caught = signal;
}

struct Arguments {
  bridges::ros2::Ros2Door::Options door;
  std::vector<std::string> peers;
  std::string package_folder;
  bool no_tf = false;
};

void add_options(CLI::App& app, Arguments& arguments) {
  app.add_option("--lcm-url", arguments.door.lcm_url, "LCM URL; overrides LCM_DEFAULT_URL")->type_name("URL");
  app.add_option("--peer", arguments.peers, "another host with ROS 2, by name or address")->type_name("HOST");
  app.add_flag("--control", arguments.door.controls,
               "serve requests that pause, step, rewind and change the run, for all who reach this door");
  app.add_option("--run", arguments.door.run, "results folder of a run that needs its key; else SHOAL_RUN_KEY")
      ->type_name("DIR");
  bridges::ros2::Ros2Lockstep::Options& lockstep = arguments.door.lockstep;
  app.add_option("--lockstep", lockstep.nodes, "join the lockstep: each tick waits for this node; may be repeated")
      ->type_name("NODE")
      ->check(command_line::not_empty());
  app.add_option("--period-s", lockstep.period_s, "simulated seconds between ticks of the lockstep")
      ->type_name("S")
      ->check(CLI::Range(0.001, 10.0))
      ->capture_default_str();
  app.add_option("--name", lockstep.name, "name in the lockstep")->type_name("NAME")->capture_default_str();
  app.add_flag("--no-tf", arguments.no_tf, "leave /tf to your own localization: without the true poses");
  app.add_option("--write-package", arguments.package_folder,
                 "only write the package shoal_interfaces with Shoal's message types for colcon, to this folder")
      ->type_name("DIR")
      ->check(command_line::not_empty());
  command_line::set_help_end(
      app, {{"shoal-ros2", "ROS_DOMAIN_ID=7 shoal-ros2 --peer 192.0.2.7", "shoal-ros2 --lockstep pilot",
             "shoal-ros2 --write-package ~/ws/src"},
            {{0, "the run in lockstep ended, or the package was written"},
             {2, "wrong usage"},
             {4, "error of LCM, DDS or the lockstep"},
             {130, "ended by SIGINT; 143 by SIGTERM"}},
            {"It honors ROS_DOMAIN_ID, ROS_STATIC_PEERS, ROS_LOCALHOST_ONLY and ROS_AUTOMATIC_DISCOVERY_RANGE, and "
             "stays on this machine unless a peer is named.  docs/guides/attach_ros2.md has the topics."}});
}

int carry(const Arguments& arguments) {
  std::signal(SIGTERM, on_signal);
  std::signal(SIGINT, on_signal);
  bridges::ros2::Ros2Door door(arguments.door);
  const bridges::DdsNetwork& network = arguments.door.network;
  std::cerr << "shoal-ros2: node /shoal, domain " << network.domain << ", "
            << (network.peers.empty() ? "on this machine only"
                                      : "with " + std::to_string(network.peers.size()) + " other hosts")
            << ", bus " << door.lcm_url() << std::endl;
  for (const std::string& node : arguments.door.lockstep.nodes)
    std::cerr << "shoal-ros2: in lockstep with '" << node << "'" << std::endl;
  door.run([] { return signal_caught != 0; });
  const auto& counts = door.counts();
  std::cerr << "shoal-ros2: " << counts.published << " messages to ROS 2, " << counts.late << " of them given up; "
            << counts.commands << " from ROS 2, " << counts.refused << " of them refused" << std::endl;
  return signal_caught != 0 ? 128 + signal_caught : 0;
}

int run(int argc, char** argv) {
  Arguments arguments;
  CLI::App app{"Connects a run with ROS 2: publishes its messages as topics, and takes commands.", "shoal-ros2"};
  add_options(app, arguments);
  if (const auto exit_code = command_line::parse(app, argc, argv)) return *exit_code;
  if (!arguments.package_folder.empty()) {
    bridges::ros2::write_message_package(arguments.package_folder);
    return 0;
  }
  arguments.door.publishes_tf = !arguments.no_tf;
  arguments.door.network =
      bridges::dds_network(std::move(arguments.peers), [](const char* name) { return std::getenv(name); });
  return carry(arguments);
}

}  // namespace

int main(int argc, char** argv) {
  try {
    return run(argc, argv);
  } catch (const std::invalid_argument& error) {
    return command_line::wrong_usage("shoal-ros2", error.what());
  } catch (const std::exception& error) {
    std::cerr << "shoal-ros2: " << error.what() << std::endl;
    return signal_caught != 0 ? 128 + signal_caught : exit_bus;
  }
}
