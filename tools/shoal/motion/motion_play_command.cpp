// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <filesystem>
#include <iostream>
#include <limits>
#include <memory>

#include "experiment/process/browser.hpp"
#include "experiment/process/signals.hpp"
#include "experiment/world_files/world_by_name.hpp"
#include "motion/analysis/motion_stage.hpp"
#include "motion/analysis/motion_tracking.hpp"
#include "motion/record/embedded_world.hpp"
#include "sim/config/message_text.hpp"
#include "tools/shoal/motion/motion_commands.hpp"
#include "tools/shoal/motion/play_view.hpp"
#include "tools/shoal/options/shared_options.hpp"

namespace tools {

namespace {

constexpr double max_snapshots = 14'400;  // four in a second of an hour
constexpr double rewind_s = 60;           // by a page
constexpr double usual_loop_s = 10;

struct PlayArguments {
  std::string file;
  motion::StageOptions stage;
  experiment::ViewOptions view;
  std::optional<double> again_from_s, loop_s, rate;
  double settle_s = 1;
  bool loop = false, with_page = false, open = false;
  bool is_part() const { return stage.play.from_s || stage.play.to_s; }
};

/// Prints whether the final state equals that of the recording; returns false when it should be and is not.
bool report_recording(const sim::MotionOrigin& origin, std::uint64_t hash, const motion::StageOptions& stage,
                      const std::string& world) {
  if (origin.world != world) {
    std::cout << fmt::format("recorded in world '{}', so that the states at the end are not compared\n",
                             sim::printable(origin.world));
    return true;
  }
  const bool is_same = fmt::format("{:016x}", hash) == origin.state_hash;
  if (!is_same && origin.set != stage.load.sets) {
    std::string sets;
    for (const std::string& set : origin.set) sets += " --set '" + sim::printable(set) + "'";
    std::cout << "it was recorded " << (sets.empty() ? "without --set" : "with" + sets) << '\n';
  }
  std::cout << (is_same ? "the final state equals that of the recording\n"
                        : "the final state differs from that of the recording\n");
  return is_same;
}

/// Where the player is.
std::string phase_text(const motion::MotionStage& stage) {
  using Phase = devices::MotionPlayer::Phase;
  switch (stage.player().phase()) {
    case Phase::approach:
      return "it is still on the way to its first values";
    case Phase::paused:
      return "its player is paused";
    case Phase::playing:
    case Phase::idle:
      break;
  }
  return fmt::format("it is at {:.3f} s", stage.player().at_s());
}

/// Sets the world that the command line names, else that in the take, and prints which of them it is.
void choose_world(motion::StageOptions& stage, const sim::JointMotion& motion, const std::string& file) {
  if (stage.world.empty()) {
    if (!motion::use_embedded_world(stage, motion, file))
      throw command_line::UsageError("needs --world: '" + file + "' contains no world (motion record --embed)");
    std::cout << "world: the one embedded in " << file << '\n';
    return;
  }
  stage.world = experiment::file_by_name({experiment::ShippedKind::world}, stage.world);
  if (motion.recorded && motion.recorded->embedded_world.kind != sim::ConfigNode::Kind::null)
    std::cout << "world: " << stage.world << ", not the embedded one\n";
}

/// Throws command_line::UsageError for times that are not within the motion.
void check_times(const PlayArguments& arguments, const sim::JointMotion& motion) {
  const double end_s = motion.end_s();
  const double from_s = arguments.stage.play.from_s.value_or(0), to_s = arguments.stage.play.to_s.value_or(end_s);
  if (arguments.is_part() && !(from_s < to_s && to_s <= end_s))
    throw command_line::UsageError("--from and --to must be a part of the motion, from 0 to " +
                                   sim::number_text(end_s) + " s, got " + sim::number_text(from_s) + " to " +
                                   sim::number_text(to_s));
  if (arguments.again_from_s && !(*arguments.again_from_s >= from_s && *arguments.again_from_s <= to_s))
    throw command_line::UsageError(
        "--again-from must be from " + sim::number_text(from_s) + " to " + sim::number_text(to_s) +
        (arguments.is_part() ? " s, the part that is played, got " : " s, the end of the motion, got ") +
        sim::number_text(*arguments.again_from_s));
}

/// Plays again from an instant of the motion, by the last snapshot before it; returns whether the end is the same.
bool play_again(motion::MotionStage& stage, const PlayArguments& arguments) {
  const std::uint64_t hash = stage.state_hash();
  const double end_s = stage.now_s();
  stage.after_step = {};
  const double at_s = stage.time_of(*arguments.again_from_s);
  if (at_s > end_s + 1e-9)
    throw command_line::UsageError("--again-from: " + sim::number_text(*arguments.again_from_s) +
                                   " s of the motion are not reached in --loop-time " +
                                   sim::number_text(arguments.loop_s.value_or(usual_loop_s)));
  stage.go_to(at_s);
  const double from_s = stage.now_s();
  stage.go_to(end_s);
  const bool is_equal = stage.state_hash() == hash;
  std::cout << fmt::format("again from {:.3f} s: {}\n", from_s,
                           is_equal ? "the same final state" : "a different final state");
  return is_equal;
}

/// Prints whether the motion ends as its recording, if it is one; returns false when it should and does not.
bool check_recording(const sim::JointMotion& motion, motion::MotionStage& stage, std::uint64_t end_hash,
                     const PlayArguments& arguments) {
  if (!motion.recorded || motion.recorded->state_hash.empty()) return true;
  if (arguments.is_part() || arguments.loop) {
    std::cout << "not played from its start to its end once, so that the state is not compared with the recording\n";
    return true;
  }
  const std::string& name = stage.world().config().name;
  const std::string world = name.empty() ? std::filesystem::path(arguments.stage.world).stem().string() : name;
  return report_recording(*motion.recorded, end_hash, arguments.stage, world);
}

int play(PlayArguments arguments) {
  const sim::JointMotion motion = motion_of(arguments.file);
  check_times(arguments, motion);
  // Snapshots are needed to go back only, and a long motion has fewer of them.
  if (!arguments.again_from_s) arguments.stage.kept_s = arguments.with_page ? rewind_s : 0;
  const bool loops = motion.loop || arguments.loop;
  const double all_s = loops ? arguments.loop_s.value_or(usual_loop_s) : motion.end_s();
  arguments.stage.snapshot_s = std::max(arguments.stage.snapshot_s, all_s / max_snapshots);
  choose_world(arguments.stage, motion, arguments.file);
  arguments.stage.scores = arguments.with_page;
  if (arguments.loop) arguments.stage.play.repeat = -1;
  motion::MotionStage stage(arguments.stage, motion);
  motion::MotionTracking tracking;
  std::int64_t tracked_step = 0;
  stage.after_step = [&](motion::MotionStage& now) {
    if (now.world().step_number() <= tracked_step) return;  // a page went back
    tracked_step = now.world().step_number();
    tracking.add(now);
  };
  // Show it.
  experiment::Browser browser;
  if (arguments.open) arguments.view.opened = [&browser](const std::string& url) { browser.open(url); };
  std::optional<PlayView> view;
  if (arguments.with_page) {
    experiment::catch_signals(false);
    view.emplace(arguments.view, stage, arguments.rate.value_or(1));
    std::cerr << "live page: " << view->url() << "\nthe motion starts when the page is open; Ctrl-C ends it\n";
  }
  bool is_cut = false;
  const auto goes_on = [&] { return !(is_cut = view && !view->goes_on()); };
  // Play it to its end, then let it settle.
  const double loop_s = arguments.loop_s.value_or(view ? std::numeric_limits<double>::infinity() : usual_loop_s);
  const double max_s = loops ? loop_s : motion::end_limit_s(motion);
  const auto is_playing = [&] { return stage.player().phase() != devices::MotionPlayer::Phase::idle; };
  while (is_playing() && stage.now_s() < max_s && goes_on()) stage.play_step();
  const std::uint64_t end_hash = stage.state_hash();
  const double played_s = stage.now_s();
  if (is_cut || (is_playing() && !loops)) {
    std::cout << tracking.text(motion);
    std::cout << (is_cut ? fmt::format("ended after {:.3f} s: {}\n", played_s, phase_text(stage))
                         : fmt::format("the motion has not ended after {:.3f} s: {}\n", played_s, phase_text(stage)));
    return is_cut ? 128 + experiment::caught_signal() : exit_failed;
  }
  const double until_s = loops ? std::min(max_s, played_s + arguments.settle_s) : played_s + arguments.settle_s;
  while (stage.now_s() < until_s - 1e-9 && goes_on()) stage.play_step();
  // Report.
  std::cout << tracking.text(motion);
  if (is_cut) {
    std::cout << fmt::format("ended after {:.3f} s, while it settled\n", stage.now_s());
    return 128 + experiment::caught_signal();
  }
  std::cout << fmt::format("{:.3f} s simulated, state hash at the end of the motion {:016x}\n", played_s, end_hash);
  if (stage.now_s() > played_s)
    std::cout << fmt::format("{:.3f} s simulated, state hash after {} s of settling {:016x}\n", stage.now_s(),
                             sim::number_text(arguments.settle_s), stage.state_hash());
  const bool is_equal = !arguments.again_from_s || play_again(stage, arguments);
  if (!check_recording(motion, stage, end_hash, arguments)) return exit_failed;
  return !is_equal || tracking.has_fallen() ? exit_failed : exit_ok;
}

}  // namespace

void add_motion_play_command(CLI::App& motion, int& exit_code) {
  CLI::App* command = motion.add_subcommand("play", "Play a motion in a world, and report how well the joints follow");
  const auto arguments = std::make_shared<PlayArguments>();
  add_log_level_option(*command, "warn");
  command->add_option("FILE", arguments->file, "motion file")->required();
  add_stage_options(*command, arguments->stage.world, arguments->stage.vehicle);
  command->get_option("--world")->required(false)->description(
      "world with a vehicle that has a motion_player; unset: the one that the take holds");
  command->add_option("--from", arguments->stage.play.from_s, "start of the part that is played, s")
      ->type_name("S")
      ->check(number_from(0, sim::max_motion_s));
  command->add_option("--to", arguments->stage.play.to_s, "end of this part, s")
      ->type_name("S")
      ->check(number_from(0, sim::max_motion_s));
  command->add_flag("--loop", arguments->loop, "repeat it for --loop-time, or with --view until Ctrl-C");
  command->add_option("--settle", arguments->settle_s, "simulated time after the motion, s; default 1")
      ->type_name("S")
      ->check(number_from(0, 600));
  command
      ->add_option("--loop-time", arguments->loop_s,
                   "total simulated time of a motion that loops, s; default 10, unlimited with --view")
      ->type_name("S")
      ->check(number_from(0.01, sim::max_motion_s));
  CLI::Option* page = command->add_flag(
      "--view", arguments->with_page, "play it on a live 3-D page as soon as the page is open; its address is printed");
  command
      ->add_option("--rate", arguments->rate,
                   "with --view: simulated seconds per wall second; below 1: slow motion; default 1")
      ->type_name("R")
      ->check(number_from(0.01, 10))
      ->needs(page);
  command
      ->add_option("--again-from", arguments->again_from_s,
                   "then play again from this time of the motion, and compare the states")
      ->type_name("S")
      ->excludes(page);
  add_open_option(*command, arguments->open)->needs(page);
  add_page_options(*command, arguments->view);
  command->get_option("--view-port")->needs(page);
  add_set_option(*command, arguments->stage.load.sets);
  add_allow_path_option(*command, arguments->stage.load);
  command_line::set_help_end(
      *command, {{"shoal motion play vehicles/motions/ers7/wave.yaml --world ers7_studio",
                  "shoal motion play wave.yaml --world ers7_studio --view --from 1 --to 2.5 --loop --rate 0.25",
                  "shoal motion play wave.yaml --world ers7_studio --again-from 1.5"},
                 {{0, "played to its end"},
                  {1, "the vehicle has fallen, or the state is not that of the recording or of --again-from"},
                  {2, "wrong usage or configuration"},
                  {129, "ended by a signal, with --view; 130 and 143 the same"}},
                 {"The page can pause and step the motion, set its pace, and rewind it by up to 60 s."}});
  command->callback([arguments, &exit_code] { exit_code = play(*arguments); });
}

}  // namespace tools
