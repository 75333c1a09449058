// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <cmath>
#include <iostream>
#include <limits>
#include <memory>
#include <numbers>

#include "tools/experiment/motion/push_test.hpp"
#include "tools/experiment/score/support.hpp"
#include "tools/experiment/world_files/world_by_name.hpp"
#include "tools/shoal/motion/motion_commands.hpp"

namespace tools {

namespace {

struct StabilityArguments {
  std::string file;
  StageOptions stage;
  PushOptions push;
  double every_s = 0;
};

/// Times of the run of each key, or at whole multiples of a period.
std::vector<double> instants_of(const sim::JointMotion& motion, const MotionStage& stage, double start_s,
                                double every_s) {
  std::vector<double> instants;
  const double rate = stage.player().rate();
  if (every_s > 0)
    for (double t_s = 0; t_s <= motion.end_s() + 1e-9; t_s += every_s) instants.push_back(start_s + t_s / rate);
  else
    for (const sim::MotionKey& key : motion.keys) instants.push_back(start_s + key.at_s / rate);
  return instants;
}

int stability(StabilityArguments arguments) {
  const sim::JointMotion motion = motion_of(arguments.file);
  if (motion.keys.empty() && arguments.every_s <= 0)
    throw command_line::UsageError("the motion has no keys: give the times with --every");
  arguments.stage.world = file_by_name({ShippedKind::world}, arguments.stage.world);
  MotionStage stage(arguments.stage, motion);
  // Play it once, with the margins of each step.
  struct Margins {
    double at_s, static_m, zmp_m, capture_m;
  };
  std::vector<Margins> course;
  constexpr double none = std::numeric_limits<double>::quiet_NaN();
  stage.world().physics().watch_contacts(stage.vehicle().group());
  stage.after_step = [&](MotionStage& now) {
    const auto support = support_of(now.world(), now.vehicle());
    course.push_back(
        support ? Margins{now.now_s(), support->static_margin_m, support->zmp_margin_m, support->capture_margin_m}
                : Margins{now.now_s(), none, none, none});
  };
  double start_s = 0;
  const double max_s = end_limit_s(motion);
  while (stage.player().phase() == devices::MotionPlayer::Phase::approach && stage.now_s() < max_s)
    stage.go_to(stage.now_s() + sim::to_seconds(stage.world().step_time()));
  start_s = stage.time_of(0);
  // Of a motion that loops, the first round.
  if (!stage.play_out(0, motion.loop ? start_s + motion.end_s() / stage.player().rate() : max_s) && !motion.loop)
    throw sim::ConfigError(
        {fmt::format("{}: the motion has not ended after {:.0f} s of the run", arguments.file, max_s)});
  stage.after_step = {};
  const std::vector<double> instants = instants_of(motion, stage, start_s, arguments.every_s);
  const std::vector<PushMargin> margins = push_margins(stage, instants, arguments.push);
  // Print a row for each instant, with the least margins until the next one.
  std::cout << fmt::format("{:>8} {:>9} {:>9} {:>9} {:>10} {:>10} {:>9}\n", "motion s", "static mm", "zmp mm",
                           "capture mm", "push N s", "towards", "settle mm");
  bool falls = false;
  for (std::size_t i = 0; i < margins.size(); ++i) {
    const double until_s = i + 1 < margins.size() ? margins[i + 1].at_s : margins[i].at_s + 0.008;
    Margins min{0, none, none, none};
    for (const Margins& one : course)
      if (one.at_s >= margins[i].at_s - 1e-9 && one.at_s < until_s) {
        min.static_m = std::fmin(min.static_m, one.static_m);
        min.zmp_m = std::fmin(min.zmp_m, one.zmp_m);
        min.capture_m = std::fmin(min.capture_m, one.capture_m);
      }
    falls = falls || margins[i].least_Ns() <= 0;
    // Where even the greatest push is withstood, no direction is the worst.
    const bool beyond = margins[i].least_Ns() >= margins[i].mass_kg * arguments.push.greatest_mps;
    const std::string push = fmt::format("{}{:.3f}", beyond ? ">" : "", margins[i].least_Ns());
    const std::string towards =
        beyond ? "-" : fmt::format("{:.0f} deg", margins[i].least_direction_rad() * 180 / std::numbers::pi);
    std::cout << fmt::format("{:>8.3f} {:>9.1f} {:>9.1f} {:>10.1f} {:>10} {:>10} {:>9.1f}\n", margins[i].at_s - start_s,
                             min.static_m * mm, min.zmp_m * mm, min.capture_m * mm, push, towards,
                             margins[i].settle_m * mm);
  }
  std::cout << fmt::format(
      "margins: least until the next row, of steps with three contacts or more (nan: none); static and capture are "
      "negative outside of the support; push: greatest impulse that the vehicle of {:.3f} kg withstands in the worst "
      "of "
      "{} directions, at the centre of mass of its first body, up to {:.3f} N s\n",
      margins.front().mass_kg, arguments.push.directions, margins.front().mass_kg * arguments.push.greatest_mps);
  return falls ? exit_failed : exit_ok;
}

}  // namespace

void add_motion_stability_command(CLI::App& motion, int& exit_code) {
  CLI::App* command = motion.add_subcommand("stability", "Measure how safely a vehicle stands during a motion");
  const auto arguments = std::make_shared<StabilityArguments>();
  add_log_level_option(*command, "warn");
  command->add_option("FILE", arguments->file, "motion file")->required();
  add_stage_options(*command, arguments->stage.world, arguments->stage.vehicle);
  command->add_option("--every", arguments->every_s, "time between two rows, s; unset: a row for each key")
      ->type_name("S")
      ->check(number_from(0.001, 3600));
  command->add_option("--directions", arguments->push.directions, "of the pushes; usual 8")
      ->type_name("N")
      ->check(whole_from(1, 64));
  command->add_option("--watch", arguments->push.watch_s, "time after a push in which it may fall, s; usual 2")
      ->type_name("S")
      ->check(number_from(0.01, 60));
  command->add_option("--greatest", arguments->push.greatest_mps, "greatest impulse over the mass, m/s; usual 6")
      ->type_name("MPS")
      ->check(number_from(0.02, 100));
  command->add_option("--threads", arguments->push.threads, "0: one for each processor; the results are the same")
      ->type_name("N")
      ->check(whole_from(0, 256));
  add_set_option(*command, arguments->stage.load.sets);
  add_allow_path_option(*command, arguments->stage.load);
  command_line::set_help_end(
      *command,
      {{"shoal motion stability vehicles/motions/ers7/wave.yaml --world ers7_studio",
        "shoal motion stability walk.yaml --world ers7_studio --every 0.1 --directions 4 --watch 1"},
       {{0, "it stands"}, {1, "it falls by itself"}, {2, "wrong usage or configuration"}},
       {"Copies of the world are pushed at each row, and the motion continues: it has fallen when it tilts by "
        "more than 45 degrees or its first body touches the ground."}});
  command->callback([arguments, &exit_code] { exit_code = stability(*arguments); });
}

}  // namespace tools
