// SPDX-License-Identifier: BSD-3-Clause
#include <iostream>
#include <memory>

#include "motion/analysis/motion_check.hpp"
#include "motion/analysis/motion_file.hpp"
#include "tools/shoal/motion/motion_commands.hpp"
#include "tools/shoal/motion/motion_output.hpp"

namespace tools {

namespace {

struct CheckArguments {
  std::string file, vehicle, fixed;
  bool overwrite = false;
};

int check(const CheckArguments& arguments) {
  if (!arguments.fixed.empty()) check_new_file(arguments.fixed, arguments.overwrite);
  const sim::JointMotion motion = motion_of(arguments.file);
  const sim::VehicleConfig vehicle = vehicle_of(arguments.vehicle, motion);
  const std::vector<motion::MotionFinding> findings = motion::check_motion(motion, vehicle);
  for (const motion::MotionFinding& finding : findings) std::cout << arguments.file << ": " << finding.text() << '\n';
  if (findings.empty())
    std::cout << fmt::format("motion keeps all limits of {}\n", vehicle.vehicle);
  else
    std::cout << fmt::format("motion breaks limits of {}: {}\n", vehicle.vehicle, findings.size());
  if (arguments.fixed.empty()) return findings.empty() ? exit_ok : exit_failed;
  sim::JointMotion fixed = motion::mended(motion, vehicle);
  fixed.name = motion::motion_name_of(arguments.fixed);
  // What cannot be written is refused before anything is.
  check_frames(arguments.fixed, fixed, arguments.overwrite);
  motion::write_motion(arguments.fixed, fixed);
  const std::size_t left = motion::check_motion(fixed, vehicle).size();
  std::cout << fmt::format("{} written: {:.3f} s instead of {:.3f} s, {} findings left\n", arguments.fixed,
                           fixed.end_s(), motion.end_s(), left);
  return left == 0 ? exit_ok : exit_failed;
}

}  // namespace

void add_motion_check_command(CLI::App& motion, int& exit_code) {
  CLI::App* command = motion.add_subcommand("check", "Check a motion against the limits of a vehicle");
  const auto arguments = std::make_shared<CheckArguments>();
  add_log_level_option(*command);
  command->add_option("FILE", arguments->file, "motion file")->required();
  command->add_option("--vehicle", arguments->vehicle, "vehicle file; unset: the one that the motion names")
      ->type_name("FILE");
  command->add_option("--fix", arguments->fixed, "write a motion within the ranges and velocities, slower where needed")
      ->type_name("OUTPUT");
  add_overwrite_option(*command, arguments->overwrite);
  command_line::set_help_end(
      *command,
      {{"shoal motion check vehicles/motions/ers7/wave.yaml",
        "shoal motion check quick.yaml --vehicle ers7 --fix slow.yaml"},
       {{0, "all limits are kept"}, {1, "some are not"}, {2, "wrong usage, or mistakes in a file"}, {4, "file error"}},
       {"The check covers ranges, limits that depend on another joint, velocities and accelerations of each frame, "
        "and the seam of a loop."}});
  command->callback([arguments, &exit_code] { exit_code = check(*arguments); });
}

}  // namespace tools
