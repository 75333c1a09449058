// SPDX-License-Identifier: BSD-3-Clause
#include <CLI/App.hpp>
#include <algorithm>
#include <cstdio>
#include <string>
#include <string_view>
#include <vector>

#include "autonomy/cooperative/estimator/estimator_registry.hpp"
#include "tools/command_line/declared_options.hpp"
#include "tools/command_line/help.hpp"
#include "tools/command_line/parse.hpp"
#include "tools/programs/navigation/nav_commands.hpp"

namespace navigation {

bool is_list(int argc, const char* const* argv) {
  return std::find(argv + 1, argv + argc, std::string_view("--list")) != argv + argc;
}

int run_list_command(int argc, const char* const* argv) {
  std::vector<std::string> names;
  bool list = false;
  CLI::App app{"Lists algorithms of cooperative navigation.", "shoal-nav"};
  app.add_flag("--list", list, "print name and meaning of each algorithm")->required();
  command_line::add_name_list(app, "--algorithm", names, "list only these, such as python:FILE.Class");
  command_line::add_plugin_option(app);
  command_line::set_help_end(app, {{"shoal-nav --list", "shoal-nav --list --algorithm python:mine.Mine"},
                                   {{0, "all are known"}, {2, "wrong usage, or an algorithm is not known"}},
                                   {}});
  if (const auto exit_code = command_line::parse(app, argc, argv)) return *exit_code;
  std::vector<const Algorithm*> listed;
  for (const std::string& name : names) listed.push_back(&algorithm_named(name));
  for (const Algorithm* algorithm : names.empty() ? all_algorithms() : listed)
    std::printf("%-10s %s%s\n", algorithm->name.c_str(), algorithm->meaning.c_str(),
                algorithm->make ? "" : "; from a record only");
  return 0;
}

}  // namespace navigation
