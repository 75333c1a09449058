// SPDX-License-Identifier: BSD-3-Clause
#include "tools/shoal/motion/motion_output.hpp"

#include <spdlog/fmt/fmt.h>

#include <algorithm>
#include <filesystem>

#include "experiment/files/file_replacement.hpp"
#include "motion/analysis/motion_file.hpp"
#include "sim/config/message_text.hpp"
#include "tools/shoal/options/shared_options.hpp"

namespace tools {

namespace {

void refuse(const std::string& frames, const std::string& path, bool overwrite) {
  if (overwrite || frames.empty()) return;
  throw command_line::UsageError("'" + frames + "' exists and does not belong to '" + path +
                                 "'; --overwrite replaces it");
}

}  // namespace

void add_overwrite_option(CLI::App& command, bool& overwrite) {
  command.add_flag("--overwrite", overwrite, "replace existing files");
}

void check_new_file(const std::string& path, bool overwrite) {
  std::error_code error;
  if (!overwrite && std::filesystem::exists(path, error))
    throw command_line::UsageError("'" + path + "' exists; --overwrite replaces it");
  check_writable(path);
  if (std::filesystem::path(path).extension() == ".csv")
    throw command_line::UsageError("'" + path + "' must not end in .csv: that is the file of the frames of a motion");
  experiment::check_whole_file(path);
}

void check_frames(const std::string& path, const sim::JointMotion& motion, bool overwrite) {
  const std::string frames = motion::foreign_frames(path, motion);
  refuse(frames, path, overwrite);
  if (!frames.empty()) experiment::check_whole_file(frames);
}

void check_frames(const std::string& path, bool overwrite) {
  refuse(motion::foreign_frames(path), path, overwrite);
}

std::string operation_of(const CLI::App& command) {
  std::string text = command.get_name();
  for (const CLI::Option* option : command.get_options()) {
    const std::string name = option->get_name();
    if (option->count() == 0 || name == "FILE" || name == "--output" || name == "--overwrite" || name == "--log-level")
      continue;
    if (!option->get_positional()) text += " " + name;
    if (option->get_items_expected_max() == 0) continue;  // a flag
    const char between = option->get_delimiter() == '\0' ? ' ' : option->get_delimiter();
    std::string values;
    for (const std::string& value : option->results()) values += (values.empty() ? ' ' : between) + value;
    text += values;
  }
  return sim::shortened(sim::printable(text), 200);
}

std::string content_text(const sim::JointMotion& motion) {
  const auto counted = [](std::size_t count, const char* word) {
    return fmt::format("{} {}{}", count, word, count == 1 ? "" : "s");
  };
  const std::vector<sim::MotionTrack> tracks = motion.tracks();
  const auto lights = static_cast<std::size_t>(
      std::count_if(tracks.begin(), tracks.end(), [&](const auto& track) { return motion.is_light(track.joint); }));
  std::string text = fmt::format("{:.3f} s, {}", motion.end_s(), counted(tracks.size() - lights, "joint"));
  if (lights > 0) text += ", " + counted(lights, "light");
  if (!motion.keys.empty()) text += ", " + counted(motion.keys.size(), "key");
  if (!motion.frames.empty()) text += ", " + counted(motion.frames.front().keys.size(), "frame");
  if (!motion.sounds.empty()) text += ", " + counted(motion.sounds.size(), "sound");
  if (!motion.changes.empty()) text += ", " + counted(motion.changes.size(), "change");
  return text;
}

}  // namespace tools
