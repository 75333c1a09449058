// SPDX-License-Identifier: BSD-3-Clause
#include "experiment/run/step_watch.hpp"

#include <spdlog/fmt/fmt.h>

#include <algorithm>
#include <chrono>
#include <ctime>

namespace experiment {

namespace {

double thread_cpu_s() {
  timespec now{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

double wall_s() {
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

/// The CPU time is read at most this often: unlike the wall time, it takes a system call.
constexpr double mark_every_s = 1e-4;

// A shorter step is always fast enough, regardless of its simulated length.
constexpr double slow_step_s = 0.02;
constexpr double slow_times = 5;
constexpr int slow_steps_to_warn = 3;
/// A group of a few bodies has fewer rows; in that case something other than physics was slow.
constexpr int many_rows = 500;

}  // namespace

void StepWatch::begin() {
  begun_wall_s_ = wall_s();
  if (begun_wall_s_ - mark_wall_s_ < mark_every_s) return;
  mark_wall_s_ = begun_wall_s_;
  mark_cpu_s_ = thread_cpu_s();
}

void StepWatch::end() {
  // The CPU time of a step is at most its wall time, and at most that since the mark.
  last_s_ = wall_s() - begun_wall_s_;
  const double limit_s = world_.config().limits.step_cpu_s;
  if (last_s_ > slow_step_s || (limit_s > 0 && last_s_ > limit_s))
    last_s_ = std::min(last_s_, thread_cpu_s() - mark_cpu_s_);
  const double times = last_s_ / sim::to_seconds(world_.step_time());
  const bool slow = last_s_ > slow_step_s && times > slow_times && times > 10 * reported_times_;
  slow_steps_ = slow && world_.physics().last_step().max_island_rows >= many_rows ? slow_steps_ + 1 : 0;
  if (slow_steps_ >= slow_steps_to_warn) warn_ = times;
}

std::optional<std::string> StepWatch::beyond_limit() const {
  const double limit_s = world_.config().limits.step_cpu_s;
  if (limit_s <= 0 || last_s_ <= limit_s) return std::nullopt;
  return fmt::format("step {} took {:.3g} s of CPU time, more than 'limits: step_cpu_s' {:g} allows{}",
                     world_.step_number(), last_s_, limit_s, slow_island());
}

std::optional<std::string> StepWatch::take_warning() {
  if (!warn_) return std::nullopt;
  reported_times_ = *std::exchange(warn_, std::nullopt);
  slow_steps_ = 0;
  return fmt::format(
      "step {} took {:.3g} s of CPU time, {:.0f} times as long as it simulates{}; see docs/reference/warnings.md",
      world_.step_number(), last_s_, reported_times_, slow_island());
}

/// Returns `: 200 bodies are solved together, with 9801 constraint rows: 'a', 'b', 'c', ...`.
std::string StepWatch::slow_island() const {
  constexpr std::size_t max_names = 3;
  const sim::IslandInfo island = world_.physics().largest_island();
  if (island.rows < many_rows) return "";
  std::string names;
  for (std::size_t i = 0; i < std::min(max_names, island.bodies.size()); ++i)
    names += (i > 0 ? ", '" : "'") + island.bodies[i] + "'";
  return fmt::format(
      ": {} bodies touch or are joined and are solved together, with {} contacts in all and {} rows: {}{}",
      island.body_count, world_.physics().last_step().contacts, island.rows, names,
      island.body_count > max_names ? ", ..." : "");
}

}  // namespace experiment
