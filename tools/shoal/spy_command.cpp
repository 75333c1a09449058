#include <poll.h>
#include <spdlog/fmt/fmt.h>
#include <unistd.h>

#include <chrono>
#include <iostream>
#include <map>
#include <memory>

#include "bridges/lcm/lcm_listener.hpp"
#include "bridges/lcm/wait_notice.hpp"
#include "shoal/message_schema.hpp"
#include "tools/experiment/runner.hpp"
#include "tools/shoal/commands.hpp"

namespace tools {

namespace {

using Clock = std::chrono::steady_clock;

struct SpyArguments {
  std::string lcm_url;
  std::string channel;  ///< decode this one; empty: a table of all
  double duration_s = 0;
  std::vector<std::string> lcm_files;
};

struct Seen {
  std::uint64_t messages = 0;
  std::uint64_t bytes = 0;
  std::uint64_t messages_before = 0;
  sim::Bytes last;
};

/// The start of a text on one line.
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

/// The fields of a message, the long ones cut.
std::string decoded(const shoal::MessageTypes& types, const sim::Bytes& payload, std::size_t most_fields,
                    const char* separator) {
  const auto fingerprint = static_cast<std::uint64_t>(shoal::fingerprint(payload));
  const shoal::MessageSchema* schema = types.find(fingerprint);
  if (schema == nullptr) return fmt::format("unknown type {:016x}", fingerprint);
  std::string text = schema->name;
  std::size_t fields = 0;
  const auto error = shoal::visit_fields(*schema, payload, [&](std::string_view name, const shoal::FieldValue& value) {
    if (fields++ < most_fields) text += fmt::format("{}{}={}", separator, name, value_text(value));
  });
  if (error) return schema->name + ": " + *error;
  if (fields > most_fields) text += fmt::format("{}... {} more", separator, fields - most_fields);
  return text;
}

void print_table(std::map<std::string, Seen>& channels, const shoal::MessageTypes& types, double since_s,
                 bool terminal) {
  if (terminal) std::cout << "\033[H\033[2J";
  std::cout << fmt::format("{:<32} {:>9} {:>9} {:>9}  last message\n", "channel", "messages", "Hz", "bytes");
  for (auto& [channel, seen] : channels) {
    const double rate_hz = static_cast<double>(seen.messages - seen.messages_before) / since_s;
    seen.messages_before = seen.messages;
    std::string line = fmt::format("{:<32} {:>9} {:>9.1f} {:>9}  {}", one_line(channel), seen.messages, rate_hz,
                                   seen.last.size(), decoded(types, seen.last, 6, " "));
    if (terminal && line.size() > 150) line = line.substr(0, 147) + "...";
    std::cout << line << '\n';
  }
  std::cout << std::flush;
}

/// True once nobody can read what is printed: the next write would end us, but there may be none for long.
bool output_closed() {
  pollfd output{STDOUT_FILENO, 0, 0};
  return !std::cout || (poll(&output, 1, 0) > 0 && (output.revents & POLLERR) != 0);
}

int spy(const SpyArguments& arguments) {
  const shoal::MessageTypes types = shoal::types_with(arguments.lcm_files);
  bridges::LcmListener listener(arguments.lcm_url);
  if (arguments.channel.empty())
    listener.listen_to_all();
  else
    listener.listen(arguments.channel);
  catch_signals(false);
  const bool terminal = isatty(STDOUT_FILENO) != 0;
  std::map<std::string, Seen> channels;
  const Clock::time_point begin = Clock::now();
  Clock::time_point shown = begin;
  const auto over = [&] {
    return caught_signal() != 0 || output_closed() ||
           (arguments.duration_s > 0 && Clock::now() - begin > std::chrono::duration<double>(arguments.duration_s));
  };
  bridges::WaitNotice notice("shoal spy: waiting for messages on " +
                             (arguments.channel.empty() ? "any channel" : "'" + arguments.channel + "'") + ", at " +
                             listener.url());
  while (!over()) {
    if (channels.empty()) notice.look();
    if (const auto message = listener.next(std::chrono::milliseconds(100))) {
      Seen& seen = channels[message->channel];
      ++seen.messages;
      seen.bytes += message->payload.size();
      seen.last = message->payload;
      if (!arguments.channel.empty())
        std::cout << decoded(types, message->payload, 10000, "\n  ") << '\n' << std::flush;
    }
    const double since_s = std::chrono::duration<double>(Clock::now() - shown).count();
    if (arguments.channel.empty() && terminal && since_s > 0.5) {
      print_table(channels, types, since_s, true);
      shown = Clock::now();
    }
  }
  if (arguments.channel.empty() && !terminal)
    print_table(channels, types, std::chrono::duration<double>(Clock::now() - shown).count(), false);
  if (channels.empty()) std::cerr << "shoal spy: no message came; is something running? see shoal doctor\n";
  return exit_ok;
}

}  // namespace

void add_spy_command(CLI::App& app, int& exit_code) {
  CLI::App* command = app.add_subcommand("spy", "Watch the live channels: rates and decoded fields");
  const auto arguments = std::make_shared<SpyArguments>();
  command->add_option("CHANNEL", arguments->channel, "show every message of this channel in full");
  command->add_option("--duration", arguments->duration_s, "wall seconds; 0: until Ctrl-C")->check(number_from(0, 1e9));
  command->add_option("--lcm-url", arguments->lcm_url, "instead of LCM_DEFAULT_URL and the default");
  command->add_option("--types", arguments->lcm_files, ".lcm files of types that are not Shoal's");
  add_plugin_option(*command);
  command->footer("Examples:\n  shoal spy\n  shoal spy rover1.odometry\n  shoal spy --duration 5 > channels.txt");
  command->callback([arguments, &exit_code] { exit_code = spy(*arguments); });
}

}  // namespace tools
