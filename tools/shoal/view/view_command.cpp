// SPDX-License-Identifier: BSD-3-Clause
#include <spdlog/fmt/fmt.h>
#include <unistd.h>

#include <chrono>
#include <cmath>
#include <filesystem>
#include <iostream>
#include <memory>
#include <optional>
#include <thread>

#include "bridges/lcm/lcm_listener.hpp"
#include "experiment/process/browser.hpp"
#include "experiment/process/signals.hpp"
#include "experiment/run/version.hpp"
#include "experiment/world_files/world_by_name.hpp"
#include "shoal/message_codec.hpp"
#include "shoal/sim_control_request_t.hpp"
#include "sim/base/log.hpp"
#include "sim/config/diagnostics.hpp"
#include "sim/config/message_text.hpp"
#include "tools/shoal/commands/commands.hpp"
#include "tools/shoal/options/shared_options.hpp"
#include "viewer/resimulate/resimulated_run.hpp"
#include "viewer/server/bus_view.hpp"
#include "viewer/server/log_view.hpp"

namespace tools {

namespace {

struct ViewArguments {
  std::vector<std::string> logs;
  bool resimulate = false;
  bool launch = false;
  sim::LoadOptions load;
  int threads = 0;
  std::string lcm_url;
  std::optional<double> duration_s;
  bool open = false;
  experiment::ViewOptions view;
};

using Clock = std::chrono::steady_clock;

constexpr std::chrono::milliseconds tick{33};

/// Wall time until which the page is served.
class Deadline {
 public:
  explicit Deadline(const std::optional<double>& duration_s) {
    if (duration_s) end_ = Clock::now() + std::chrono::milliseconds(std::llround(1000 * *duration_s));
  }
  bool goes_on() const { return experiment::caught_signal() == 0 && (!end_ || Clock::now() < *end_); }

 private:
  std::optional<Clock::time_point> end_;
};

void announce(const experiment::ViewOptions& view, const std::string& url) {
  std::cout << "live page: " << url << "\nCtrl-C ends it\n" << std::flush;
  if (view.opened) view.opened(url);
}

/// Reads a log and prints what it is.
viewer::LogIndex read_index(const std::string& log) {
  const bool terminal = isatty(STDERR_FILENO) != 0;
  const auto begin = Clock::now();
  viewer::LogIndex index(log, [&](double share) {
    if (terminal) std::cerr << fmt::format("\r{}: {:.0f} % read", log, 100 * share) << std::flush;
  });
  if (terminal) std::cerr << "\r\033[K";
  for (const std::string& problem : index.problems()) sim::log_warn("{}: {}", log, problem);
  std::cout << fmt::format("{}: {}, {:.3f} to {:.3f} s, {} events of the world, read in {:.2f} s\n", log,
                           index.world().empty() ? "a run" : "world " + index.world(),
                           static_cast<double>(index.start_us()) / 1e6, static_cast<double>(index.end_us()) / 1e6,
                           index.occasions().size(), std::chrono::duration<double>(Clock::now() - begin).count());
  return index;
}

/// Finds and prints where two logs differ first.
std::optional<viewer::LogDifference> compare(const ViewArguments& arguments, const viewer::LogIndex& a,
                                             const viewer::LogIndex& b) {
  const auto difference = viewer::first_difference(arguments.logs[0], a, arguments.logs[1], b);
  if (!difference)
    std::cout << "no difference over the common time span\n";
  else
    std::cout << fmt::format("first difference: {}{:.3f} s, by {}\n",
                             difference->step ? fmt::format("step {}, ", *difference->step) : "",
                             static_cast<double>(difference->time_us) / 1e6, difference->by);
  return difference;
}

int view_log(const ViewArguments& arguments) {
  const std::string& log = arguments.logs.front();
  const viewer::LogIndex index = read_index(log);
  std::optional<viewer::LogIndex> other;
  if (arguments.logs.size() > 1) other = read_index(arguments.logs[1]);
  viewer::LogView view(log, index, arguments.view, experiment::short_version());
  if (other) view.compare_with(arguments.logs[1], *other, compare(arguments, index, *other));
  announce(arguments.view, view.url());
  // Play in steps of wall time.
  const Deadline deadline(arguments.duration_s);
  for (auto before = Clock::now(); deadline.goes_on();) {
    std::this_thread::sleep_until(before + tick);
    const auto now = Clock::now();
    view.advance(std::chrono::duration<double>(now - before).count());
    before = now;
  }
  return exit_ok;
}

int view_again(const ViewArguments& arguments) {
  viewer::ResimulatedRun::Options options;
  options.log = arguments.logs.front();
  options.load = arguments.load;
  options.threads = arguments.threads;
  options.view = arguments.view;
  options.launch = arguments.launch;
  options.lcm_url = arguments.lcm_url;
  const auto run = std::make_unique<viewer::ResimulatedRun>(options, experiment::short_version());
  std::cout << fmt::format("{}: world {}, re-simulated to t = {:.3f} s; programs: {}\n", options.log,
                           run->world().config().name, run->end_s(), run->programs());
  for (const std::string& command : run->commands())
    std::cout << "a branch starts: " << sim::printable(sim::shortened(command, 300)) << '\n';
  announce(arguments.view, run->url());
  const Deadline deadline(arguments.duration_s);
  run->run([&] { return deadline.goes_on(); });
  return exit_ok;
}

/// Asks a run that has already begun for its scene.
void ask_for_scene(bridges::LcmListener& lcm) {
  shoal::sim_control_request_t request{};
  request.client = fmt::format("shoal-view-{}", getpid());
  request.command = "scene";
  request.id = 1;
  sim::Bytes payload;
  shoal::encode_into(request, payload);
  lcm.publish("sim.control", payload);
}

int view_bus(const ViewArguments& arguments) {
  bridges::LcmListener lcm(arguments.lcm_url);
  lcm.listen_to_all();
  viewer::BusView view(arguments.view, experiment::short_version(), lcm.url());
  announce(arguments.view, view.url());
  constexpr std::chrono::seconds ask_interval{2};
  Clock::time_point next_flush = Clock::now(), next_request = next_flush;
  int requests = 0;
  const Deadline deadline(arguments.duration_s);
  while (deadline.goes_on()) {
    const auto now = Clock::now();
    if (now >= next_flush) {
      view.flush();
      next_flush = now + tick;
    }
    // A run publishes its scene only every 10 s; asking for it shows the page at once.
    if (!view.has_scene() && now >= next_request) {
      ask_for_scene(lcm);
      next_request = now + ask_interval;
      // The first request may have been too early; after two the user is notified.
      if (++requests == 2)
        sim::log_info(
            "waiting for sim.scene: a run sends it on request; a played log repeats it as recorded, every 10 s or, if "
            "it is large, less often; `shoal view LOG` shows a log at once");
    }
    const auto wait = std::chrono::duration_cast<std::chrono::milliseconds>(next_flush - Clock::now());
    if (const auto message = lcm.next(std::max(wait, std::chrono::milliseconds(1))))
      view.message(message->channel, message->payload);
  }
  return exit_ok;
}

/// Throws sim::ConfigError for a world, which is viewed in another way.
void refuse_world(const std::string& given) {
  const bool is_world = given.ends_with(".yaml") || given.ends_with(".yml");
  bool is_shipped = false;
  for (const experiment::ShippedFile& world : experiment::shipped_files(experiment::ShippedKind::world))
    is_shipped |= world.name == given;
  if (!is_world && (!is_shipped || std::filesystem::exists(given))) return;
  sim::throw_config_error({}, "'" + sim::shortened(sim::printable(given)) + "'",
                          "is a world, but this command shows logs; `shoal run " + given + " --view` shows its run");
}

int view(ViewArguments& arguments) {
  if (arguments.launch && !arguments.resimulate) throw CLI::ValidationError("--launch", "needs --resimulate");
  if (!arguments.logs.empty() && !arguments.lcm_url.empty() && !arguments.launch)
    throw CLI::ValidationError("--lcm-url", "cannot be given with a LOG, except with --launch");
  if (arguments.resimulate && arguments.logs.size() != 1)
    throw CLI::ValidationError("--resimulate", "needs one LOG, got " + std::to_string(arguments.logs.size()));
  for (const std::string& log : arguments.logs) refuse_world(log);
  experiment::catch_signals(true);
  experiment::Browser browser;
  if (arguments.open) arguments.view.opened = [&browser](const std::string& url) { browser.open(url); };
  if (arguments.resimulate) return view_again(arguments);
  return arguments.logs.empty() ? view_bus(arguments) : view_log(arguments);
}

}  // namespace

static void add_view_command(CLI::App& app, int& exit_code) {
  CLI::App* command = app.get_subcommand("view");
  const auto arguments = std::make_shared<ViewArguments>();
  add_log_level_option(*command);
  command->add_option("LOG", arguments->logs, "log of a run, or two to compare; default: show what is on the bus")
      ->expected(0, 2);
  command->add_flag("--resimulate", arguments->resimulate,
                    "re-simulate the world of the log, to see what was not recorded and to branch from it");
  command->add_flag("--launch", arguments->launch,
                    "with --resimulate: a branch starts the programs that the world of the log names");
  add_allow_path_option(*command, arguments->load);
  add_threads_option(*command, arguments->threads);
  add_lcm_url_option(*command, arguments->lcm_url);
  command->add_option("--duration", arguments->duration_s, "seconds of wall time; default: until Ctrl-C")
      ->type_name("S")
      ->check(number_from(0.001, 1e9));
  add_open_option(*command, arguments->open);
  add_page_options(*command, arguments->view);
  command_line::set_help_end(
      *command, {{"shoal view coop.lcm", "shoal view before.lcm after.lcm", "shoal view coop.lcm --resimulate",
                  "shoal view coop.lcm --resimulate --launch", "shoal view",
                  "shoal view --lcm-url udpm://239.255.76.67:7668?ttl=0"},
                 {{0, "ended by Ctrl-C or --duration"},
                  {2, "wrong usage"},
                  {4, "the log cannot be read or has nothing to show, or the bus or the port fails"}},
                 {}});
  command->callback([arguments, &exit_code] { exit_code = view(*arguments); });
}

SHOAL_COMMAND(look, "view", "Serve a live page of a log, or of a run in another process, in 3-D", add_view_command);

}  // namespace tools
