// SPDX-License-Identifier: BSD-3-Clause
#include <poll.h>
#include <spdlog/fmt/fmt.h>
#include <sys/ioctl.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cstdlib>
#include <iostream>
#include <map>
#include <memory>
#include <optional>

#include "bridges/lcm/lcm_listener.hpp"
#include "bridges/lockstep_client/wait_warning.hpp"
#include "experiment/run/runner.hpp"
#include "shoal/message_schema.hpp"
#include "sim/base/text_layout.hpp"
#include "tools/shoal/commands/commands.hpp"

namespace tools {

namespace {

using Clock = std::chrono::steady_clock;

struct SpyArguments {
  std::string lcm_url;
  std::string channel;  ///< decodes this channel; empty: a table of all channels
  double duration_s = 0;
  std::vector<std::string> lcm_files;
};

struct Seen {
  std::uint64_t messages = 0;
  std::uint64_t messages_before = 0;
  sim::Bytes last;
};

/// Returns the start of a text on one line.
std::string one_line(std::string_view text) {
  std::string line;
  for (const char c : text.substr(0, 200)) line += static_cast<unsigned char>(c) < 0x20 || c == 0x7f ? ' ' : c;
  return line + (text.size() > 200 ? "..." : "");
}

std::string value_text(const shoal::FieldValue& value) {
  if (const bool* flag = std::get_if<bool>(&value)) return *flag ? "true" : "false";
  if (const auto* integer = std::get_if<std::int64_t>(&value)) return std::to_string(*integer);
  if (const double* number = std::get_if<double>(&value)) return fmt::format("{:.6g}", *number);
  if (const auto* text = std::get_if<std::string_view>(&value)) return "\"" + one_line(*text) + "\"";
  return fmt::format("{} bytes", std::get<std::span<const std::byte>>(value).size());
}

/// Returns the fields of a message; long ones are shortened.
std::string decoded(const shoal::MessageTypes& types, const sim::Bytes& payload, std::size_t max_fields,
                    const char* separator) {
  const auto fingerprint = static_cast<std::uint64_t>(shoal::fingerprint(payload));
  const shoal::MessageSchema* schema = types.find(fingerprint);
  if (schema == nullptr) return fmt::format("unknown type {:016x}", fingerprint);
  std::string text = schema->name;
  std::size_t fields = 0;
  const auto error = shoal::visit_fields(*schema, payload, [&](std::string_view name, const shoal::FieldValue& value) {
    if (fields++ < max_fields) text += fmt::format("{}{}={}", separator, name, value_text(value));
  });
  if (error) return schema->name + ": " + *error;
  if (fields > max_fields) text += fmt::format("{}... {} more", separator, fields - max_fields);
  return text;
}

/// Screen that the table must fit; nothing for a pipe or file, where lines are not shortened.
struct Screen {
  std::size_t columns = 80, lines = 24;
};

std::optional<Screen> find_screen() {
  if (isatty(STDOUT_FILENO) == 0) return std::nullopt;
  Screen screen;
  screen.columns = static_cast<std::size_t>(sim::text_columns(STDOUT_FILENO));
  winsize size{};
  if (ioctl(STDOUT_FILENO, TIOCGWINSZ, &size) == 0 && size.ws_row > 4) screen.lines = size.ws_row;
  return screen;
}

/// Returns the columns for the name of a channel: those left beside the figures, less at least a dozen for the message.
std::size_t channel_columns(const std::map<std::string, Seen>& channels, const std::optional<Screen>& screen) {
  constexpr std::size_t figures = 27, min_of_message = 12, usual = 32;
  if (!screen) return usual;
  std::size_t longest = 8;
  for (const auto& [channel, seen] : channels) longest = std::max(longest, sim::column_count(channel));
  const std::size_t room = screen->columns - std::min(screen->columns, figures + 2 + min_of_message);
  return std::max<std::size_t>(8, std::min(longest, room));
}

void print_table(std::map<std::string, Seen>& channels, const shoal::MessageTypes& types, double since_s,
                 const std::optional<Screen>& screen) {
  const std::size_t width = channel_columns(channels, screen);
  const auto fitted = [&](const std::string& line) { return screen ? sim::cut_to(line, screen->columns) : line; };
  // On a terminal that cannot be cleared the tables are printed one below the other.
  if (screen && sim::can_move_cursor(STDOUT_FILENO)) std::cout << "\033[H\033[2J";
  std::string text =
      fitted(fmt::format("{:<{}} {:>8} {:>8} {:>8}  last message", "channel", width, "messages", "Hz", "bytes")) + '\n';
  std::size_t lines = 1, left_out = 0;
  for (auto& [channel, seen] : channels) {
    const double rate_hz = static_cast<double>(seen.messages - seen.messages_before) / since_s;
    seen.messages_before = seen.messages;
    // Space below the last row for the number of omitted rows and the cursor.
    if (screen && lines + 3 > screen->lines && ++left_out > 0) continue;
    const std::string name = one_line(channel);
    text += fitted(fmt::format("{:<{}} {:>8} {:>8.1f} {:>8}  {}", screen ? sim::cut_to(name, width) : name, width,
                               seen.messages, rate_hz, seen.last.size(), decoded(types, seen.last, 6, " "))) +
            '\n';
    ++lines;
  }
  if (left_out > 0) text += fmt::format("and {} more channels\n", left_out);
  std::cout << text << std::flush;
}

/// Returns true once the output is closed: the next write would end the program, but it may be much later.
bool output_closed() {
  pollfd output{STDOUT_FILENO, 0, 0};
  return !std::cout || (poll(&output, 1, 0) > 0 && (output.revents & POLLERR) != 0);
}

int spy(const SpyArguments& arguments) {
  // Subscribe.
  const shoal::MessageTypes types = shoal::types_with(arguments.lcm_files);
  bridges::LcmListener listener(arguments.lcm_url);
  if (arguments.channel.empty())
    listener.listen_to_all();
  else
    listener.listen(arguments.channel);
  experiment::catch_signals(false);
  const bool table = arguments.channel.empty();
  const bool terminal = isatty(STDOUT_FILENO) != 0;
  // In a pipe, rates over whole seconds; with a duration a single table for all of it.
  const double every_s = terminal ? 0.5 : arguments.duration_s > 0 ? arguments.duration_s : 1;
  std::map<std::string, Seen> channels;
  const Clock::time_point begin = Clock::now();
  Clock::time_point shown = begin;
  const auto seconds_since = [](Clock::time_point then) {
    return std::chrono::duration<double>(Clock::now() - then).count();
  };
  bridges::WaitWarning warning("shoal spy: waiting for messages on " +
                               (arguments.channel.empty() ? "any channel" : "'" + arguments.channel + "'") + ", at " +
                               listener.url());
  bool closed = false;
  const auto over = [&] {
    closed = output_closed();
    return closed || experiment::caught_signal() != 0 ||
           (arguments.duration_s > 0 && seconds_since(begin) > arguments.duration_s);
  };
  bool any_table = false;
  // Count the messages and print the table regularly.
  while (!over()) {
    if (channels.empty()) warning.look();
    if (const auto message = listener.next(std::chrono::milliseconds(100))) {
      Seen& seen = channels[message->channel];
      ++seen.messages;
      seen.last = message->payload;
      if (!table) std::cout << decoded(types, message->payload, 10000, "\n  ") << '\n' << std::flush;
    }
    if (!table || channels.empty() || seconds_since(shown) < every_s) continue;
    if (any_table && !terminal) std::cout << '\n';
    print_table(channels, types, seconds_since(shown), find_screen());
    shown = Clock::now();
    any_table = true;
  }
  if (table && !any_table && !channels.empty() && !closed)
    print_table(channels, types, seconds_since(shown), find_screen());
  if (channels.empty() && !closed)
    std::cerr << "shoal spy: no message was received; is a simulator running? see `shoal doctor`\n";
  return exit_ok;
}

}  // namespace

static void add_spy_command(CLI::App& app, int& exit_code) {
  CLI::App* command = app.get_subcommand("spy");
  const auto arguments = std::make_shared<SpyArguments>();
  add_log_level_option(*command);
  command->add_option("CHANNEL", arguments->channel, "show every message of this channel in full");
  command->add_option("--duration", arguments->duration_s, "wall seconds; default: forever, until Ctrl-C")
      ->type_name("S")
      ->transform(command_line::number_or_word(1e-6, 1e9, "forever"));
  add_lcm_url_option(*command, arguments->lcm_url);
  add_types_option(*command, arguments->lcm_files);
  add_plugin_option(*command);
  command_line::set_help_end(
      *command, {{"shoal spy", "shoal spy rover1.odometry", "shoal spy --duration 5 > channels.txt"},
                 {{0, "success, even when no message was received"}, {2, "wrong usage"}, {4, "bus error"}},
                 {"On a terminal the table is redrawn twice a second.  A pipe or file gets a table every second, or "
                  "with --duration one of the whole time; with CHANNEL the fields of each of its messages."}});
  command->callback([arguments, &exit_code] { exit_code = spy(*arguments); });
}

SHOAL_COMMAND(connect, "spy", "Watch the live channels: rates and decoded fields", add_spy_command);

}  // namespace tools
