// SPDX-License-Identifier: BSD-3-Clause
#include <spdlog/fmt/fmt.h>

#include <algorithm>
#include <fstream>
#include <iostream>
#include <memory>

#include "tools/shoal/commands/commands.hpp"
#include "verification/bench/bench_figures.hpp"

namespace tools {

namespace {

struct BenchArguments {
  std::vector<std::string> scenes{"land"};
  std::vector<int> vehicles;  // empty: the usual numbers of each scene
  std::vector<int> threads{1};
  verification::BenchOptions options;
  std::string csv;
  bool world = false;
};

std::vector<std::string> bench_scene_names() {
  std::vector<std::string> names;
  for (const verification::BenchScene& scene : verification::bench_scenes()) names.push_back(scene.name);
  return names;
}

/// Returns the scenes by their names in order; `all`: each.
std::vector<const verification::BenchScene*> chosen_scenes(const std::vector<std::string>& names) {
  std::vector<const verification::BenchScene*> scenes;
  for (const std::string& name : names)
    for (const verification::BenchScene& scene : verification::bench_scenes())
      if (name == "all" || scene.name == name) scenes.push_back(&scene);
  return scenes;
}

/// CSV file of the figures; does nothing without a name.
class BenchCsv {
 public:
  explicit BenchCsv(const std::string& path) : path_(path) {
    if (path_.empty()) return;
    out_.open(path_);
    write(verification::bench_csv_head());
  }
  void write(const std::string& line) {
    if (path_.empty()) return;
    if (!(out_ << line << std::flush)) throw std::runtime_error("cannot write " + path_);
  }

 private:
  std::string path_;
  std::ofstream out_;
};

void bench(const BenchArguments& arguments) {
  BenchCsv csv(arguments.csv);
  for (const verification::BenchScene* scene : chosen_scenes(arguments.scenes)) {
    std::cout << fmt::format("{}: {}\n{:>9} {:>7} {:>8} {:>9} {:>24} {:>16}  {:<16}  {}\n", scene->name, scene->about,
                             "vehicles", "threads", "load s", "memory kB", "CPU ms per vehicle and s",
                             "real-time factor", "run hash", "largest parts");
    for (const int vehicles : arguments.vehicles.empty() ? scene->usual_sizes : arguments.vehicles)
      for (const int threads : arguments.threads) {
        if (!(std::cout << std::flush)) return;  // the output was closed
        const verification::BenchFigures figures =
            verification::measure_bench_apart(*scene, vehicles, threads, arguments.options);
        std::cout << fmt::format("{:>9} {:>7} {:>8.3f} {:>9.1f} {:>24.4g} {:>16.4g}  {:016x}  {}\n", vehicles,
                                 figures.threads, figures.load_s, figures.memory_kB, figures.cpu_ms_per_vehicle_s,
                                 figures.real_time_factor, figures.run_hash, verification::largest_parts(figures));
        const std::string advice = figures.shared_work.advice(figures.threads);
        std::cout << (advice.empty() ? "" : fmt::format("{:>9} {}\n", "", advice)) << std::flush;
        csv.write(verification::bench_csv_line(*scene, figures));
      }
  }
}

/// Prints the world of each scene, with the first number of vehicles.
void print_worlds(const BenchArguments& arguments) {
  for (const verification::BenchScene* scene : chosen_scenes(arguments.scenes))
    std::cout << scene->world_text((arguments.vehicles.empty() ? scene->usual_sizes : arguments.vehicles).front());
}

}  // namespace

static void add_bench_command(CLI::App& app, int& exit_code) {
  CLI::App* command = app.get_subcommand("bench");
  const auto arguments = std::make_shared<BenchArguments>();
  add_log_level_option(*command);
  // Arguments and options.
  std::vector<std::string> names = bench_scene_names();
  names.emplace_back("all");
  command->add_option("SCENE", arguments->scenes, "scenes: " + command_line::alternatives(names))
      ->check(one_of(names).description(""))
      ->default_str("land");
  command
      ->add_option("--vehicles,--robots", arguments->vehicles,
                   "number of vehicles; a list such as 1,10,100 gives one run each")
      ->type_name("N,N,...")
      ->delimiter(',')
      ->type_size(1)
      ->allow_extra_args(false)
      ->check(whole_from(1, 100000).description("each from 1 to 100000"))
      ->default_str("by scene");
  command
      ->add_option("--threads", arguments->threads,
                   "number of threads; a list such as 1,2,4 gives one run each; 0: one per processor")
      ->type_name("N,N,...")
      ->delimiter(',')
      ->type_size(1)
      ->allow_extra_args(false)
      ->check(whole_from(0, 256).description("each from 0 to 256"))
      ->default_str("1");
  command->add_option("--warm-up", arguments->options.warm_up_s, "simulated seconds before the measurement")
      ->type_name("S")
      ->check(number_from(0, 1e9))
      ->capture_default_str();
  command->add_option("--measure", arguments->options.measure_s, "simulated seconds measured")
      ->type_name("S")
      ->check(number_from(0.001, 1e9))
      ->capture_default_str();
  command->add_option("--csv", arguments->csv, "also write the figures to this file, with the time of each stage")
      ->type_name("FILE");
  command->add_flag("--print-world", arguments->world, "print the world file of the scene instead");
  add_set_option(*command, arguments->options.sets);
  std::vector<std::string> notes;
  for (const verification::BenchScene& scene : verification::bench_scenes())
    notes.push_back(scene.name + ": " + scene.about + ".");
  command_line::set_help_end(*command, {{"shoal bench", "shoal bench sea naive --vehicles 100,1000 --measure 5",
                                         "shoal bench land --vehicles 1000 --threads 1,2,4 --csv land.csv",
                                         "shoal bench land --vehicles 100 --print-world > land.yaml"},
                                        {{0, "success"}, {2, "wrong usage"}, {4, "out of memory, or a file error"}},
                                        notes});
  // Action.
  command->callback([arguments, &exit_code] {
    if (arguments->world)
      print_worlds(*arguments);
    else
      bench(*arguments);
    exit_code = exit_ok;
  });
}

SHOAL_COMMAND(measure, "bench", "Measure the speed of this machine on standard scenes", add_bench_command);

}  // namespace tools
