// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <iostream>
#include <memory>
#include <numbers>

#include "sim/config/message_text.hpp"
#include "sim/motion/motion_frames.hpp"
#include "tools/shoal/motion/motion_commands.hpp"

namespace tools {

namespace {

struct ShowArguments {
  std::string file;
  bool frames = false;
};

void show(const ShowArguments& arguments) {
  const sim::JointMotion motion = motion_of(arguments.file);
  const std::vector<sim::MotionTrack> tracks = motion.tracks();
  if (arguments.frames) {
    std::cout << sim::motion_frames_text(sim::sampled(tracks, motion.end_s(), motion.frame_s));
    return;
  }
  const auto counted = [](std::size_t count, const char* word) {
    return fmt::format("{} {}{}", count, word, count == 1 ? "" : "s");
  };
  const auto lights = static_cast<std::size_t>(
      std::count_if(tracks.begin(), tracks.end(), [&](const auto& track) { return motion.is_light(track.joint); }));
  const std::string joints =
      counted(tracks.size() - lights, "joint") + (lights > 0 ? ", " + counted(lights, "light") : "");
  std::cout << fmt::format("motion '{}'{}: {:.3f} s, {}, {}, {}, frames of {} ms{}\n", sim::printable(motion.name),
                           motion.vehicle.empty() ? "" : " of " + sim::printable(motion.vehicle), motion.end_s(),
                           joints, counted(motion.keys.size(), "key"), counted(motion.poses.size(), "pose"),
                           motion.frame_s * 1000, motion.loop ? ", a loop" : "");
  std::cout << fmt::format("  {:<24} {:>6} {:>10} {:>10} {:>12}\n", "joint", "keys", "least", "greatest", "fastest");
  for (const sim::MotionTrack& track : tracks) {
    const auto frames = sim::sampled({track}, motion.end_s(), motion.frame_s).front().keys;
    double lowest = frames.front().value, greatest = lowest, fastest = 0;
    for (std::size_t i = 0; i < frames.size(); ++i) {
      lowest = std::min(lowest, frames[i].value);
      greatest = std::max(greatest, frames[i].value);
      if (i > 0) fastest = std::max(fastest, std::abs(frames[i].value - frames[i - 1].value) / motion.frame_s);
    }
    const bool is_slider = motion.unit_of(track.joint) == 1 && motion.angles == sim::AngleUnit::deg;
    const double unit = is_slider || motion.is_light(track.joint) ? 1 : std::numbers::pi / 180;
    std::cout << fmt::format("  {:<24} {:>6} {:>10.2f} {:>10.2f} {:>10.2f}/s\n", sim::printable(track.joint),
                             track.keys.size(), lowest / unit, greatest / unit, fastest / unit);
  }
  for (const sim::MotionSound& sound : motion.sounds)
    std::cout << fmt::format("  sound {:<18} at {:.3f} s, volume {:.2f}\n", sim::printable(sound.sound), sound.at_s,
                             sound.volume);
  std::cout << (motion.sliders.empty() ? "  values in deg" : "  values in deg, of sliders in m")
            << (motion.lights.empty() ? "\n" : ", of lights from 0 to 1\n");
}

}  // namespace

void add_motion_show_command(CLI::App& motion, int& exit_code) {
  CLI::App* command = motion.add_subcommand("show", "Show joints, times and speeds of a motion");
  const auto arguments = std::make_shared<ShowArguments>();
  add_log_level_option(*command);
  command->add_option("FILE", arguments->file, "motion file")->required();
  command->add_flag("--frames", arguments->frames, "print the frames as CSV: t_s, then each joint in rad or m");
  command_line::set_help_end(*command, {{"shoal motion show vehicles/motions/ers7/wave.yaml",
                                         "shoal motion show wave.yaml --frames > wave.csv"},
                                        {{0, "success"}, {2, "wrong usage, or mistakes in the file"}},
                                        {}});
  command->callback([arguments, &exit_code] {
    show(*arguments);
    exit_code = exit_ok;
  });
}

}  // namespace tools
