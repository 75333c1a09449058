// SPDX-License-Identifier: BSD-3-Clause
#include <spdlog/fmt/fmt.h>

#include <iostream>
#include <memory>

#include "sim/base/thread_pool.hpp"
#include "tools/experiment/bench/scale_scene.hpp"
#include "tools/shoal/commands.hpp"

namespace tools {

namespace {

struct BenchArguments {
  std::vector<int> robots{1, 10, 100, 1000};
  ScaleOptions scale;
};

void bench(const BenchArguments& arguments) {
  const int threads = sim::ThreadPool(arguments.scale.threads).threads();
  std::cout << fmt::format("scale scene: wandering rovers, 180 rays at 10 Hz each, step 0.01 s, {},\nin-process bus\n",
                           threads == 1 ? "one thread" : fmt::format("{} threads", threads))
            << fmt::format("{:>7} {:>9} {:>24} {:>17} {:>17}\n", "robots", "load s", "CPU ms per robot second",
                           "real-time factor", "run hash");
  for (const int robots : arguments.robots) {
    if (!(std::cout << std::flush)) return;  // the output was closed
    const ScaleFigures figures = measure_scale(robots, arguments.scale);
    std::cout << fmt::format("{:>7} {:>9.3f} {:>24.3f} {:>17.2f}  {:016x}\n", robots, figures.load_s,
                             figures.cpu_ms_per_robot_second, figures.real_time_factor, figures.run_hash)
              << std::flush;
  }
}

}  // namespace

void add_bench_command(CLI::App& app, int& exit_code) {
  CLI::App* command = app.add_subcommand("bench", "Measure the speed of this machine on the scale scene");
  const auto arguments = std::make_shared<BenchArguments>();
  add_log_level_option(*command);
  // Options.
  command->add_option("--robots", arguments->robots, "how many; several runs one after the other: 1,10,100")
      ->type_name("N,N,...")
      ->delimiter(',')
      ->check(whole_from(1, 100000).description("each from 1 to 100000"))
      ->default_str("1,10,100,1000");
  command->add_option("--warm-up", arguments->scale.warm_up_s, "simulated seconds before the measurement")
      ->type_name("S")
      ->check(number_from(0, 1e9))
      ->capture_default_str();
  command->add_option("--measure", arguments->scale.measure_s, "simulated seconds measured")
      ->type_name("S")
      ->check(number_from(0.001, 1e9))
      ->capture_default_str();
  add_threads_option(*command, arguments->scale.threads);
  add_set_option(*command, arguments->scale.sets);
  command_line::set_help_end(*command, {{"shoal bench", "shoal bench --robots 100 --measure 60",
                                         "shoal bench --robots 1000 --threads 2 --set physics.rays=ode"},
                                        {{0, "success"}, {2, "wrong usage"}},
                                        {}});
  // Action.
  command->callback([arguments, &exit_code] {
    bench(*arguments);
    exit_code = exit_ok;
  });
}

}  // namespace tools
