// SPDX-License-Identifier: BSD-3-Clause
#include <spdlog/fmt/fmt.h>

#include <algorithm>
#include <fstream>
#include <iostream>
#include <limits>
#include <map>
#include <memory>
#include <optional>
#include <regex>

#include "bridges/log/event_log.hpp"
#include "bridges/log/record_reader.hpp"
#include "shoal/message_codec.hpp"
#include "shoal/sim_info_t.hpp"
#include "sim/config/message_text.hpp"
#include "tools/shoal/commands/commands.hpp"
#include "tools/shoal/options/shared_options.hpp"
#include "tools/shoal/records/log_mcap_command.hpp"
#include "viewer/images/allan_table.hpp"
#include "viewer/images/log_image.hpp"

namespace tools {

namespace {

struct ChannelCount {
  std::uint64_t events = 0;
  std::uint64_t bytes = 0;
  bridges::TimeOrder order;
  std::optional<std::int64_t> fingerprint;  ///< of the last message; none: it is too short to have one
};

std::string type_name(const shoal::MessageTypes& types, std::optional<std::int64_t> fingerprint) {
  if (!fingerprint) return "too short for a type";
  const shoal::MessageSchema* schema = types.find(static_cast<std::uint64_t>(*fingerprint));
  return schema != nullptr ? schema->name : fmt::format("unknown {:016x}", static_cast<std::uint64_t>(*fingerprint));
}

void print_run(const bridges::LogEvent& event) {
  if (event.channel != "sim.info") return;
  try {
    const auto info = bridges::read_run_info(event.payload);
    fmt::print("world {}, seed {}, step {} us\n{}", info.world, info.seed, info.step_us, info.versions);
  } catch (const shoal::MessageError&) {
    // The channel belongs to another program that uses the name.
  }
}

int show_problems(const bridges::EventLogReader& log) {
  for (const std::string& problem : log.problems()) std::cerr << problem << '\n';
  return log.problems().empty() ? exit_ok : exit_bus;
}

int info(const std::string& path, const shoal::MessageTypes& types) {
  bridges::EventLogReader log(path);
  std::map<std::string, ChannelCount> channels;
  std::uint64_t events = 0;
  bridges::TimeOrder order;
  bool run_shown = false;
  // Count the events of each channel.
  while (const auto event = log.next()) {
    ++events;
    order.add(event->utime, event->channel);
    ChannelCount& count = channels[event->channel];
    ++count.events;
    count.order.add(event->utime, event->channel);
    count.bytes += event->payload.size();
    count.fingerprint.reset();
    if (event->payload.size() >= sizeof(std::int64_t)) count.fingerprint = shoal::fingerprint(event->payload);
    if (!run_shown && event->channel == "sim.info") {
      print_run(*event);
      run_shown = true;
    }
  }
  // Print the table.
  fmt::print("{}: {} events, {} bytes, {:.3f} s\n", path, events, log.file_bytes(), order.span_s());
  std::size_t width = 7;
  for (const auto& [channel, count] : channels) width = std::max(width, channel.size());
  fmt::print("{:>8} {:>8} {:>11}  {:<{}} {}\n", "events", "Hz", "bytes", "channel", width, "type");
  for (const auto& [channel, count] : channels) {
    const double span_s = count.order.span_s();
    const double rate_hz = span_s > 0 ? static_cast<double>(count.events - 1) / span_s : 0;
    fmt::print("{:>8} {:>8.2f} {:>11}  {:<{}} {}\n", count.events, rate_hz, count.bytes, sim::printable(channel), width,
               type_name(types, count.fingerprint));
  }
  if (const auto problem = order.problem()) std::cerr << path << ": " << *problem << '\n';
  return show_problems(log);
}

std::string csv_value(const shoal::FieldValue& value) {
  if (const bool* flag = std::get_if<bool>(&value)) return *flag ? "1" : "0";
  if (const auto* integer = std::get_if<std::int64_t>(&value)) return std::to_string(*integer);
  if (const double* number = std::get_if<double>(&value)) return fmt::format("{}", *number);
  if (const auto* bytes = std::get_if<std::span<const std::byte>>(&value)) {
    std::string hex;
    for (const std::byte b : *bytes) hex += fmt::format("{:02x}", static_cast<unsigned>(b));
    return hex;
  }
  // Texts are always quoted, as commas and quotes may be part of them (RFC 4180).
  std::string quoted = "\"";
  for (const char c : std::get<std::string_view>(value)) quoted += c == '"' ? std::string("\"\"") : std::string(1, c);
  return quoted + "\"";
}

/// Prints one table with a row for each event of one channel: the log's time, then every field.  Rows may differ in
/// length when arrays do; the header is that of the first row.
int csv(const std::string& path, const std::string& channel, const shoal::MessageTypes& types) {
  bridges::EventLogReader log(path);
  bool header = false;
  std::uint64_t rows = 0;
  std::uint64_t bad = 0;
  while (const auto event = log.next()) {
    if (event->channel != channel) continue;
    // Decode the message into a row.
    const shoal::MessageSchema* schema = types.find(static_cast<std::uint64_t>(shoal::fingerprint(event->payload)));
    std::string names = "log_utime";
    std::string row = std::to_string(event->utime);
    const auto error =
        schema == nullptr
            ? std::optional<std::string>("is of an unknown type; give its .lcm file with --types")
            : shoal::visit_fields(*schema, event->payload, [&](std::string_view name, const shoal::FieldValue& value) {
                if (!header) names += "," + std::string(name);
                row += "," + csv_value(value);
              });
    if (error) {
      if (bad++ == 0) std::cerr << path << ": byte " << event->offset << ": " << channel << ": " << *error << '\n';
      continue;
    }
    if (!header) std::cout << names << '\n';
    header = true;
    if (!(std::cout << row << '\n')) return exit_ok;  // main() handles the closed output
    ++rows;
  }
  // Report problems.
  if (bad > 1) std::cerr << bad << " events of " << channel << " could not be decoded\n";
  if (rows == 0 && bad == 0) std::cerr << path << ": no event on channel '" << channel << "'; see shoal log info\n";
  return rows == 0 || bad > 0 ? exit_bus : show_problems(log);
}

void check_png_name(const std::string& png) {
  if (!png.ends_with(".png")) throw CLI::ValidationError("--png", "must end in .png, got '" + png + "'");
}

/// Computes the Allan deviation of the reports of an instrument at rest: as CSV to a file or stdout, and as an image.
int allan(const std::string& path, const std::string& channel, const std::string& out, const std::string& png,
          const shoal::MessageTypes& types) {
  if (!png.empty()) check_png_name(png);
  try {
    for (const std::string& file : {out, png})
      if (!file.empty()) check_writable(file);
    const viewer::AllanTable table = viewer::allan_table(path, channel, types);
    if (!out.empty() && !(std::ofstream(out) << viewer::to_csv(table) << std::flush))
      throw std::runtime_error("'" + out + "' cannot be written");
    if (!png.empty()) viewer::plot(table, png);
    if (out.empty() && png.empty()) std::cout << viewer::to_csv(table);
  } catch (const bridges::BusError&) {
    throw;  // contains the name of the file
  } catch (const std::runtime_error& error) {
    std::cerr << path << ": " << error.what() << '\n';
    return exit_bus;
  }
  return exit_ok;
}

struct LogArguments {
  std::string path, channel, out, png;
  std::vector<std::string> lcm_files;
  viewer::ImageChoice choice;
};

int image(const LogArguments& arguments) {
  check_png_name(arguments.png);
  const std::string& path = arguments.path;
  try {
    check_writable(arguments.png);
    const viewer::LogImage made = viewer::draw_log(path, arguments.channel, arguments.png, arguments.choice);
    std::cout << arguments.png << ": " << arguments.channel << ", " << made.drawn << '\n';
    for (const std::string& problem : made.problems) std::cerr << path << ": " << problem << '\n';
    if (!made.problems.empty()) return exit_bus;
  } catch (const bridges::BusError&) {
    throw;  // contains the name of the file
  } catch (const std::runtime_error& error) {
    std::cerr << path << ": " << error.what() << '\n';
    return exit_bus;
  }
  return exit_ok;
}

const std::vector<std::pair<int, std::string>> log_codes = {
    {0, "success"}, {2, "wrong usage"}, {4, "the log is damaged or lacks the requested data, or a file error"}};

void add_common(CLI::App& command, LogArguments& arguments) {
  add_log_level_option(command);
  command.add_option("LOG", arguments.path, "LCM event log")->required();
}

void add_info_command(CLI::App& app, int& exit_code) {
  CLI::App* command = app.add_subcommand("info", "List channels, rates and types, and the run that wrote the log");
  const auto arguments = std::make_shared<LogArguments>();
  add_common(*command, *arguments);
  add_types_option(*command, arguments->lcm_files);
  add_plugin_option(*command);
  command_line::set_help_end(*command, {{"shoal log info run.lcm"}, log_codes, {}});
  command->callback(
      [arguments, &exit_code] { exit_code = info(arguments->path, shoal::types_with(arguments->lcm_files)); });
}

void add_csv_command(CLI::App& app, int& exit_code) {
  CLI::App* command = app.add_subcommand("csv", "Print the messages of one channel as CSV");
  const auto arguments = std::make_shared<LogArguments>();
  add_common(*command, *arguments);
  command->add_option("CHANNEL", arguments->channel, "such as rover1.odometry")->required();
  add_types_option(*command, arguments->lcm_files);
  add_plugin_option(*command);
  command_line::set_help_end(*command, {{"shoal log csv run.lcm rover1.odometry > odometry.csv"}, log_codes, {}});
  command->callback([arguments, &exit_code] {
    exit_code = csv(arguments->path, arguments->channel, shoal::types_with(arguments->lcm_files));
  });
}

void add_allan_command(CLI::App& app, int& exit_code) {
  CLI::App* command = app.add_subcommand(
      "allan", "Compute the Allan deviation of each double array of one channel, of an instrument at rest or a clock");
  const auto arguments = std::make_shared<LogArguments>();
  add_common(*command, *arguments);
  command->add_option("CHANNEL", arguments->channel, "such as rover1.imu")->required();
  command->add_option("--out", arguments->out, "CSV file; without --out and --png the CSV goes to stdout")
      ->type_name("FILE");
  command->add_option("--png", arguments->png, "plot, by gnuplot")->type_name("FILE");
  add_types_option(*command, arguments->lcm_files);
  add_plugin_option(*command);
  command_line::set_help_end(*command, {{"shoal log allan run.lcm bench.imu --png allan.png"}, log_codes, {}});
  command->callback([arguments, &exit_code] {
    exit_code = allan(arguments->path, arguments->channel, arguments->out, arguments->png,
                      shoal::types_with(arguments->lcm_files));
  });
}

void add_image_command(CLI::App& app, int& exit_code) {
  CLI::App* command = app.add_subcommand("image", "Draw the recording of a camera or range sensor on one channel");
  const auto arguments = std::make_shared<LogArguments>();
  add_common(*command, *arguments);
  command->add_option("CHANNEL", arguments->channel, "such as auv1.side_scan or rover1.camera")->required();
  command->add_option("--png", arguments->png, "file to write")->type_name("FILE")->required();
  CLI::Option* at =
      command->add_option("--at", arguments->choice.at_s, "draw the message nearest to this simulated time");
  CLI::Option* number = command->add_option("--number", arguments->choice.number,
                                            "draw this message, from 0; without --at and --number the last");
  at->type_name("S")->check(number_from(0, 1e9).description(""));
  number->type_name("N")->check(whole_from(0, std::numeric_limits<int>::max()).description(""))->excludes(at);
  add_plugin_option(*command);
  command_line::set_help_end(*command,
                             {{"shoal log image run.lcm auv1.side_scan --png side_scan.png",
                               "shoal log image run.lcm rover1.camera --at 12.5 --png seen.png"},
                              log_codes,
                              {"All side scans or multibeam pings are drawn in one image, of a radar the turn "
                               "that ends with the message; for other sensors one message is drawn.  All "
                               "except camera images need gnuplot."}});
  command->callback([arguments, &exit_code] { exit_code = image(*arguments); });
}

}  // namespace

static void add_log_command(CLI::App& app, int& exit_code) {
  CLI::App* command = app.get_subcommand("log");
  command->require_subcommand(1);
  add_info_command(*command, exit_code);
  add_csv_command(*command, exit_code);
  add_allan_command(*command, exit_code);
  add_image_command(*command, exit_code);
  add_log_mcap_command(*command, exit_code);
  command_line::set_help_end(
      *command,
      {{"shoal log info run.lcm", "shoal log csv run.lcm rover1.odometry > odometry.csv",
        "shoal log allan run.lcm bench.imu --png allan.png",
        "shoal log image run.lcm auv1.side_scan --png side_scan.png", "shoal log mcap run.lcm --out run.mcap"},
       log_codes,
       {}});
}

SHOAL_COMMAND(look, "log", "Inspect and convert LCM event logs", add_log_command);

}  // namespace tools
