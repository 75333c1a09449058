// SPDX-License-Identifier: BSD-3-Clause
#include "verification/bench/bench_figures.hpp"

#include <spdlog/fmt/fmt.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <ctime>
#include <fstream>
#include <numeric>

#include "sim/acoustics/channel.hpp"
#include "sim/base/thread_pool.hpp"
#include "sim/world/world_state.hpp"
#include "verification/bench/bench_run.hpp"

namespace verification {

namespace {

double cpu_seconds() {
  timespec time{};
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &time);
  return static_cast<double>(time.tv_sec) + 1e-9 * static_cast<double>(time.tv_nsec);
}

double wall_seconds() {
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

double resident_kB() {
  std::ifstream in("/proc/self/statm");
  double total = 0, resident = 0;
  in >> total >> resident;
  return resident * static_cast<double>(sysconf(_SC_PAGESIZE)) / 1000;
}

/// Runs on for a while, and measures the stages and counts the work; apart from the figures above, because reading a
/// clock ten times a step takes as long as a step of one vehicle.
void measure_parts(BenchRun& run, double time_s, BenchFigures& figures) {
  sim::StageTimes stages;
  run.measure_stages(&stages);
  const std::int64_t messages = run.bus().counts().published, hearers = run.world().acoustics().flights();
  const sim::Time begin = run.world().now(), end = begin + sim::from_seconds(time_s);
  std::int64_t contacts = 0;
  while (run.world().now() < end) {
    run.step();
    contacts += run.world().physics().last_step().contacts;
  }
  run.measure_stages(nullptr);
  const double vehicle_s = figures.vehicles * sim::to_seconds(run.world().now() - begin);
  for (std::size_t i = 0; i < stages.cpu_s.size(); ++i) figures.part_ms[i] = 1e3 * stages.cpu_s[i] / vehicle_s;
  figures.part_ms.back() = 1e3 * run.programs_s() / vehicle_s;
  figures.contacts = static_cast<double>(contacts) / static_cast<double>(stages.steps) / figures.vehicles;
  figures.rays_per_s = static_cast<double>(stages.rays) / vehicle_s;
  figures.messages_per_s = static_cast<double>(run.bus().counts().published - messages) / vehicle_s;
  figures.hearers_per_s = static_cast<double>(run.world().acoustics().flights() - hearers) / vehicle_s;
}

}  // namespace

const char* bench_part_name(std::size_t part) {
  return part < sim::step_stage_names.size() ? sim::step_stage_names[part] : "programs";
}

BenchFigures measure_bench(const BenchScene& scene, int vehicles, int threads, const BenchOptions& options) {
  BenchFigures figures;
  figures.vehicles = vehicles;
  figures.threads = sim::ThreadPool(threads).threads();
  // What any world takes, such as code, Embree and pools, is not counted.
  BenchRun small(scene, 1, options.sets);
  small.step();
  const double memory_before_kB = resident_kB();
  const double start_s = wall_seconds();
  BenchRun run(scene, vehicles, options.sets, threads);
  figures.load_s = wall_seconds() - start_s;
  figures.step_s = run.world().config().physics.step_s;
  run.run_for(options.warm_up_s);
  const sim::Time begin = run.world().now();
  const double cpu_s = cpu_seconds();
  const double wall_s = wall_seconds();
  run.world().state().measure_shared_work(&figures.shared_work);
  run.run_for(options.measure_s);
  run.world().state().measure_shared_work(nullptr);
  // A whole number of steps may be a little longer than the time asked for.
  const double measured_s = sim::to_seconds(run.world().now() - begin);
  figures.cpu_ms_per_vehicle_s = 1e3 * (cpu_seconds() - cpu_s) / vehicles / measured_s;
  figures.real_time_factor = measured_s / (wall_seconds() - wall_s);
  figures.run_hash = run.world().state().run_hash();
  figures.memory_kB = (resident_kB() - memory_before_kB) / vehicles;
  measure_parts(run, std::max(std::min(1.0, options.measure_s), options.measure_s / 4), figures);
  return figures;
}

std::string largest_parts(const BenchFigures& figures) {
  constexpr std::size_t shown = 3;
  std::array<std::size_t, bench_parts> order{};
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(),
                   [&](std::size_t a, std::size_t b) { return figures.part_ms[a] > figures.part_ms[b]; });
  const double all_ms = std::accumulate(figures.part_ms.begin(), figures.part_ms.end(), 0.0);
  std::string text;
  for (std::size_t i = 0; i < shown && all_ms > 0; ++i)
    text += fmt::format("{}{} {:.0f} %", i == 0 ? "" : ", ", bench_part_name(order[i]),
                        100 * figures.part_ms[order[i]] / all_ms);
  return text;
}

std::string bench_csv_head() {
  std::string head =
      "scene,vehicles,threads,step_s,load_s,cpu_ms_per_vehicle_s,real_time_factor,run_hash,memory_kB_per_vehicle,"
      "contacts_per_vehicle,rays_per_vehicle_s,messages_per_vehicle_s,hearers_per_vehicle_s";
  for (std::size_t i = 0; i < bench_parts; ++i) head += fmt::format(",{}_ms_per_vehicle_s", bench_part_name(i));
  return head + "\n";
}

std::string bench_csv_line(const BenchScene& scene, const BenchFigures& figures) {
  std::string line =
      fmt::format("{},{},{},{:g},{:.6g},{:.6g},{:.6g},{:016x},{:.6g},{:.6g},{:.6g},{:.6g},{:.6g}", scene.name,
                  figures.vehicles, figures.threads, figures.step_s, figures.load_s, figures.cpu_ms_per_vehicle_s,
                  figures.real_time_factor, figures.run_hash, figures.memory_kB, figures.contacts, figures.rays_per_s,
                  figures.messages_per_s, figures.hearers_per_s);
  for (const double part_ms : figures.part_ms) line += fmt::format(",{:.6g}", part_ms);
  return line + "\n";
}

}  // namespace verification
