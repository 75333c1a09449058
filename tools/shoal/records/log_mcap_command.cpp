// SPDX-License-Identifier: BSD-3-Clause
#include "tools/shoal/records/log_mcap_command.hpp"

#include <chrono>
#include <filesystem>
#include <iostream>
#include <memory>
#include <regex>

#include "bridges/log/mcap_conversion.hpp"
#include "sim/base/log.hpp"
#include "tools/shoal/options/shared_options.hpp"

namespace tools {

namespace {

struct McapArguments {
  std::string log, out, channels;
  bool overwrite = false;
  std::vector<std::string> lcm_files;
};

/// Reports the progress of a conversion that takes long.
class ConversionProgress {
 public:
  void update(std::uint64_t done, std::uint64_t total) {
    if (++calls_ % 1024 != 0) return;
    const auto now = std::chrono::steady_clock::now();
    if (now - last_ < std::chrono::seconds(5)) return;
    last_ = now;
    sim::log_info("{} of {} MB converted", done / 1'000'000, total / 1'000'000);
  }

 private:
  std::uint64_t calls_ = 0;
  std::chrono::steady_clock::time_point last_ = std::chrono::steady_clock::now();
};

std::regex pattern_of(const std::string& channels) {
  try {
    return std::regex(channels);
  } catch (const std::regex_error& error) {
    throw CLI::ValidationError("--channels", "'" + channels + "' is not a regular expression: " + error.what());
  }
}

/// Refuses an output that is the log itself, which --overwrite would empty.
void check_files(const McapArguments& arguments) {
  std::error_code error;
  if (std::filesystem::equivalent(arguments.log, arguments.out, error))
    throw CLI::ValidationError("--out", "must not be the log");
  if (!arguments.out.ends_with(".mcap"))
    throw CLI::ValidationError("--out", "must end in .mcap, got '" + arguments.out + "'");
  try {
    check_writable(arguments.out);
  } catch (const std::runtime_error& unwritable) {
    throw bridges::BusError(unwritable.what());
  }
}

int convert(const McapArguments& arguments) {
  check_files(arguments);
  // Convert.
  bridges::McapConversion conversion;
  conversion.log = arguments.log;
  conversion.out = arguments.out;
  conversion.existing = arguments.overwrite ? bridges::Existing::overwrite : bridges::Existing::refuse;
  if (!arguments.channels.empty())
    conversion.wants = [pattern = pattern_of(arguments.channels)](std::string_view channel) {
      return std::regex_match(channel.begin(), channel.end(), pattern);
    };
  ConversionProgress progress;
  conversion.progress = [&](std::uint64_t done, std::uint64_t total) { progress.update(done, total); };
  const bridges::McapConverted done = bridges::convert_to_mcap(conversion, shoal::types_with(arguments.lcm_files));
  // Report.
  fmt::print("{}: {} messages on {} topics, {} bytes, from {} events\n", arguments.out, done.messages, done.channels,
             done.bytes, done.events);
  for (const std::string& problem : done.problems) std::cerr << arguments.log << ": " << problem << '\n';
  if (done.not_decoded > 0) std::cerr << done.not_decoded << " events could not be decoded\n";
  for (const std::string& problem : done.log_problems) std::cerr << arguments.log << ": " << problem << '\n';
  if (done.time_problem) std::cerr << arguments.log << ": " << *done.time_problem << '\n';
  if (done.events == 0)
    std::cerr << arguments.log
              << (arguments.channels.empty() ? ": contains no readable event\n"
                                             : ": no event on such a channel; see shoal log info\n");
  return done.log_problems.empty() && done.events > 0 ? exit_ok : exit_bus;
}

}  // namespace

void add_log_mcap_command(CLI::App& app, int& exit_code) {
  CLI::App* command = app.add_subcommand("mcap", "Convert into an MCAP file, for Foxglove and the tools of ROS 2");
  const auto arguments = std::make_shared<McapArguments>();
  add_log_level_option(*command);
  command->add_option("LOG", arguments->log, "LCM event log")->required();
  command->add_option("--out", arguments->out, "file to write")->type_name("FILE")->required();
  command->add_option("--channels", arguments->channels, "only channels that match this regular expression")
      ->type_name("PATTERN");
  command->add_flag("--overwrite", arguments->overwrite, "replace an existing file");
  add_types_option(*command, arguments->lcm_files);
  add_plugin_option(*command);
  command_line::set_help_end(
      *command,
      {{"shoal log mcap run.lcm --out run.mcap",
        "shoal log mcap run.lcm --out rover1.mcap --channels 'rover1\\..*|sim\\.state'"},
       {{0, "success"}, {2, "wrong usage"}, {4, "the log is damaged or has no such channel, or a file error"}},
       {"docs/guides/foxglove_and_mcap.md describes the topics.  shoal run --record run.mcap writes the same file "
        "during "
        "a run."}});
  command->callback([arguments, &exit_code] { exit_code = convert(*arguments); });
}

}  // namespace tools
