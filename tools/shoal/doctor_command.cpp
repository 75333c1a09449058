// SPDX-License-Identifier: BSD-3-Clause
#include <fcntl.h>
#include <spdlog/fmt/fmt.h>

#include <algorithm>
#include <cerrno>
#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <iterator>
#include <memory>

#include "bridges/base/child_program.hpp"
#include "bridges/base/file_descriptor.hpp"
#include "bridges/bus/network_check.hpp"
#include "experiment/process/helper_programs.hpp"
#include "tools/shoal/commands/commands.hpp"

namespace tools {

namespace {

const char* word(bridges::Finding::Verdict verdict) {
  switch (verdict) {
    case bridges::Finding::Verdict::ok:
      return "ok      ";
    case bridges::Finding::Verdict::warning:
      return "warning ";
    default:
      return "BAD     ";
  }
}

constexpr std::uintmax_t least_free_bytes = 1'000'000'000;  // a record of an hour, plots and a film

/// Checks whether results can be written to the current folder: makes a file there, and removes it.
bridges::Finding check_folder() {
  using Verdict = bridges::Finding::Verdict;
  std::string probe = ".shoal-doctor-XXXXXX";
  const bridges::FileDescriptor file(mkostemp(probe.data(), O_CLOEXEC));
  const int reason = errno;
  std::error_code error;
  const std::string here = std::filesystem::current_path(error).string();
  const std::string elsewhere = "choose another folder with --results";
  if (file.number() < 0)
    return {"folder", Verdict::warning, here + " cannot be written: " + std::strerror(reason) + "; " + elsewhere, {}};
  std::filesystem::remove(probe, error);
  const std::uintmax_t free_bytes = std::filesystem::space(".", error).available;
  const std::string text = fmt::format("{} has {:.1f} GB free", here, static_cast<double>(free_bytes) * 1e-9);
  if (error || free_bytes >= least_free_bytes) return {"folder", Verdict::ok, text, {}};
  return {"folder", Verdict::warning, text + "; free some space, or " + elsewhere, {}};
}

/// Prints which programs of others are missing, and how to install them.
void report_helpers() {
  const std::vector<experiment::HelperProgram> missing = experiment::missing_helpers(bridges::is_program);
  for (const experiment::HelperProgram& each : missing)
    std::cout << "missing " << each.name << ": needed for " << each.purpose << '\n';
  if (missing.empty()) return;
  std::ifstream file("/etc/os-release");
  const std::string release{std::istreambuf_iterator<char>(file), {}};
  std::cout << "\nFor what is missing, run as root, or leave it out:\n  "
            << experiment::install_command(missing, release) << '\n';
}

/// Prints findings and their remedies; returns whether none is bad.
bool report(const std::vector<bridges::Finding>& findings) {
  bool usable = true;
  std::vector<std::string> commands;
  for (const bridges::Finding& finding : findings) {
    std::cout << word(finding.verdict) << finding.name << ": " << finding.text << '\n';
    usable = usable && finding.verdict != bridges::Finding::Verdict::bad;
    // Several findings may have the same remedy.
    for (const std::string& each : finding.commands)
      if (std::find(commands.begin(), commands.end(), each) == commands.end()) commands.push_back(each);
  }
  if (!commands.empty()) std::cout << "\nTo fix it, run as root:\n";
  for (const std::string& command : commands) std::cout << "  " << command << '\n';
  return usable;
}

int examine(const std::string& url, const std::string& peer) {
  if (!peer.empty()) return report(bridges::check_peer(peer, url)) ? exit_ok : exit_bus;
  std::vector<bridges::Finding> findings = bridges::check_network(url);
  findings.push_back(check_folder());
  const bool usable = report(findings);
  report_helpers();
  std::cout << (usable ? "\nLCM is usable here.\n" : "\nLCM is not usable here.\n");
  return usable ? exit_ok : exit_bus;
}

}  // namespace

static void add_doctor_command(CLI::App& app, int& exit_code) {
  CLI::App* command = app.get_subcommand("doctor");
  const auto url = std::make_shared<std::string>(), peer = std::make_shared<std::string>();
  add_log_level_option(*command);
  add_lcm_url_option(*command, *url);
  command->add_option("--peer", *peer, "check what reaches another machine, on which the same runs, instead")
      ->type_name("HOST");
  command_line::set_help_end(*command, {{"shoal doctor", "shoal doctor --peer 192.168.1.7",
                                         "shoal doctor --peer 192.168.1.7 --lcm-url udpm://239.255.76.67:7667?ttl=1"},
                                        {{0, "usable"}, {2, "wrong usage"}, {4, "not usable"}},
                                        {}});
  command->callback([url, peer, &exit_code] { exit_code = examine(*url, *peer); });
}

SHOAL_COMMAND(connect, "doctor", "Check network, folder and helper programs of this machine, and print how to fix them",
              add_doctor_command);

}  // namespace tools
