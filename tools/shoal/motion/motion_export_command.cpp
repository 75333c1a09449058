// SPDX-License-Identifier: BSD-3-Clause
#include <spdlog/fmt/fmt.h>

#include <filesystem>
#include <iostream>
#include <memory>

#include "sim/config/message_text.hpp"
#include "tools/shoal/motion/format_options.hpp"
#include "tools/shoal/motion/motion_commands.hpp"

namespace tools {

namespace {

struct ExportArguments : FormatArguments {
  double at_s = 0;
  bool has_instant = false;
  std::string skill;
};

const motion::MotionFormat& format_of(const ExportArguments& arguments) {
  const motion::MotionFormat* const format = arguments.format.empty()
                                                 ? motion::motion_format_of_file(arguments.output, "")
                                                 : motion::find_motion_format(arguments.format);
  if (format == nullptr)
    throw CLI::ValidationError(
        "--format", "is needed, because '" + arguments.output + "' does not have the ending of a known format");
  return *format;
}

/// Throws when the folder of an export cannot be made, or has one of its files without --overwrite.
void check_folder(const ExportArguments& arguments, const std::vector<motion::ExportedFile>& files) {
  std::error_code error;
  std::filesystem::create_directories(arguments.output, error);
  if (!std::filesystem::is_directory(arguments.output, error))
    throw CLI::ValidationError("--output",
                               "must be a folder for this format, and '" + arguments.output + "' cannot be made");
  for (const motion::ExportedFile& file : files) check_output(arguments, arguments.output + "/" + file.name);
}

int export_motion(ExportArguments& arguments) {
  const motion::MotionFormat& format = format_of(arguments);
  if (format.write_folder == nullptr) check_output(arguments, arguments.output);
  const sim::JointMotion motion = sim::load_motion(arguments.input);
  const motion::JointNames names = names_for(arguments, motion.vehicle);
  motion::FormatOptions& options = arguments.options;
  options.loop_step_s = arguments.loop_step_ms / 1000;
  options.row_s = arguments.row_ms / 1000;
  if (arguments.has_instant) options.at_s = arguments.at_s;
  if (!arguments.skill.empty())
    options.skill = arguments.skill == "posture" ? motion::SkillKind::posture
                    : arguments.skill == "gait"  ? motion::SkillKind::gait
                                                 : motion::SkillKind::behavior;
  motion::Losses losses;
  const std::vector<motion::ExportedFile> files = motion::files_of_motion(format, motion, names, options, losses);
  if (!may_lose(arguments, losses)) return exit_failed;
  if (format.write_folder != nullptr) check_folder(arguments, files);
  std::size_t bytes = 0;
  for (const motion::ExportedFile& file : files) {
    write_bytes(file.name.empty() ? arguments.output : arguments.output + "/" + file.name, file.bytes);
    bytes += file.bytes.size();
  }
  fmt::print("{}: {}, {} bytes, {} joints, {} s\n", arguments.output, format.meaning, bytes, motion.tracks().size(),
             sim::number_text(motion.end_s()));
  return exit_ok;
}

}  // namespace

void add_motion_export_command(CLI::App& motion, int& exit_code) {
  CLI::App* command = motion.add_subcommand("export", "Write a motion in the format of another program");
  const auto arguments = std::make_shared<ExportArguments>();
  add_log_level_option(*command);
  command->add_option("MOTION", arguments->input, "motion file")->required();
  add_format_options(*command, *arguments);
  command->get_option("--name")->description(
      "play_motion2, mtn, openr-c, openr, opencat: name of the motion in the file");
  // Options of single formats.
  CLI::Option* at = command->add_option("--at", arguments->at_s, "pos, opencat: instant of the posture");
  at->type_name("S")->check(number_from(0, sim::max_motion_s).description(""));
  command->add_option("--creator", arguments->options.creator, "mtn: name of the creator")
      ->type_name("NAME")
      ->capture_default_str();
  command
      ->add_option("--design", arguments->options.design,
                   "mtn: design label of the robot; unset: by the names of joints")
      ->type_name("LABEL");
  command->add_option("--skill", arguments->skill, "opencat: posture, gait or behavior; unset: by the motion")
      ->type_name("KIND")
      ->check(one_of({"posture", "gait", "behavior"}).description(""));
  command_line::set_help_end(*command, {{"shoal motion export wave.yaml --format mtn --output wave.mtn",
                                         "shoal motion export trot.yaml --output trot.motion --loop-step-ms 16",
                                         "shoal motion export wave.yaml --vehicle ers7 --output wave.mot --strict",
                                         "shoal motion export wave.yaml --format openr --output wave_object"},
                                        {{0, "success"},
                                         {1, "with --strict: part of the motion cannot be kept"},
                                         {2, "wrong usage, or the format cannot hold the motion"},
                                         {4, "file error"}},
                                        {formats_text(false),
                                         "Whatever the file cannot hold is printed, each on its own line.  "
                                         "docs/guides/motion_formats.md describes the formats."}});
  command->callback([arguments, at, &exit_code] {
    arguments->has_instant = at->count() > 0;
    exit_code = export_motion(*arguments);
  });
}

}  // namespace tools
