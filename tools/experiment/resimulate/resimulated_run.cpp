// SPDX-License-Identifier: BSD-3-Clause
#include "tools/experiment/resimulate/resimulated_run.hpp"

#include <spdlog/fmt/fmt.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <thread>

#include "sim/state/state_archive.hpp"

namespace tools {

namespace {

using std::chrono::microseconds;

/// Snapshots of the last ten minutes are kept; to go further back the run starts again.
constexpr std::int64_t snapshots_us = 600'000'000;
constexpr std::size_t max_snapshot_bytes = std::size_t{64} << 20;
/// The interval between two snapshots is at least this multiple of the cost of the last one.
constexpr int rest_per_snapshot = 80;
constexpr const char* recorded_programs = "recorded commands";
constexpr microseconds paused_wait{20'000};

}  // namespace

ResimulatedRun::ResimulatedRun(const Options& options, const std::string& version)
    : log_(read_replay_log(options.log)),
      page_(options.view, version),
      replayed_(log_, {"", options.load, options.threads, page_tap()}, page_tap()),
      view_(replayed_.bus(), replayed_.world(), {}, [] { return true; }),
      snapshots_(snapshots_us / world().step_time().count(), max_snapshot_bytes) {
  control_.speed = 1;
  page_.start(world(), end_s(), {"recorded", recorded_programs});
  replayed_.start();
  first_ = replayed_.save();
  after_step();
}

ReplayedWorld::Watch ResimulatedRun::page_tap() {
  return [this](std::string_view channel, std::span<const std::byte> payload) {
    page_.message(channel, payload, world().now());
  };
}

double ResimulatedRun::end_s() const {
  return sim::to_seconds(world().step_time()) * static_cast<double>(log_.usable_step());
}

bool ResimulatedRun::at_end() const {
  return !branched_ && world().step_number() >= log_.usable_step();
}

void ResimulatedRun::after_step() {
  view_.after_step();
  page_.after_step(world(), view_, control_);
  // Snapshots for going back: one in a simulated second, if they do not take too long.
  const auto begin = Clock::now();
  const std::int64_t per_second = std::max<std::int64_t>(1, 1'000'000 / world().step_time().count());
  const std::int64_t step = world().step_number();
  if (step % per_second != 0 || begin < not_before_ || snapshots_.newest_until(step) == step) return;
  if (const auto newest = snapshots_.newest_until(std::numeric_limits<std::int64_t>::max()); newest && *newest > step)
    return;
  snapshots_.add(step, replayed_.save());
  const auto end = Clock::now();
  not_before_ = end + rest_per_snapshot * (end - begin);
}

void ResimulatedRun::step() {
  const std::int64_t step = world().step_number();
  try {
    // Changes that were made on this branch before it was rewound.
    const auto [from, to] = changes_.equal_range(step);
    for (auto change = from; catch_up_ && change != to; ++change) replayed_.request(change->second);
    replayed_.step();
  } catch (const sim::PhysicsFault& error) {
    faulty_ = true;
    control_.set_paused(true);
    catch_up_.reset();
    return page_.problem(std::string("the world cannot continue: ") + error.what());
  } catch (const std::runtime_error& error) {
    page_.problem(error.what());
  }
  control_.step_taken();
  after_step();
  if (catch_up_ && world().step_number() >= *catch_up_) arrive();
  if (at_end() || (control_.until && world().now() >= *control_.until)) {
    control_.clear_until();
    control_.set_paused(true);
  }
}

microseconds ResimulatedRun::advance() {
  page_.serve(world(), view_, control_, "", [this](const std::string& command, double value, const std::string& text) {
    try {
      return RunView::Answer{true, execute(command, value, text)};
    } catch (const std::runtime_error& error) {
      return RunView::Answer{false, error.what()};
    }
  });
  if (catch_up_) {
    step();
    return microseconds{0};
  }
  if (!control_.may_step() || at_end() || faulty_) return paused_wait;
  const microseconds wait =
      control_.paused ? microseconds{0} : pacer_.until(world().now() + world().step_time(), control_);
  if (wait > microseconds{0}) return std::min(wait, paused_wait);
  step();
  return microseconds{0};
}

void ResimulatedRun::run(const std::function<bool()>& goes_on) {
  while (goes_on())
    if (const microseconds wait = advance(); wait > microseconds{0}) std::this_thread::sleep_for(wait);
}

std::string ResimulatedRun::place() const {
  return fmt::format("step {}, {:.6g} s, {}", world().step_number(), sim::to_seconds(world().now()),
                     branched_ ? fmt::format("branch {}", control_.branch) : "record");
}

std::string ResimulatedRun::execute(const std::string& command, double value, const std::string& text) {
  if (command == "branch") return branch();
  if (command == "rewind") return rewind(value);
  if (command == "where") return place();
  if (command == "pause" || command == "resume") {
    if (command == "resume" && at_end()) throw std::runtime_error("the record ends here: go back, or branch");
    control_.set_paused(command == "pause");
    return place();
  }
  if (command == "step") {
    if (!(value >= 1 && value <= 1e9 && value == std::floor(value)))
      throw std::runtime_error(fmt::format("'step' needs a whole number of steps from 1 to 1e9, got {}", value));
    control_.add_steps(static_cast<std::int64_t>(value));
    return place();
  }
  if (command == "speed") {
    if (value != 0 && !(value >= 1e-3 && value <= 1e6))
      throw std::runtime_error(
          fmt::format("'speed' must be 0 (as fast as possible) or from 0.001 to 1e6, got {}", value));
    control_.set_speed(value);
    return place();
  }
  if (command == "until") {
    if (!(value > sim::to_seconds(world().now()) && value <= 1e9))
      throw std::runtime_error(fmt::format("'until' needs a time after now and at most 1e9 s, got {}", value));
    control_.until = sim::from_seconds(value);
    control_.set_paused(false);
    return place();
  }
  return change(command, value, text);
}

std::string ResimulatedRun::branch() {
  if (branched_) throw std::runtime_error(fmt::format("this is branch {} already", control_.branch));
  if (catch_up_) throw std::runtime_error("the run is going back: wait until it is there");
  branched_ = true;
  ++control_.branch;
  view_.set_branch(control_.branch);
  page_.moved(world(), control_, true);
  page_.start(world(), std::nullopt, {"branched", recorded_programs});
  return place() + "; programs: " + recorded_programs;
}

std::string ResimulatedRun::rewind(double seconds) {
  if (!(seconds > 0 && seconds <= 1e9))
    throw std::runtime_error(fmt::format("'rewind' needs a value above 0, in seconds, got {}", seconds));
  const std::int64_t now = world().step_number();
  const double steps = seconds * 1e6 / static_cast<double>(world().step_time().count());
  const std::int64_t target = std::max<std::int64_t>(now - std::llround(steps), log_.begin_step());
  if (target == now) throw std::runtime_error("already there: nothing to rewind");
  // The last state before it, then the steps from there, with the same inputs.
  const auto base = snapshots_.newest_until(target);
  replayed_.load(base ? snapshots_.get(*base) : first_);
  if (branched_) {
    snapshots_.discard_after(target);
    changes_.erase(changes_.lower_bound(target), changes_.end());
  }
  faulty_ = false;
  view_.discard();
  control_.clear_until();
  control_.set_paused(true);
  catch_up_ = target;
  if (world().step_number() >= target) arrive();
  return place();
}

/// Ends a way back: a branch is left for another one, a record is the same.
void ResimulatedRun::arrive() {
  catch_up_.reset();
  if (!branched_) return page_.jump();
  ++control_.branch;
  view_.set_branch(control_.branch);
  page_.moved(world(), control_, true);
}

std::string ResimulatedRun::change(const std::string& command, double value, const std::string& text) {
  if (!branched_)
    throw std::runtime_error("'" + command + "': this is a record, which cannot be changed: branch here first");
  if (command != "do" && command != "spawn" && command != "remove")
    throw std::runtime_error("'" + command + "' is not possible in a record that is run again");
  shoal::sim_control_request_t request;
  request.client = "live page";
  request.command = command;
  request.value = value;
  request.text = text;
  const std::string reply = replayed_.request(request);
  changes_.emplace(world().step_number(), request);
  return reply;
}

}  // namespace tools
