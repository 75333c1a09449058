#include <spdlog/fmt/fmt.h>

#include <iostream>
#include <memory>

#include "sim/thread_pool.hpp"
#include "tools/experiment/scale_scene.hpp"
#include "tools/shoal/commands.hpp"

namespace tools {

namespace {

struct BenchArguments {
  std::vector<int> robots{1, 10, 100, 1000};
  ScaleOptions scale;
};

void bench(const BenchArguments& arguments) {
  const int threads = sim::ThreadPool(arguments.scale.threads).threads();
  std::cout << fmt::format("scale scene: wandering rovers, 180 rays at 10 Hz each, step 0.01 s, {}, in-process bus\n",
                           threads == 1 ? "one thread" : fmt::format("{} threads", threads))
            << fmt::format("{:>7} {:>9} {:>28} {:>18} {:>18}\n", "robots", "load s", "CPU ms per robot second",
                           "real-time factor", "run hash");
  for (const int robots : arguments.robots) {
    const ScaleFigures figures = measure_scale(robots, arguments.scale);
    std::cout << fmt::format("{:>7} {:>9.3f} {:>28.3f} {:>18.2f}   {:016x}\n", robots, figures.load_s,
                             figures.cpu_ms_per_robot_second, figures.real_time_factor, figures.run_hash)
              << std::flush;
  }
}

}  // namespace

void add_bench_command(CLI::App& app, int& exit_code) {
  CLI::App* command = app.add_subcommand("bench", "Measure the speed of this machine on the scale scene");
  const auto arguments = std::make_shared<BenchArguments>();
  command->add_option("--robots", arguments->robots, "how many; several runs one after the other")
      ->delimiter(',')
      ->check(CLI::Range(1, 100000));
  command->add_option("--warm-up", arguments->scale.warm_up_s, "simulated seconds before the measurement")
      ->check(number_from(0, 1e9));
  command->add_option("--measure", arguments->scale.measure_s, "simulated seconds measured")
      ->check(number_from(0.001, 1e9));
  command->add_option("--threads", arguments->scale.threads, "threads that follow rays; 0: one for each processor")
      ->check(CLI::Range(0, 256));
  command->add_option("--set", arguments->scale.sets, "path=value: change a value of the scene")
      ->type_size(1)
      ->allow_extra_args(false);
  command->footer(
      "Examples:\n  shoal bench\n  shoal bench --robots 100 --measure 60\n"
      "  shoal bench --robots 1000 --threads 2 --set physics.rays=ode");
  command->callback([arguments, &exit_code] {
    bench(*arguments);
    exit_code = exit_ok;
  });
}

}  // namespace tools
