// SPDX-License-Identifier: BSD-3-Clause
#include <unistd.h>

#include <iostream>
#include <memory>

#include "experiment/drive/drive_profile.hpp"
#include "experiment/study/study_config.hpp"
#include "shoal/message_schema.hpp"
#include "sim/base/text_layout.hpp"
#include "sim/config/message_text.hpp"
#include "sim/device/device_registry.hpp"
#include "sim/motion/motion.hpp"
#include "sim/program/find_program.hpp"
#include "tools/command_line/completion.hpp"
#include "tools/shoal/commands/commands.hpp"
#include "tools/shoal/reference/json_schema.hpp"
#include "tools/shoal/reference/reference_pages.hpp"

namespace tools {

namespace {

std::string unknown_name(const std::string& name) {
  std::vector<std::string> known = {"device", "noise", "world", "vehicle", "study", "motion", "metrics"};
  for (const sim::DeviceType* type : sim::DeviceRegistry::instance().all()) known.push_back(type->name);
  for (const auto& [message, schema] : shoal::embedded_types().all())
    known.push_back(message.substr(message.find('.') + 1));
  if (const auto folders = sim::program_folders(); !folders.empty())
    for (const std::string& program : sim::declared_programs(folders.front())) known.push_back(program);
  const std::string meant = sim::closest_name(name, known);
  return "unknown name '" + sim::shortened(sim::printable(name)) + "'; " +
         (meant.empty() ? "see `shoal list devices` and `shoal list messages`" : "did you mean '" + meant + "'?");
}

/// Returns the completion of the whole command line for a shell.
std::string completion_of(const CLI::App& app, const std::string& shell) {
  // A name is the first word of a row; rows of text below it are indented further.
  const auto names = [](const std::string& what) {
    return "shoal list " + what + " 2>/dev/null | sed -n \"s/^ *\\([a-z0-9_]*\\)  .*/\\1/p\"";
  };
  const command_line::WordCommands commands = {
      {"WORLD", names("worlds")}, {"VEHICLE", names("vehicles")}, {"STUDY", names("studies")}};
  return shell == "bash" ? command_line::bash_completion(app, commands) : command_line::zsh_completion(app, commands);
}

std::string schema_of(const std::string& file) {
  if (file == "study") return study_schema(params_of<experiment::StudyConfig>());
  if (file == "motion") return motion_schema(params_of<sim::JointMotion>());
  if (file == "drive") return drive_schema(params_of<experiment::DriveProfile>());
  return json_schema(file);
}

}  // namespace

static void add_describe_command(CLI::App& app, int& exit_code) {
  CLI::App* command = app.get_subcommand("describe");
  add_log_level_option(*command);
  const auto name = std::make_shared<std::string>();
  const auto page = std::make_shared<std::string>();
  const auto schema = std::make_shared<std::string>();
  const auto shell = std::make_shared<std::string>();
  // Options that exclude each other.
  CLI::Option* name_option = command->add_option(
      "NAME", *name,
      "a device type, a message type, a program, a key of world or vehicle files, or one of: device, noise, world, "
      "vehicle, study, motion, metrics");
  CLI::Option* page_option = command->add_option("--page", *page, "print a whole page of docs/ in Markdown")
                                 ->type_name("PAGE")
                                 ->check(one_of({"devices", "messages", "metrics", "programs", "world_format"}));
  CLI::Option* schema_option = command->add_option("--schema", *schema, "print the JSON Schema of a file's keys")
                                   ->type_name("FILE")
                                   ->check(one_of({"world", "vehicle", "study", "motion", "drive"}));
  CLI::Option* shell_option =
      command->add_option("--completion", *shell, "print the completion of this program's command line for a shell")
          ->type_name("SHELL")
          ->check(one_of({"bash", "zsh"}));
  name_option->excludes(page_option)->excludes(schema_option)->excludes(shell_option);
  page_option->excludes(schema_option)->excludes(shell_option);
  schema_option->excludes(shell_option);
  add_plugin_option(*command);
  command_line::set_help_end(
      *command,
      {{"shoal describe lidar", "shoal describe world", "shoal describe metrics", "shoal describe processes",
        "shoal describe pose_t", "shoal describe shoal-coop-rover", "shoal describe --schema world > world.schema.json",
        "shoal describe --completion bash > shoal.bash", "shoal describe thermometer --plugin build/thermometer.so"},
       {{0, "success"}, {2, "wrong usage, or an unknown name"}},
       {}});
  command->callback([&app, name, page, schema, shell, &exit_code] {
    // Page, schema or completion.
    if (!shell->empty()) {
      complete_commands(app, exit_code);
      std::cout << completion_of(app, *shell);
      return;
    }
    if (!page->empty() || !schema->empty()) {
      if (!page->empty())
        std::cout << reference_page(*page);
      else
        std::cout << schema_of(*schema);
      return;
    }
    // Text about a name.
    if (name->empty())
      throw command_line::UsageError("needs a NAME, --page, --schema or --completion; see `shoal list devices`");
    const auto columns = static_cast<std::size_t>(sim::text_columns(STDOUT_FILENO));
    const std::string text =
        *name == "study"    ? describe_keys("Keys of a study file.", params_of<experiment::StudyConfig>(), columns)
        : *name == "motion" ? describe_keys("Keys of a motion file.", params_of<sim::JointMotion>(), columns)
                            : describe_text(*name, columns);
    if (text.empty()) {
      throw command_line::UsageError(unknown_name(*name));
    }
    std::cout << text;
  });
}

SHOAL_COMMAND(make, "describe", "Describe a device, a message, a program or the keys of a file", add_describe_command);

}  // namespace tools
