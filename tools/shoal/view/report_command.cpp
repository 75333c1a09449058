// SPDX-License-Identifier: BSD-3-Clause
#include <spdlog/fmt/fmt.h>
#include <unistd.h>

#include <cctype>
#include <cerrno>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <memory>
#include <stdexcept>

#include "experiment/files/no_links.hpp"
#include "experiment/report/report_page.hpp"
#include "experiment/results/run_record.hpp"
#include "experiment/run/version.hpp"
#include "sim/base/log.hpp"
#include "tools/shoal/commands/commands.hpp"
#include "tools/shoal/options/shared_options.hpp"
#include "viewer/recording/recording_page.hpp"

namespace tools {

namespace {

namespace fs = std::filesystem;

struct ReportArguments {
  std::vector<std::string> directories;
  std::string output, record, page;
  bool no_page = false;
};

void write_page(const std::string& path, const std::string& page) {
  check_writable(path);
  std::ofstream out(path, std::ios::binary);
  out << page << std::flush;
  if (!out) throw std::runtime_error(path + ": cannot be written: " + std::strerror(errno));
}

/// Returns the only log in a results folder; empty: none or several, and then why.
std::string record_in(const std::string& directory, std::string& why_not) {
  std::vector<std::string> records;
  std::error_code error;
  for (const auto& entry : fs::directory_iterator(directory, error))
    if (entry.path().extension() == ".lcm" && entry.is_regular_file(error)) records.push_back(entry.path().string());
  if (records.size() == 1) return records.front();
  why_not = records.empty() ? directory + " holds no record; name it with --record"
                            : directory + " holds several records; name one with --record";
  return "";
}

/// Makes the page of a record.  Throws BusError, and std::runtime_error.
void make_page(const std::string& record, const std::string& directory, const std::string& path) {
  const bool terminal = isatty(STDERR_FILENO) != 0;
  const viewer::RecordingPage page = viewer::make_recording_page(
      record, experiment::short_version(), viewer::max_recording_page_bytes, [&](double share) {
        if (terminal) std::cerr << fmt::format("\r{}: {:.0f} % read", record, 100 * share) << std::flush;
      });
  if (terminal) std::cerr << "\r\033[K";
  const std::string world = experiment::read_run(directory).world;
  if (page.world != world)
    throw std::runtime_error(
        fmt::format("{}: is of world '{}', but the run in {} is of '{}'", record, page.world, directory, world));
  write_page(path, page.html);
  std::cout << path << ": the run in 3-D, " << page.to_text() << '\n';
}

/// Makes the 3-D page and returns its path; empty if there is none, after a message.
std::string page_in_3d(const ReportArguments& arguments) {
  const std::string& directory = arguments.directories.front();
  const bool demanded = !arguments.record.empty() || !arguments.page.empty();
  std::error_code error;
  if (arguments.no_page || !fs::exists(directory + "/summary.json", error) ||
      fs::exists(directory + "/study.json", error))
    return "";
  std::string why_not, record = arguments.record;
  if (record.empty()) record = record_in(directory, why_not);
  const std::string path = arguments.page.empty() ? directory + "/run.html" : arguments.page;
  if (arguments.page.empty()) experiment::refuse_links(directory, path);
  try {
    if (record.empty()) throw std::runtime_error(why_not);
    make_page(record, directory, path);
    return path;
  } catch (const std::runtime_error& reason) {
    if (demanded) throw;
    sim::log_info("no 3-D page: {}", reason.what());
    return "";
  }
}

/// Returns the address of a file, relative to another one.
std::string address_from(const std::string& file, const std::string& from) {
  const fs::path folder = fs::absolute(from).parent_path();
  std::string address;
  for (const char letter : fs::absolute(file).lexically_relative(folder).generic_string()) {
    const auto byte = static_cast<unsigned char>(letter);
    if (std::isalnum(byte) != 0 || std::strchr("/._-~", letter) != nullptr)
      address += letter;
    else
      address += fmt::format("%{:02X}", byte);
  }
  return address;
}

int report(const ReportArguments& arguments) {
  const std::vector<std::string>& directories = arguments.directories;
  const bool several = directories.size() > 1;
  if (several && (!arguments.record.empty() || !arguments.page.empty()))
    throw CLI::ValidationError(arguments.record.empty() ? "--page" : "--record", "needs a single results directory");
  const std::string output = !arguments.output.empty()
                                 ? arguments.output
                                 : directories.front() + (several ? "/comparison.html" : "/report.html");
  try {
    // A stranger's folder may have a link in place of a page whose name the user did not choose.
    if (arguments.output.empty()) experiment::refuse_links(directories.front(), output);
    const std::string page = several ? "" : page_in_3d(arguments);
    write_page(output, experiment::report_page(directories, page.empty() ? "" : address_from(page, output)));
  } catch (const std::runtime_error& error) {
    std::cerr << "shoal: " << error.what() << '\n';
    return exit_bus;
  }
  std::cout << output << '\n';
  return exit_ok;
}

}  // namespace

static void add_report_command(CLI::App& app, int& exit_code) {
  CLI::App* command = app.get_subcommand("report");
  const auto arguments = std::make_shared<ReportArguments>();
  add_log_level_option(*command);
  command->add_option("DIR", arguments->directories, "results directories; several runs are compared")->required();
  command
      ->add_option("--output", arguments->output,
                   "page to write; default DIR/report.html, or comparison.html in the first of several")
      ->type_name("FILE");
  command
      ->add_option("--record", arguments->record, "record of the run, for a 3-D page; default: the only *.lcm in DIR")
      ->type_name("LOG");
  CLI::Option* page =
      command->add_option("--page", arguments->page, "3-D page to write; default DIR/run.html")->type_name("FILE");
  command->add_flag("--no-page", arguments->no_page, "do not write a 3-D page")->excludes(page);
  command_line::set_help_end(*command,
                             {{"shoal report results/coop_land", "shoal report results/coop_land --record coop.lcm",
                               "shoal report results/seed1 results/seed2 --output comparison.html"},
                              {{0, "success"}, {2, "wrong usage"}, {4, "a file cannot be read or written"}},
                              {"Each page is one file that needs no network. The 3-D page has at most 20 MB; for a "
                               "longer run it has fewer poses.  See docs/guides/reports.md."}});
  command->callback([arguments, &exit_code] { exit_code = report(*arguments); });
}

SHOAL_COMMAND(measure, "report", "Make one HTML page of the results of a run or a study", add_report_command);

}  // namespace tools
