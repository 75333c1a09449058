// SPDX-License-Identifier: BSD-3-Clause
#include <cerrno>
#include <cstring>
#include <fstream>
#include <iostream>
#include <memory>
#include <stdexcept>

#include "tools/experiment/report/report_page.hpp"
#include "tools/shoal/commands.hpp"
#include "tools/shoal/output_file.hpp"

namespace tools {

namespace {

int report(const std::vector<std::string>& directories, std::string output) {
  if (output.empty()) output = directories.front() + (directories.size() > 1 ? "/comparison.html" : "/report.html");
  try {
    const std::string page = report_page(directories);
    check_writable(output);
    std::ofstream out(output, std::ios::binary);
    out << page << std::flush;
    if (!out) throw std::runtime_error(output + ": cannot be written: " + std::strerror(errno));
  } catch (const std::runtime_error& error) {
    std::cerr << "shoal: " << error.what() << '\n';
    return exit_bus;
  }
  std::cout << output << '\n';
  return exit_ok;
}

}  // namespace

void add_report_command(CLI::App& app, int& exit_code) {
  CLI::App* command = app.add_subcommand("report", "Make one HTML page of the results of a run or a study");
  struct Arguments {
    std::vector<std::string> directories;
    std::string output;
  };
  const auto arguments = std::make_shared<Arguments>();
  add_log_level_option(*command);
  command->add_option("DIR", arguments->directories, "results directories; several runs are compared")->required();
  command
      ->add_option("--output", arguments->output,
                   "the page; without it DIR/report.html, or comparison.html in the first of several")
      ->type_name("FILE");
  command_line::set_help_end(
      *command,
      {{"shoal report results/coop_land", "shoal report results/seed1 results/seed2 --output comparison.html"},
       {{0, "success"}, {2, "wrong usage"}, {4, "a file cannot be read or written"}},
       {"The page holds its plots and needs no network.  See docs/guides/scoring.md."}});
  command->callback([arguments, &exit_code] { exit_code = report(arguments->directories, arguments->output); });
}

}  // namespace tools
