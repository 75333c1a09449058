// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <filesystem>
#include <iostream>
#include <memory>
#include <numbers>

#include "sim/config/message_text.hpp"
#include "tools/experiment/motion/motion_stage.hpp"
#include "tools/experiment/motion/motion_tracking.hpp"
#include "tools/experiment/motion_record/embedded_world.hpp"
#include "tools/experiment/world_files/world_by_name.hpp"
#include "tools/shoal/motion/motion_commands.hpp"

namespace tools {

namespace {

constexpr double max_snapshots = 14'400;  // four in a second of an hour

struct PlayArguments {
  std::string file;
  StageOptions stage;
  double from_s = 0, settle_s = 1, loop_s = 10;
  bool again = false;
};

/// Prints whether the state at the end is that of the recording; returns false when it should be and is not.
bool report_recording(const sim::MotionOrigin& origin, std::uint64_t hash, const StageOptions& stage,
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
  std::cout << (is_same ? "the state at the end is that of the recording\n"
                        : "the state at the end is another one than that of the recording\n");
  return is_same;
}

/// Where the player is.
std::string phase_text(const MotionStage& stage) {
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
void choose_world(StageOptions& stage, const sim::JointMotion& motion, const std::string& file) {
  StageOptions embedded = stage;
  const bool is_embedded = use_embedded_world(embedded, motion, file);
  if (!stage.world.empty())
    stage.world = file_by_name({ShippedKind::world}, stage.world);
  else if (is_embedded)
    stage = std::move(embedded);
  else
    throw command_line::UsageError("needs --world: '" + file + "' holds no world (motion record --embed)");
  if (is_embedded)
    std::cout << (stage.tree ? "world: the one embedded in " + file
                             : "world: " + stage.world + ", not the embedded one")
              << '\n';
}

int play(PlayArguments arguments) {
  const sim::JointMotion motion = motion_of(arguments.file);
  if (arguments.again && !(arguments.from_s >= 0 && arguments.from_s <= motion.end_s()))
    throw command_line::UsageError("--again-from must be from 0 to " + sim::number_text(motion.end_s()) +
                                   " s, the end of the motion, got " + sim::number_text(arguments.from_s));
  // Snapshots are needed to go back only, and a long motion has fewer of them.
  if (!arguments.again) arguments.stage.kept_s = 0;
  arguments.stage.snapshot_s = std::max(arguments.stage.snapshot_s, motion.end_s() / max_snapshots);
  choose_world(arguments.stage, motion, arguments.file);
  MotionStage stage(arguments.stage, motion);
  MotionTracking tracking;
  stage.after_step = [&](MotionStage& now) { tracking.add(now); };
  const double max_s = motion.loop ? arguments.loop_s : end_limit_s(motion);
  const bool has_ended = stage.play_out(0, max_s) || motion.loop;
  const std::uint64_t end_hash = stage.state_hash();
  const double played_s = stage.now_s();
  if (!has_ended) {
    std::cout << tracking.text(motion);
    std::cout << fmt::format("the motion has not ended after {:.3f} s: {}\n", played_s, phase_text(stage));
    return exit_failed;
  }
  stage.play_out(arguments.settle_s, motion.loop ? max_s : played_s + arguments.settle_s);
  std::cout << tracking.text(motion);
  std::cout << fmt::format("{:.3f} s simulated, state hash at the end of the motion {:016x}\n", played_s, end_hash);
  if (stage.now_s() > played_s)
    std::cout << fmt::format("{:.3f} s simulated, state hash after {} s of settling {:016x}\n", stage.now_s(),
                             sim::number_text(arguments.settle_s), stage.state_hash());
  bool is_equal = true;
  if (arguments.again) {
    // From an instant of the motion, by the last snapshot before it.
    const std::uint64_t hash = stage.state_hash();
    const double end_s = stage.now_s();
    stage.after_step = {};
    if (stage.time_of(arguments.from_s) > end_s + 1e-9)
      throw command_line::UsageError("--again-from: " + sim::number_text(arguments.from_s) +
                                     " s of the motion are not reached in --loop-time " +
                                     sim::number_text(arguments.loop_s));
    stage.go_to(stage.time_of(arguments.from_s));
    const double from_s = stage.now_s();
    stage.go_to(end_s);
    is_equal = stage.state_hash() == hash;
    std::cout << fmt::format("again from {:.3f} s: {}\n", from_s,
                             is_equal ? "the same state at the end" : "another state at the end");
  }
  if (motion.recorded && !motion.recorded->state_hash.empty()) {
    const std::string& name = stage.world().config().name;
    const std::string world = name.empty() ? std::filesystem::path(arguments.stage.world).stem().string() : name;
    if (!report_recording(*motion.recorded, end_hash, arguments.stage, world)) return exit_failed;
  }
  return !is_equal || tracking.has_fallen() ? exit_failed : exit_ok;
}

}  // namespace

void add_motion_play_command(CLI::App& motion, int& exit_code) {
  CLI::App* command = motion.add_subcommand("play", "Play a motion in a world, and say how the joints follow");
  const auto arguments = std::make_shared<PlayArguments>();
  add_log_level_option(*command, "warn");
  command->add_option("FILE", arguments->file, "motion file")->required();
  add_stage_options(*command, arguments->stage.world, arguments->stage.vehicle);
  command->get_option("--world")->required(false)->description(
      "world with a vehicle that has a motion_player; unset: the one that the take holds");
  CLI::Option* from = command
                          ->add_option("--again-from", arguments->from_s,
                                       "then play again from this time of the motion, and compare the states")
                          ->type_name("S");
  command->add_option("--settle", arguments->settle_s, "simulated time after the motion, s; usual 1")
      ->type_name("S")
      ->check(number_from(0, 600));
  command->add_option("--loop-time", arguments->loop_s, "simulated time in all of a motion that loops, s; usual 10")
      ->type_name("S")
      ->check(number_from(0.01, sim::max_motion_s));
  add_set_option(*command, arguments->stage.load.sets);
  add_allow_path_option(*command, arguments->stage.load);
  command_line::set_help_end(
      *command, {{"shoal motion play vehicles/motions/ers7/wave.yaml --world ers7_studio",
                  "shoal motion play wave.yaml --world ers7_studio --again-from 1.5"},
                 {{0, "played to its end"},
                  {1, "the vehicle has fallen, or the state is not that of the recording or of --again-from"},
                  {2, "wrong usage or configuration"}},
                 {"To see it: shoal run WORLD --view, with the motion among the `motions` of its player."}});
  command->callback([arguments, from, &exit_code] {
    arguments->again = from->count() > 0;
    exit_code = play(*arguments);
  });
}

}  // namespace tools
