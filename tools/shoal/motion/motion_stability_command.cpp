// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <cmath>
#include <iostream>
#include <limits>
#include <memory>
#include <numbers>

#include "experiment/score/support.hpp"
#include "experiment/world_files/world_by_name.hpp"
#include "motion/analysis/push_trials.hpp"
#include "sim/config/message_text.hpp"
#include "tools/shoal/motion/motion_commands.hpp"

namespace tools {

namespace {

struct StabilityArguments {
  std::vector<std::string> files;
  motion::StageOptions stage;
  motion::PushOptions push;
  double every_s = 0, marginal_mps = 0.1, stable_mps = 0.4;
};

/// Class of a motion by the largest impulse per mass that it withstands everywhere.
const char* class_of(double withstood_mps, const StabilityArguments& arguments) {
  if (withstood_mps >= arguments.stable_mps) return "stable";
  return withstood_mps >= arguments.marginal_mps ? "marginal" : "unstable";
}

/// Margins of a step.
struct Margins {
  double at_s, static_m, zmp_m, capture_m;
};
constexpr double none = std::numeric_limits<double>::quiet_NaN();

/// A motion that was played once, with the margins of each step.
struct PlayedMotion {
  std::unique_ptr<motion::MotionStage> stage;
  std::vector<Margins> course;
  double start_s = 0;
  std::vector<double> instants_s;  ///< of the run, at which it is pushed: each key, or whole multiples of a period

  /// Returns the smallest margins from a time of the run until another one.
  Margins min_margins(double from_s, double until_s) const {
    Margins min{from_s, none, none, none};
    for (const Margins& one : course)
      if (one.at_s >= from_s - 1e-9 && one.at_s < until_s) {
        min.static_m = std::fmin(min.static_m, one.static_m);
        min.zmp_m = std::fmin(min.zmp_m, one.zmp_m);
        min.capture_m = std::fmin(min.capture_m, one.capture_m);
      }
    return min;
  }
};

PlayedMotion played_once(const StabilityArguments& arguments, const std::string& file, const sim::JointMotion& motion) {
  PlayedMotion played{std::make_unique<motion::MotionStage>(arguments.stage, motion), {}, 0, {}};
  motion::MotionStage& stage = *played.stage;
  stage.support();  // contacts are known from the next step on
  stage.after_step = [&](motion::MotionStage& now) {
    const auto support = now.support();
    played.course.push_back(
        support ? Margins{now.now_s(), support->static_margin_m, support->zmp_margin_m, support->capture_margin_m}
                : Margins{now.now_s(), none, none, none});
  };
  const double max_s = motion::end_limit_s(motion);
  while (stage.player().phase() == devices::MotionPlayer::Phase::approach && stage.now_s() < max_s)
    stage.go_to(stage.now_s() + sim::to_seconds(stage.world().step_time()));
  played.start_s = stage.time_of(0);
  const double rate = stage.player().rate();
  // The first round of a motion that loops.
  if (!stage.play_out(0, motion.loop ? played.start_s + motion.end_s() / rate : max_s) && !motion.loop)
    throw sim::ConfigError({fmt::format("{}: the motion has not ended after {:.0f} s of the run", file, max_s)});
  stage.after_step = {};
  if (arguments.every_s > 0)
    for (double t_s = 0; t_s <= motion.end_s() + 1e-9; t_s += arguments.every_s)
      played.instants_s.push_back(played.start_s + t_s / rate);
  else
    for (const sim::MotionKey& key : motion.keys) played.instants_s.push_back(played.start_s + key.at_s / rate);
  return played;
}

std::string degrees(double angle_rad) {
  return fmt::format("{:.0f} deg", angle_rad * 180 / std::numbers::pi);
}

/// Prints a row for each instant.
int print_table(const StabilityArguments& arguments, const sim::JointMotion& motion) {
  const PlayedMotion played = played_once(arguments, arguments.files.front(), motion);
  const std::vector<motion::PushMargin> margins =
      motion::push_margins(*played.stage, played.instants_s, arguments.push);
  std::cout << fmt::format("{:>8} {:>9} {:>9} {:>9} {:>10} {:>10} {:>9}\n", "motion s", "static mm", "zmp mm",
                           "capture mm", "push N s", "towards", "settle mm");
  double least_Ns = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < margins.size(); ++i) {
    const double until_s = i + 1 < margins.size() ? margins[i + 1].at_s : margins[i].at_s + 0.008;
    const Margins min = played.min_margins(margins[i].at_s, until_s);
    least_Ns = std::min(least_Ns, margins[i].least_Ns());
    // Where even the largest push is withstood, no direction is the worst.
    const bool beyond = margins[i].least_Ns() >= margins[i].mass_kg * arguments.push.greatest_mps;
    const std::string push = fmt::format("{}{:.3f}", beyond ? ">" : "", margins[i].least_Ns());
    std::cout << fmt::format("{:>8.3f} {:>9.1f} {:>9.1f} {:>10.1f} {:>10} {:>10} {:>9.1f}\n",
                             margins[i].at_s - played.start_s, min.static_m * mm, min.zmp_m * mm, min.capture_m * mm,
                             push, beyond ? "-" : degrees(margins[i].least_direction_rad()), margins[i].settle_m * mm);
  }
  const double mass_kg = margins.front().mass_kg;
  std::cout << fmt::format(
      "margins: least until the next row, of steps with three contacts or more (nan: none); static and capture are "
      "negative outside of the support; push: greatest impulse that the vehicle of {:.3f} kg withstands in the worst "
      "of {} directions, at the center of mass of its first body, up to {:.3f} N s\n{}: {}\n",
      mass_kg, arguments.push.directions, mass_kg * arguments.push.greatest_mps, motion.name,
      class_of(least_Ns / mass_kg, arguments));
  return least_Ns <= 0 ? exit_failed : exit_ok;
}

/// Returns the instants that are half a second or more after the one before: a push lasts as long until it is over.
std::vector<double> apart(const std::vector<double>& instants_s) {
  std::vector<double> some;
  for (const double at_s : instants_s)
    if (some.empty() || at_s - some.back() >= 0.5 - 1e-9) some.push_back(at_s);
  return some;
}

/// Prints a line for each motion.
int print_classes(const StabilityArguments& arguments, const std::vector<sim::JointMotion>& motions) {
  std::cout << fmt::format("{:<20} {:<8} {:>9} {:>9} {:>9} {:>10} {:>9} {:>10}\n", "motion", "class", "push m/s",
                           "push N s", "motion s", "towards", "static mm", "capture mm");
  motion::PushOptions push = arguments.push;
  push.greatest_mps = std::min(push.greatest_mps, 3 * arguments.stable_mps);
  bool any_falls = false, any_refused = false;
  for (std::size_t i = 0; i < motions.size(); ++i) {
    const std::string& name = motions[i].name;
    try {
      const PlayedMotion played = played_once(arguments, arguments.files[i], motions[i]);
      const motion::WeakestPush weakest = motion::weakest_push(*played.stage, apart(played.instants_s), push);
      const Margins min = played.min_margins(played.start_s, std::numeric_limits<double>::infinity());
      any_falls = any_falls || weakest.falls;
      const char* const beyond = weakest.is_beyond ? ">" : "";
      std::cout << fmt::format("{:<20} {:<8} {:>9} {:>9} {:>9} {:>10} {:>9.1f} {:>10.1f}{}\n", name,
                               class_of(weakest.withstood_mps, arguments),
                               fmt::format("{}{:.3f}", beyond, weakest.withstood_mps),
                               fmt::format("{}{:.3f}", beyond, weakest.mass_kg * weakest.withstood_mps),
                               weakest.is_beyond ? "-" : fmt::format("{:.3f}", weakest.at_s - played.start_s),
                               weakest.is_beyond || weakest.falls ? "-" : degrees(weakest.direction_rad),
                               min.static_m * mm, min.capture_m * mm, weakest.falls ? "  falls by itself" : "")
                << std::flush;
    } catch (const sim::ConfigError& error) {
      any_refused = true;
      std::cout << fmt::format("{:<20} cannot be played\n", name) << std::flush;
      for (const std::string& line : error.lines()) std::cerr << line << '\n';
    }
  }
  std::cout << fmt::format(
      "push: greatest impulse that the vehicle withstands at all rows in {} directions, over its mass and in all; "
      "stable: from {} m/s; marginal: from {} m/s\n",
      arguments.push.directions, sim::number_text(arguments.stable_mps), sim::number_text(arguments.marginal_mps));
  return any_refused ? exit_usage : any_falls ? exit_failed : exit_ok;
}

int stability(StabilityArguments arguments) {
  if (arguments.marginal_mps > arguments.stable_mps)
    throw command_line::UsageError("--marginal must be at most --stable, " + sim::number_text(arguments.stable_mps) +
                                   ", got " + sim::number_text(arguments.marginal_mps));
  if (arguments.push.greatest_mps < arguments.stable_mps)
    throw command_line::UsageError("--greatest must be at least --stable, " + sim::number_text(arguments.stable_mps) +
                                   ", got " + sim::number_text(arguments.push.greatest_mps));
  std::vector<sim::JointMotion> motions;
  for (const std::string& file : arguments.files) {
    motions.push_back(motion_of(file));
    const bool has_frames = !motions.back().frames.empty();
    // Frames are too many for a row each, and without keys there are no times.
    if ((motions.back().keys.empty() || has_frames) && arguments.every_s <= 0)
      throw command_line::UsageError(file + ": the motion has " + (has_frames ? "frames" : "no keys") +
                                     ": give the times with --every");
  }
  arguments.stage.world = experiment::file_by_name({experiment::ShippedKind::world}, arguments.stage.world);
  return motions.size() == 1 ? print_table(arguments, motions.front()) : print_classes(arguments, motions);
}

}  // namespace

void add_motion_stability_command(CLI::App& motion, int& exit_code) {
  CLI::App* command = motion.add_subcommand("stability", "Measure how safely a vehicle stands during a motion");
  const auto arguments = std::make_shared<StabilityArguments>();
  add_log_level_option(*command, "warn");
  command->add_option("FILE", arguments->files, "motion files; several: a line and a class for each")->required();
  add_stage_options(*command, arguments->stage.world, arguments->stage.vehicle);
  command->add_option("--every", arguments->every_s, "time between two rows, s; unset: a row for each key")
      ->type_name("S")
      ->check(number_from(0.001, 3600));
  command->add_option("--directions", arguments->push.directions, "number of push directions; default 8")
      ->type_name("N")
      ->check(whole_from(1, 64));
  command->add_option("--watch", arguments->push.watch_s, "time after a push in which it may fall, s; default 2")
      ->type_name("S")
      ->check(number_from(0.01, 60));
  command->add_option("--greatest", arguments->push.greatest_mps, "largest impulse per mass, m/s; default 6")
      ->type_name("MPS")
      ->check(number_from(0.02, 100));
  command
      ->add_option("--stable", arguments->stable_mps,
                   "impulse per mass that a stable motion withstands everywhere, m/s; default 0.4")
      ->type_name("MPS")
      ->check(number_from(0.02, 100));
  command
      ->add_option("--marginal", arguments->marginal_mps,
                   "the same for a marginal motion; below it a motion is unstable, m/s; default 0.1")
      ->type_name("MPS")
      ->check(number_from(0.02, 100));
  command
      ->add_option("--threads", arguments->push.threads,
                   "number of threads; 0: one per processor; does not change the results")
      ->type_name("N")
      ->check(whole_from(0, 256));
  add_set_option(*command, arguments->stage.load.sets);
  add_allow_path_option(*command, arguments->stage.load);
  command_line::set_help_end(
      *command,
      {{"shoal motion stability vehicles/motions/ers7/wave.yaml --world ers7_studio",
        "shoal motion stability vehicles/motions/ers7/*.yaml --world ers7_studio",
        "shoal motion stability walk.yaml --world ers7_studio --every 0.1 --directions 4 --watch 1"},
       {{0, "it stands"},
        {1, "a vehicle falls without a push"},
        {2, "wrong usage or configuration; one cannot be played"}},
       {"The vehicle is pushed in copies of the world at each row, and the motion continues: it has fallen when it "
        "tilts by "
        "more than 45 degrees or its first body touches the ground.",
        "Class: stable, marginal or unstable, by the weakest push that makes it fall at any row in any direction.  "
        "Lines of several motions have rows that are half a second or more apart, and pushes up to three times "
        "--stable.  The default thresholds are meant for the ERS-7: docs/guides/motions.md gives the reasons."}});
  command->callback([arguments, &exit_code] { exit_code = stability(*arguments); });
}

}  // namespace tools
