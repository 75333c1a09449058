// SPDX-License-Identifier: BSD-3-Clause
#include <spdlog/spdlog.h>

#include <iostream>

#include "bridges/base/bus_error.hpp"
#include "bridges/lcm/lcm_connection.hpp"
#include "tests/fuzz/fuzz_input.hpp"
#include "tools/command_line/checks.hpp"
#include "tools/command_line/declared_options.hpp"
#include "tools/command_line/parse.hpp"

// Words of command lines: options with their checks, those of a declaration with their lists, LCM URLs.

namespace {

void parse_line(const std::string& text) {
  CLI::App app("fuzz", "shoal");
  app.require_subcommand(1);
  std::string name, world;
  double number = 0;
  std::int64_t seed = 0;
  std::vector<std::string> sets;
  bool flag = false;
  CLI::App* run = app.add_subcommand("run", "Run a world");
  run->add_option("world", world, "world file");
  run->add_option("--duration", number, "seconds")->check(command_line::number_from(0, 1e9));
  run->add_option("--threads,-t", seed, "threads")->check(command_line::whole_from(0, 256));
  run->add_option("--seed", seed, "seed")->check(command_line::seed());
  run->add_option("--bus", name, "bus")->check(command_line::one_of({"lcm", "none"}));
  run->add_option("--set", sets, "set")->check(command_line::setting());
  run->add_option("--record", name, "record")->check(command_line::not_empty());
  run->add_flag("--quiet,-q", flag, "quiet");
  CLI::App* log = app.add_subcommand("log", "Logs");
  log->require_subcommand(1);
  log->add_subcommand("info", "Info")->add_option("log", name, "log")->required();

  std::vector<std::string> words;
  std::size_t at = 0;
  while (at <= text.size()) {
    const std::size_t end = std::min(text.find('\n', at), text.size());
    words.push_back(text.substr(at, end - at));
    at = end + 1;
  }
  command_line::Arguments arguments = command_line::read_arguments(app, words);
  command_line::command_path(*arguments.command);
  if (arguments.help || !arguments.wrong.empty()) return;
  fuzz::allow<CLI::ParseError, command_line::UsageError>([&] { app.parse(std::move(arguments.for_cli11)); });
}

/// What programs print is of no use here.
class Mute {
 public:
  Mute() : out_(std::cout.rdbuf(nullptr)), err_(std::cerr.rdbuf(nullptr)) {}
  ~Mute() {
    std::cout.rdbuf(out_);
    std::cerr.rdbuf(err_);
  }
  Mute(const Mute&) = delete;
  Mute& operator=(const Mute&) = delete;

 private:
  std::streambuf *out_, *err_;
};

/// The options of a declaration, whose lists are JSON.
void parse_declared(const std::string& text) {
  CLI::App app("fuzz", "pilot");
  command_line::DeclaredOptions options(app);
  std::vector<std::vector<double>> lists;
  std::vector<double> list;
  std::string word = "a";
  std::optional<double> number;
  options.tuples(
      "waypoints_m", {"x", "y"}, 1, sim::any_place(), [&](const auto& given) { lists = given; }, "");
  options.tuple(
      "start_m", {"x", "y"}, sim::any_place(), [&](const auto& given) { list = given; }, "");
  options.choice("word", word, {"a", "b"}, "");
  options.number("speed_mps", number, 0, 10, "");
  std::vector<std::string> words = {"pilot"};
  std::size_t at = 0;
  while (at <= text.size()) {
    const std::size_t end = std::min(text.find('\n', at), text.size());
    words.push_back(text.substr(at, end - at));
    at = end + 1;
  }
  std::vector<const char*> pointers;
  for (const std::string& each : words) pointers.push_back(each.c_str());
  const Mute mute;
  options.parse(static_cast<int>(pointers.size()), pointers.data());
  for (const auto& each : lists) fuzz::require(each.size() == 1 || each.size() == 2, "a tuple has its columns");
  fuzz::require(list.empty() || list.size() == 2, "a tuple has its columns");
}

}  // namespace

SHOAL_FUZZ_TARGET(command_line) {
  fuzz::Reader reader(input);
  const std::size_t kind = reader.below(3);
  const std::string text(fuzz::text_of(reader.rest()));
  fuzz::allow<std::invalid_argument, bridges::BusError>([&] {
    switch (kind) {
      case 0:
        parse_line(text);
        break;
      case 1:
        if (text.find('\0') == text.npos) bridges::lcm_endpoint(bridges::resolve_lcm_url(text));
        break;
      default:
        parse_declared(text);
    }
  });
}
