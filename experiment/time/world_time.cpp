// SPDX-License-Identifier: BSD-3-Clause
#include "experiment/time/world_time.hpp"

#include <spdlog/fmt/fmt.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <limits>
#include <stdexcept>

#include "experiment/time/pacer.hpp"
#include "sim/config/message_text.hpp"
#include "sim/state/state_archive.hpp"
#include "sim/world/world_state.hpp"

namespace experiment {
namespace {

/// The interval between two kept states is at least this multiple of the cost of the last one (the following steps are
/// slower too, because their memory is no longer in the caches): in a run that is much faster than real time they are
/// further apart, and the steps between them take less time to compute again.
constexpr int rest_per_snapshot = 80;

}  // namespace

WorldTime::WorldTime(sim::World& world, sim::RunControl& control, Scoring& scoring, bridges::SimService& service,
                     const Limits& limits)
    : world_(world),
      control_(control),
      scoring_(scoring),
      service_(service),
      steps_per_second_(std::max<std::int64_t>(1, std::llround(1e6 / static_cast<double>(world.step_time().count())))),
      keeps_(limits.kept_s > 0),
      kept_(std::llround(limits.kept_s * static_cast<double>(steps_per_second_)), limits.max_bytes) {}

SavedRun WorldTime::save(History history) const {
  SavedRun saved;
  saved.state = world_.state().snapshot();
  auto scores = sim::StateArchive::saver();
  scoring_.visit_state(scores, history);
  scores.end();
  saved.scores = scores.take_bytes();
  auto owners = sim::StateArchive::saver();
  owners.section("owners");
  service_.visit_state(owners);
  owners.end();
  saved.owners = owners.take_bytes();
  return saved;
}

void WorldTime::load(const SavedRun& saved, History history) {
  world_.state().restore(saved.state);
  load_beside(saved, history);
}

void WorldTime::load_beside(const SavedRun& saved, History history) {
  auto scores = sim::StateArchive::restorer(saved.scores);
  scoring_.visit_state(scores, history);
  scores.end();
  auto owners = sim::StateArchive::restorer(saved.owners);
  owners.section("owners");
  service_.visit_state(owners);
  owners.end();
}

bool WorldTime::keep(std::size_t bytes_beside) {
  if (!keeps_) return false;
  const std::int64_t step = world_.step_number();
  const auto newest = kept_.newest_until(std::numeric_limits<std::int64_t>::max());
  if (newest && (step % steps_per_second_ != 0 || *newest >= step)) return false;
  const auto begin = Clock::now();
  if (newest && begin < not_before_) return false;
  kept_.add(step, joined(save(History::length)), bytes_beside);
  const auto end = Clock::now();
  not_before_ = end + rest_per_snapshot * (end - begin);
  return true;
}

void WorldTime::stop_keeping() {
  keeps_ = false;
  kept_.discard_after(-1);
}

std::optional<std::string> WorldTime::execute(const std::string& command, const std::string& text, double value) {
  if (command == "until") return text.empty() ? run_until(value) : run_until_event(text);
  if (!set_pace(control_, command, value)) return std::nullopt;
  if (command == "step")
    return fmt::format(", takes {} step{}", control_.single_steps, control_.single_steps == 1 ? "" : "s");
  if (command == "speed") return value > 0 ? fmt::format(", {:g} x real time", value) : ", as fast as possible";
  return "";
}

std::string WorldTime::run_until(double time_s) {
  if (!(time_s > 0 && time_s <= 1e9) || sim::from_seconds(time_s) <= world_.now())
    throw std::runtime_error(fmt::format("'until' needs a time after now ({:.6g} s) and at most 1e9 s, got {}",
                                         sim::to_seconds(world_.now()), time_s));
  control_.clear_until();
  control_.until = sim::from_seconds(time_s);
  control_.set_paused(false);
  return fmt::format(", runs until {:.6g} s", time_s);
}

std::string WorldTime::run_until_event(const std::string& name) {
  const auto firings = world_.event_firings(name);
  if (!firings)
    throw std::runtime_error("'until' needs a time or the name of an event of the world, got '" +
                             sim::shortened(sim::printable(name)) + "'");
  control_.clear_until();
  control_.until_event = name;
  control_.until_firings = *firings;
  control_.set_paused(false);
  return ", runs until event '" + name + "' fires";
}

bool WorldTime::stop_when_there() {
  const bool there = control_.until && world_.now() >= *control_.until;
  const bool fired =
      !control_.until_event.empty() && world_.event_firings(control_.until_event).value_or(0) > control_.until_firings;
  if (!there && !fired) return false;
  control_.clear_until();
  control_.set_paused(true);
  return true;
}

std::int64_t WorldTime::step_before(double seconds, std::int64_t first_step) const {
  if (!(seconds > 0 && seconds <= 1e9))
    throw std::runtime_error(fmt::format("'rewind' needs a value above 0, in seconds, got {}", seconds));
  const std::int64_t steps = std::llround(seconds * 1e6 / static_cast<double>(world_.step_time().count()));
  if (steps < 1)
    throw std::runtime_error(fmt::format("'rewind' by {} s is less than half a step of {:.6g} s", seconds,
                                         sim::to_seconds(world_.step_time())));
  if (world_.step_number() == first_step)
    throw std::runtime_error("already at the start of the run: nothing to rewind");
  return std::max(world_.step_number() - steps, first_step);
}

std::string WorldTime::place() const {
  return fmt::format("step {}, {:.6g} s", world_.step_number(), sim::to_seconds(world_.now()));
}

namespace {

using Sizes = std::array<std::uint64_t, 3>;

}  // namespace

sim::Bytes joined(const SavedRun& saved) {
  sim::Bytes all;
  all.reserve(saved.state.size() + saved.scores.size() + saved.owners.size() + 64);
  auto sizes = sim::StateArchive::saver();
  sizes.section("sizes");  // the last one: split() finds the sizes at the end
  for (const sim::Bytes* part : {&saved.state, &saved.scores, &saved.owners}) {
    all.insert(all.end(), part->begin(), part->end());
    std::uint64_t size = part->size();
    sizes(size);
  }
  sizes.end();
  const sim::Bytes end = sizes.take_bytes();
  all.insert(all.end(), end.begin(), end.end());
  return all;
}

SavedRun split(const sim::Bytes& bytes) {
  Sizes sizes{};
  std::memcpy(sizes.data(), bytes.data() + bytes.size() - sizeof sizes, sizeof sizes);
  auto at = bytes.begin();
  const auto next = [&at](std::uint64_t size) {
    const auto begin = at;
    at += static_cast<std::ptrdiff_t>(size);
    return sim::Bytes(begin, at);
  };
  SavedRun saved;
  saved.state = next(sizes[0]);
  saved.scores = next(sizes[1]);
  saved.owners = next(sizes[2]);
  return saved;
}

}  // namespace experiment
