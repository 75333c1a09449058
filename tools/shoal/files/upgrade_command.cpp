// SPDX-License-Identifier: BSD-3-Clause
#include <filesystem>
#include <iostream>
#include <memory>

#include "sim/config/message_text.hpp"
#include "tools/experiment/upgrade/upgrade_file.hpp"
#include "tools/shoal/commands/commands.hpp"

namespace tools {

namespace {

struct UpgradeArguments {
  std::vector<std::string> files;
  bool check = false;
};

/// Returns NAME, or NAME.yaml in the current folder.  Shipped files are up to date and not rewritten.
std::string own_file(const std::string& given) {
  std::error_code error;
  const std::string with_ending = given + ".yaml";
  return !std::filesystem::exists(given, error) && std::filesystem::exists(with_ending, error) ? with_ending : given;
}

void print_lines(const FileUpgrade& file) {
  for (const ChangedLines& lines : file.upgraded.lines) {
    std::cout << file.path << ':' << lines.first_line << '\n';
    for (const std::string& line : lines.before) std::cout << "- " << sim::printable(line) << '\n';
    for (const std::string& line : lines.after) std::cout << "+ " << sim::printable(line) << '\n';
  }
}

/// Returns whether the file is up to date or was upgraded.
bool finish(const FileUpgrade& file, bool check) {
  // States without a change.
  switch (file.state) {
    case FileUpgrade::State::refused:
      for (const std::string& line : file.errors) std::cerr << line << '\n';
      return false;
    case FileUpgrade::State::up_to_date:
      std::cout << file.path << ": up to date\n";
      return true;
    case FileUpgrade::State::changes:
      break;
  }
  // Print or write the change.
  const std::size_t places = file.upgraded.lines.size();
  if (check) {
    print_lines(file);
    std::cout << file.path << ": would change in " << places << (places == 1 ? " place\n" : " places\n");
    return false;
  }
  try {
    write_upgrade(file);
  } catch (const sim::ConfigError& error) {
    for (const std::string& line : error.lines()) std::cerr << line << '\n';
    return false;
  }
  std::cout << file.path << ": rewritten in " << places << (places == 1 ? " place\n" : " places\n");
  return true;
}

int upgrade(const UpgradeArguments& arguments) {
  std::vector<std::string> paths;
  for (const std::string& given : arguments.files) paths.push_back(own_file(given));
  int exit_code = exit_ok;
  for (const FileUpgrade& file : plan_upgrade(paths))
    if (!finish(file, arguments.check)) exit_code = exit_failed;
  return exit_code;
}

}  // namespace

static void add_upgrade_command(CLI::App& app, int& exit_code) {
  CLI::App* command = app.get_subcommand("upgrade");
  const auto arguments = std::make_shared<UpgradeArguments>();
  add_log_level_option(*command);
  command->add_option("FILE", arguments->files, "world, vehicle or study files; files they include are rewritten too")
      ->required();
  command->add_flag("--check", arguments->check, "print what would change, and write nothing");
  command_line::set_help_end(
      *command,
      {{"shoal upgrade harbour.yaml", "shoal upgrade --check worlds/*.yaml vehicles/*.yaml"},
       {{0, "every file is in the format of this version"},
        {1, "a file was left as it is, because of an error; with --check: or would change"},
        {2, "wrong usage"}},
       {"Only what has changed in the format is written again; comments, blank lines, quotes and layout stay.  The new "
        "text is parsed and compared with what was meant before it takes the place of the old one in one step.  A file "
        "that cannot be rewritten with certainty is left as it is, with an error line."}});
  command->callback([arguments, &exit_code] { exit_code = upgrade(*arguments); });
}

SHOAL_COMMAND(add_upgrade_command);

}  // namespace tools
