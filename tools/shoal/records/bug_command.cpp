// SPDX-License-Identifier: BSD-3-Clause

#include <iostream>
#include <memory>
#include <stdexcept>

#include "bridges/base/bus_error.hpp"
#include "experiment/bug_report/bug_report.hpp"
#include "tools/shoal/commands/commands.hpp"
#include "tools/shoal/options/shared_options.hpp"

namespace tools {

namespace {

int pack(const experiment::BugOptions& options) {
  try {
    // Checked first: packing a long record takes minutes.
    if (!options.out.empty()) check_writable(options.out);
    const experiment::BugReport report = experiment::write_bug_report(options);
    std::cout << report.path << '\n';
    for (const std::string& line : report.inside) std::cout << "  " << line << '\n';
    if (!report.left_out.empty()) std::cout << "left out:\n";
    for (const std::string& line : report.left_out) std::cout << "  " << line << '\n';
    std::cerr << "It contains paths and commands of this machine: review it before you send it.\n";
  } catch (const std::runtime_error& error) {
    std::cerr << "shoal: " << error.what() << '\n';
    return exit_bus;
  }
  return exit_ok;
}

}  // namespace

static void add_bug_command(CLI::App& app, int& exit_code) {
  CLI::App* command = app.get_subcommand("bug");
  add_log_level_option(*command);
  const auto options = std::make_shared<experiment::BugOptions>();
  // Options.
  command->add_option("RUN", options->directory, "results folder of the run")->required()->type_name("DIR");
  command->add_option("--record", options->record, "record of the run; unset: the one *.lcm file in the folder")
      ->type_name("FILE");
  command->add_option("--last-s", options->last_s, "simulated seconds of the record, from its end")
      ->type_name("S")
      ->check(number_from(0.1, 1e9))
      ->capture_default_str();
  command->add_option("--max-mb", options->max_MB, "limit of the record's part in MB, before it is compressed")
      ->type_name("MB")
      ->check(whole_from(1, 4096))
      ->capture_default_str();
  command->add_flag_callback(
      "--no-files", [options] { options->files = false; },
      "store only hashes, not copies, of the files that the world names");
  command->add_option("--out", options->out, "the archive; unset: RUN/bug.tar.gz")->type_name("FILE");
  // End of the help and action.
  command_line::set_help_end(
      *command,
      {{"shoal bug results/coop_land --record coop.lcm", "shoal bug results/coop_land --out coop_land_bug.tar.gz"},
       {{0, "the archive is written"}, {2, "wrong usage"}, {4, "the folder, the record or the archive cannot be used"}},
       {"docs/guides/reports.md says what is inside."}});
  command->callback([options, &exit_code] { exit_code = pack(*options); });
}

SHOAL_COMMAND(connect, "bug", "Pack a run into one archive for a report to the developers", add_bug_command);

}  // namespace tools
