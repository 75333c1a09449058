// SPDX-License-Identifier: BSD-3-Clause
#include <spdlog/fmt/fmt.h>

#include <CLI/App.hpp>
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <iostream>
#include <stdexcept>
#include <string_view>

#include "autonomy/cooperative/driver/estimate_files.hpp"
#include "tools/command_line/checks.hpp"
#include "tools/command_line/declared_options.hpp"
#include "tools/command_line/help.hpp"
#include "tools/command_line/parse.hpp"
#include "tools/programs/navigation/nav_commands.hpp"
#include "tools/programs/navigation/score_file.hpp"

namespace navigation {

namespace {

struct OfflineOptions {
  std::string log, out, scores;
  std::vector<std::string> algorithms;
  std::optional<double> period_s;
  std::string sound;
  double from_s = 0;
  std::optional<std::size_t> frame_bytes;
  double gate = NavOptions{}.gate;
};

void print_scores(const NavRecord& record, const OfflineRun& run, double from_s) {
  for (std::size_t i = 0; i < run.estimates.size(); ++i) {
    const NavScore score = score_of(run.estimates[i], record.truth[i], record.epoch_utime, std::llround(1e6 * from_s));
    fmt::print("{:10} {:12} {:9.3f} {:8.2f} {:7.3f} {:8}\n", run.algorithm, record.team->vehicles[i].name, score.rms_m,
               score.nees, score.inside_95, score.samples);
  }
}

/// Options of a vehicle: those of its program in the run, unless the command line has others.
NavOptions options_of(const OfflineOptions& options, const NavArguments& arguments, std::size_t frame_bytes) {
  NavOptions of_vehicle = arguments.applied_to({});
  of_vehicle.frame_bytes = frame_bytes;
  of_vehicle.gate = options.gate;
  if (options.period_s) of_vehicle.period_us = std::llround(1e6 * *options.period_s);
  if (!options.sound.empty()) of_vehicle.sound = sound_models().at(options.sound);
  return of_vehicle;
}

std::size_t frame_bytes_of(const OfflineOptions& options, const NavRecord& record) {
  return options.frame_bytes.value_or(record.frame_bytes > 0 ? record.frame_bytes : NavOptions{}.frame_bytes);
}

/// Runs the algorithms, and prints and writes what they give.  One of several that cannot work here is left out.
void navigate_all(const OfflineOptions& options, const NavRecord& record) {
  const std::size_t frame_bytes = frame_bytes_of(options, record);
  std::vector<NavOptions> by_vehicle;
  for (const NavArguments& arguments : record.arguments)
    by_vehicle.push_back(options_of(options, arguments, frame_bytes));
  std::printf("%s: %zu vehicles, frames of %zu bytes\n", record.world.c_str(), record.team->vehicles.size(),
              frame_bytes);
  std::printf("%-10s %-12s %9s %8s %7s %8s\n", "algorithm", "vehicle", "rms_m", "NEES", "in_95", "samples");
  ScoreFile scores(record, frame_bytes, options.from_s);
  std::size_t refused = 0;
  for (const std::string& name : options.algorithms) {
    try {
      const OfflineRun run = run_offline(record, algorithm_named(name), by_vehicle);
      print_scores(record, run, options.from_s);
      fmt::print("{:10} {} frames, {} ranges, {:.1f} us per event\n", name, run.frames_said, run.ranges,
                 1e6 * run.cpu_s / static_cast<double>(std::max<std::size_t>(run.events, 1)));
      if (!options.out.empty()) write_estimates(options.out, record, run);
      scores.add(run);
    } catch (const EstimatorFailure&) {
      throw;
    } catch (const std::invalid_argument& error) {
      if (++refused == options.algorithms.size()) throw;
      std::printf("%-10s left out: %s\n", name.c_str(), error.what());
      scores.leave_out(name, error.what());
    }
  }
  if (!options.scores.empty()) scores.write(options.scores);
}

/// Refuses wrong options before the work.
void check_options(const OfflineOptions& options) {
  for (auto name = options.algorithms.begin(); name != options.algorithms.end(); ++name) {
    algorithm_named(*name);
    if (std::find(options.algorithms.begin(), name, *name) != name)
      throw std::invalid_argument("--algorithm: '" + *name + "' is named twice");
  }
  std::error_code none;
  const auto out = std::filesystem::status(options.out, none);
  if (!options.out.empty() && std::filesystem::exists(out) && !std::filesystem::is_directory(out))
    throw std::invalid_argument("--out: '" + options.out + "' is a file, but must be a folder, or a new one");
}

/// Says what is wrong with a record that was read.  Throws std::invalid_argument when nothing of it is scored.
void check_record(const OfflineOptions& options, const NavRecord& record) {
  for (const std::string& problem : record.problems)
    std::cerr << "shoal-nav: " << options.log << ": " << problem << "; the scores are of the rest\n";
  const double end_s = 1e-6 * static_cast<double>(record.end_us);
  if (options.from_s > end_s)
    throw std::invalid_argument(
        fmt::format("--from-s must be at most {:g}, the end of the record, got {:g}", end_s, options.from_s));
}

void navigate(const OfflineOptions& options) {
  check_options(options);
  const NavRecord record = read_record(options.log);
  check_record(options, record);
  navigate_all(options, record);
}

}  // namespace

bool is_offline(int argc, const char* const* argv) {
  return std::any_of(argv + 1, argv + argc,
                     [](std::string_view word) { return word == "--log" || word.starts_with("--log="); });
}

int run_offline_command(int argc, const char* const* argv) {
  OfflineOptions options;
  CLI::App app{"Navigates all vehicles of a recorded run by other algorithms.", "shoal-nav"};
  app.add_option("--log", options.log, "record of a run, an LCM event log or MCAP file")->type_name("FILE")->required();
  command_line::add_name_list(app, "--algorithm", options.algorithms,
                              "algorithms, each for all vehicles on the recorded deliveries")
      ->required();
  command_line::add_plugin_option(app);
  app.add_option("--out", options.out, "folder for the estimates, as LCM event log, CSV, TUM and MR.CLAM files")
      ->type_name("DIR");
  app.add_option("--scores", options.scores, "file for the scores as JSON, with all digits")->type_name("FILE");
  app.add_option("--period-s", options.period_s, "simulated seconds between two estimates; default: as in the run")
      ->type_name("S")
      ->check(command_line::number_from(0.001, 10));
  app.add_option("--from-s", options.from_s, "scores begin at this simulated time")
      ->type_name("S")
      ->check(command_line::number_from(0, 1e9));
  app.add_option("--sound", options.sound, "how sound is assumed to travel: straight or rays; default: as in the run")
      ->type_name("MODEL")
      ->check(CLI::IsMember(sound_models()));
  app.add_option("--frame-bytes", options.frame_bytes, "length of the frames; default: as in the run")
      ->type_name("N")
      ->check(command_line::whole_from(11, 255));
  app.add_option("--gate", options.gate, "squared innovation over its variance above which a range is refused; 0: none")
      ->type_name("X")
      ->check(command_line::number_from(0, 1e9));
  command_line::set_help_end(app, {{"shoal-nav --log run.lcm --algorithm dr,naive,ci,iu,cekf --from-s 120 --out nav"},
                                   {{0, "done"}, {2, "wrong usage"}, {4, "the log cannot be read"}},
                                   {}});
  if (const auto exit_code = command_line::parse(app, argc, argv)) return *exit_code;
  navigate(options);
  return 0;
}

}  // namespace navigation
