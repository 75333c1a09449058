// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "sim/base/shared_work.hpp"
#include "sim/vehicle/stage_times.hpp"
#include "verification/bench/bench_scene.hpp"

namespace verification {

struct BenchOptions {
  double warm_up_s = 10;          ///< simulated time before the measurement
  double measure_s = 20;          ///< simulated time measured
  std::vector<std::string> sets;  ///< path=value
};

/// Consumers of CPU time: the stages of a step, then the programs.
inline constexpr std::size_t bench_parts = sim::step_stage_names.size() + 1;
/// Returns the name of a part.
const char* bench_part_name(std::size_t part);

/// Figures of one run of a scene; trivially copyable.
struct BenchFigures {
  int vehicles = 0;
  int threads = 1;  ///< in use
  double step_s = 0;
  double load_s = 0;                ///< wall time to read and build the world
  double cpu_ms_per_vehicle_s = 0;  ///< CPU milliseconds of all threads per vehicle and simulated second
  double real_time_factor = 0;      ///< simulated over wall time
  std::uint64_t run_hash = 0;       ///< at the end of the time measured
  sim::SharedWork shared_work;      ///< of a part of the steps, with several threads
  double memory_kB = 0;             ///< resident memory per vehicle, beyond that of a process with a world of one
  // Work per vehicle, measured after the time above in a quarter of it, at least one
  // simulated second if that was measured.
  double contacts = 0;        ///< mean number at any instant
  double rays_per_s = 0;      ///< per simulated second, as the following ones
  double messages_per_s = 0;  ///< published, also by the programs
  double hearers_per_s = 0;   ///< acoustic signals that start towards a receiver
  std::array<double, bench_parts>
      part_ms{};  ///< CPU milliseconds of the thread that steps, per vehicle and simulated second
};

/// Loads the scene, runs the warm-up, and measures.  `threads`: 0: one for each processor.  Throws ConfigError.
BenchFigures measure_bench(const BenchScene& scene, int vehicles, int threads, const BenchOptions& options);

/// The same in a child process, so that memory and allocations of earlier runs have no influence.  The caller must
/// have one thread.  Throws ConfigError, or std::runtime_error when the process is ended by a signal.
BenchFigures measure_bench_apart(const BenchScene& scene, int vehicles, int threads, const BenchOptions& options);

/// Returns the parts that take most of the time: `physics 62 %, rays 20 %, sensors 9 %`.
std::string largest_parts(const BenchFigures& figures);

/// Returns the first line of the CSV file.
std::string bench_csv_head();
/// Returns the line of a run.
std::string bench_csv_line(const BenchScene& scene, const BenchFigures& figures);

}  // namespace verification
