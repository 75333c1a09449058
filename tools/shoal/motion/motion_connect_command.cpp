// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <filesystem>
#include <iostream>
#include <memory>
#include <numbers>

#include "devices/motion/motion_player.hpp"
#include "experiment/world_files/world_by_name.hpp"
#include "messages/yaml/message_writer.hpp"
#include "motion/analysis/connect.hpp"
#include "motion/analysis/motion_file.hpp"
#include "sim/base/log.hpp"
#include "sim/config/message_text.hpp"
#include "tools/shoal/motion/motion_commands.hpp"
#include "tools/shoal/motion/motion_output.hpp"

namespace tools {

namespace {

struct ConnectArguments {
  std::string from, to, world, vehicle, output;
  bool overwrite = false;
  sim::LoadOptions load;
  motion::ConnectOptions options;
};

/// A pose or a motion that an argument names.
struct NamedEnd {
  std::string name;
  sim::JointMotion motion;  ///< that of the pose holds it
};

sim::JointValues values_at(const sim::JointMotion& motion, double at_s) {
  sim::JointValues values;
  for (const sim::MotionTrack& track : motion.tracks()) values.emplace_back(track.joint, track.value_at(at_s));
  return values;
}

std::vector<sim::JointMotion> motions_of(const sim::VehicleConfig& vehicle) {
  std::vector<sim::JointMotion> motions;
  for (const sim::DeviceConfig& device : vehicle.devices)
    if (const auto* player =
            dynamic_cast<const sim::detail::ParamsOf<devices::MotionPlayer::Params>*>(device.params.get()))
      for (const devices::MotionPlayer::MotionFile& one : player->params.motions) motions.push_back(one.motion);
  return motions;
}

/// Finds a file, a pose of a file (FILE:POSE), or a pose or motion of the vehicle's player.
NamedEnd end_named(const std::string& text, const sim::VehicleConfig& vehicle) {
  if (std::filesystem::exists(text)) return {text, motion_of(text)};
  const std::size_t colon = text.rfind(':');
  if (colon != std::string::npos && std::filesystem::exists(text.substr(0, colon))) {
    const sim::JointMotion motion = motion_of(text.substr(0, colon));
    const sim::MotionPose* pose = motion.find_pose(text.substr(colon + 1));
    if (pose == nullptr)
      throw sim::ConfigError({text.substr(0, colon) + ": there is no pose '" + text.substr(colon + 1) + "'"});
    return {text, motion::held_pose(pose->name, vehicle.vehicle, pose->joints)};
  }
  std::vector<std::string> known;
  const std::vector<sim::JointMotion> motions = motions_of(vehicle);
  for (const sim::JointMotion& motion : motions)
    if (const sim::MotionPose* pose = motion.find_pose(text))
      return {text, motion::held_pose(pose->name, vehicle.vehicle, pose->joints)};
  for (const sim::JointMotion& motion : motions) {
    if (motion.name == text) return {text, motion};
    known.push_back(motion.name);
    for (const sim::MotionPose& pose : motion.poses) known.push_back(pose.name);
  }
  std::sort(known.begin(), known.end());
  known.erase(std::unique(known.begin(), known.end()), known.end());
  throw sim::ConfigError({"'" + text + "' is neither a motion file, nor a pose or motion of vehicle '" +
                          vehicle.vehicle + "'; known: " + sim::list_text(known)});
}

std::string word_of(motion::ConnectionKind kind) {
  switch (kind) {
    case motion::ConnectionKind::straight:
      return "straight";
    case motion::ConnectionKind::slower:
      return "straight, slower";
    case motion::ConnectionKind::by_stance:
      return "by the stance at the start of the run";
    case motion::ConnectionKind::searched:
      return "by a pose found by search";
    case motion::ConnectionKind::none:
      break;
  }
  return "none";
}

std::string outcome(const motion::Arrival& arrival) {
  if (arrival.fell) return fmt::format("fell after {:.2f} s", arrival.at_s);
  return fmt::format("{}, {:.2f} deg from the end", arrival.arrived ? "arrived" : "did not arrive",
                     arrival.error * 180 / std::numbers::pi);
}

int connect(ConnectArguments arguments) {
  check_new_file(arguments.output, arguments.overwrite);
  arguments.load.encode_message = shoal::encode_own_message;
  const sim::LoadedWorld loaded =
      sim::load_world(experiment::file_by_name({experiment::ShippedKind::world}, arguments.world), arguments.load);
  const std::string vehicle = motion::walking_vehicle(loaded.config, arguments.vehicle);
  const auto instance = std::find_if(loaded.config.vehicles.begin(), loaded.config.vehicles.end(),
                                     [&](const sim::VehicleInstance& one) { return one.name == vehicle; });
  const NamedEnd from = end_named(arguments.from, *instance->config), to = end_named(arguments.to, *instance->config);
  motion::Connector connector(loaded.config, vehicle, from.motion, arguments.options);
  motion::Connection connection = connector.connect(values_at(to.motion, 0));
  for (const std::size_t world : connection.left_out)
    sim::log_warn("perturbed world {} is skipped: '{}' does not stand in it", world, from.name);
  // Print the worlds, then the result.
  for (std::size_t w = 0; w < connection.straight.size(); ++w)
    std::cout << fmt::format("world {:<3} straight: {}; best: {}\n", w, outcome(connection.straight[w]),
                             outcome(connection.arrivals[w]));
  if (connection.kind == motion::ConnectionKind::none) {
    std::cout << fmt::format("no motion from {} to {} arrives in all {} worlds; {} motions played, nothing written\n",
                             from.name, to.name, connection.straight.size(), connection.played);
    return exit_failed;
  }
  connection.motion.name = motion::motion_name_of(arguments.output);
  connection.motion.description = fmt::format("From {} to {}.", from.name, to.name);
  check_frames(arguments.output, connection.motion, arguments.overwrite);
  motion::write_motion(arguments.output, connection.motion);
  std::cout << fmt::format("{}; {:.2f} s; {} motions played; written to {}\n", word_of(connection.kind),
                           connection.motion.end_s(), connection.played, arguments.output);
  return exit_ok;
}

}  // namespace

void add_motion_connect_command(CLI::App& motion, int& exit_code) {
  CLI::App* command = motion.add_subcommand("connect", "Search for a motion from one pose to another without a fall");
  const auto arguments = std::make_shared<ConnectArguments>();
  motion::ConnectOptions& options = arguments->options;
  add_log_level_option(*command, "warn");
  command
      ->add_option("FROM", arguments->from,
                   "pose or motion of the vehicle by name, FILE:POSE, or a motion file: its end")
      ->required();
  command->add_option("TO", arguments->to, "likewise; of a motion file, its start")->required();
  add_stage_options(*command, arguments->world, arguments->vehicle);
  command->add_option("--output", arguments->output, "motion file to write")->type_name("FILE")->required();
  add_overwrite_option(*command, arguments->overwrite);
  command
      ->add_option("--worlds", options.worlds,
                   "number of perturbed worlds, in addition to the unperturbed one; default 4")
      ->check(whole_from(0, 1000));
  command
      ->add_option("--velocity", options.velocity,
                   "mean velocity of the joint that moves farthest on the straight connection, rad/s; default 1")
      ->check(number_from(0.01, 100));
  command->add_option("--settle", options.settle_s, "time after a motion in which it may still fall, s; default 1")
      ->check(number_from(0, 600));
  command->add_option("--candidates", options.candidates, "maximum number of motions tried; default 300")
      ->check(whole_from(0, 1000000));
  command->add_option("--seed", options.seed, "seed of candidates and perturbed worlds; default 1")
      ->check(command_line::seed());
  command
      ->add_option("--threads", options.threads, "number of threads; 0: one per processor; does not change the results")
      ->check(whole_from(0, 256));
  add_set_option(*command, arguments->load.sets);
  add_allow_path_option(*command, arguments->load);
  command_line::set_help_end(
      *command,
      {{"shoal motion connect bow crouch --world ers7_studio --output rise.yaml",
        "shoal motion connect wave.yaml stand --world ers7_studio --output between.yaml"},
       {{0, "a motion that arrives in all worlds was written"},
        {1, "none was found"},
        {2, "wrong usage or configuration"},
        {4, "file error"}},
       {"The attempts, in this order: straight from pose to pose; the same slower; by the stance at the start of the "
        "run; by a pose found by search, with its times.   It arrives when all joints are within 2 degrees of their "
        "ends and it stands still; it falls when it tilts by more than 45 degrees or its first body touches something, "
        "except where it does so at one of the ends."}});
  command->callback([arguments, &exit_code] { exit_code = connect(*arguments); });
}

}  // namespace tools
