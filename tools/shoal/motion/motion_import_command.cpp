// SPDX-License-Identifier: BSD-3-Clause
#include <spdlog/fmt/fmt.h>

#include <filesystem>
#include <iostream>
#include <memory>
#include <stdexcept>

#include "motion/analysis/motion_file.hpp"
#include "sim/base/whole_file.hpp"
#include "sim/config/message_text.hpp"
#include "sim/motion/motion_frames.hpp"
#include "tools/shoal/motion/format_options.hpp"
#include "tools/shoal/motion/motion_commands.hpp"

namespace tools {

namespace {

namespace fs = std::filesystem;

constexpr std::uintmax_t max_file_mb = 200, max_other_file_mb = 1;
constexpr std::size_t max_values_in_keys = 200'000;

std::string bytes_of(const std::string& path, std::uintmax_t max_mb) {
  try {
    return sim::whole_file<std::runtime_error>(path, max_mb);
  } catch (const std::runtime_error& error) {
    throw std::runtime_error(path + ": " + error.what());
  }
}

const motion::MotionFormat& format_of(const FormatArguments& arguments, const std::string& bytes) {
  const motion::MotionFormat* const format = arguments.format.empty()
                                                 ? motion::motion_format_of_file(arguments.input, bytes)
                                                 : motion::find_motion_format(arguments.format);
  if (format == nullptr)
    throw CLI::ValidationError("--format", "is needed, because '" + arguments.input + "' shows no format");
  return *format;
}

/// Moves the keys of a long motion into frames, which are in their own file.
void make_frames_of_many_keys(sim::JointMotion& motion, motion::Losses& losses) {
  std::size_t values = 0;
  bool has_notes = false, is_linear = motion.ease == sim::Easing::linear;
  for (const sim::MotionKey& key : motion.keys) {
    values += key.joints.size();
    has_notes = has_notes || !key.note.empty();
    is_linear = is_linear && key.ease.value_or(sim::Easing::linear) == sim::Easing::linear;
  }
  if (values <= max_values_in_keys || !is_linear) return;
  std::vector<sim::MotionTrack> tracks = motion.tracks();
  std::vector<sim::MotionTrack> frames;
  for (const sim::MotionTrack& track : tracks) {
    frames.push_back({track.joint, {}});
    for (const sim::MotionKey& key : motion.keys)
      frames.back().keys.push_back({key.at_s, track.value_at(key.at_s), sim::Easing::linear});
  }
  if (has_notes) losses.push_back("notes are not kept in a file of frames");
  motion.frames = std::move(frames);
  motion.keys.clear();
}

/// Writes the file of frames beside the motion file, unless it is the file that was read.
void write_frames(const FormatArguments& arguments, const std::vector<sim::MotionTrack>& frames) {
  const fs::path path = fs::path(arguments.output).replace_extension(".csv");
  std::error_code error;
  if (fs::equivalent(path, arguments.input, error)) return;
  check_output(arguments, path.string());
  write_bytes(path.string(), sim::motion_frames_text(frames));
}

int import_motion(FormatArguments& arguments) {
  check_output(arguments, arguments.output);
  const std::string bytes = bytes_of(arguments.input, max_file_mb);
  const motion::MotionFormat& format = format_of(arguments, bytes);
  const motion::JointNames names = names_for(arguments, "");
  arguments.options.loop_step_s = arguments.loop_step_ms / 1000;
  arguments.options.row_s = arguments.row_ms / 1000;
  const fs::path folder = fs::path(arguments.input).parent_path();
  const auto read_other = [&](const std::string& name) {
    return sim::whole_file<std::runtime_error>((folder / name).string(), max_other_file_mb);
  };
  motion::Losses losses;
  sim::JointMotion motion =
      motion::motion_of_bytes(format, {bytes, arguments.input, names, arguments.options, read_other}, losses);
  make_frames_of_many_keys(motion, losses);
  if (!may_lose(arguments, losses)) return exit_failed;
  if (!motion.frames.empty())
    motion.frames_file = fs::path(arguments.output).replace_extension(".csv").filename().string();
  // The file is read again as text before it is written: a motion that Shoal itself refuses must not be left behind.
  try {
    motion::check_readable(arguments.output, motion);
  } catch (const motion::EditError& error) {
    throw sim::ConfigError({error.what()});
  }
  if (!motion.frames.empty()) write_frames(arguments, motion.frames);
  write_bytes(arguments.output, sim::motion_text(motion));
  if (motion.vehicle.empty() && !arguments.keep_names)
    std::cerr << arguments.output << ": names no vehicle, and its joints have the names in " << arguments.input
              << "; --vehicle VEHICLE converts them\n";
  fmt::print("{}: motion '{}' from {}, {} joints, {} s\n", arguments.output, motion.name, format.meaning,
             motion.tracks().size(), sim::number_text(motion.end_s()));
  return exit_ok;
}

}  // namespace

void add_motion_import_command(CLI::App& motion, int& exit_code) {
  CLI::App* command = motion.add_subcommand("import", "Read a motion in the format of another program");
  const auto arguments = std::make_shared<FormatArguments>();
  add_log_level_option(*command);
  command->add_option("FILE", arguments->input, "file of the other program")->required();
  add_format_options(*command, *arguments);
  command->get_option("--name")->description("play_motion2, opencat: which of several motions in the file to read");
  command_line::set_help_end(
      *command,
      {{"shoal motion import wave.mtn --vehicle ers7 --output wave.yaml",
        "shoal motion import walk.yaml --format ros --output walk_motion.yaml",
        "shoal motion import skills.h --format opencat --name hi --vehicle bittle --output hi.yaml"},
       {{0, "success"},
        {1, "with --strict: part of the file cannot be kept"},
        {2, "wrong usage, or an error in the file"},
        {4, "file error"}},
       {formats_text(true),
        "Errors are printed as file:line:column: rule, value; in binary files with the byte number.   "
        "Whatever the motion cannot hold of the file is printed, each on its own line.  docs/guides/motion_formats.md "
        "describes the formats."}});
  command->callback([arguments, &exit_code] { exit_code = import_motion(*arguments); });
}

}  // namespace tools
