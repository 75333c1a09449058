// SPDX-License-Identifier: BSD-3-Clause
#include "experiment/run/time_control.hpp"

#include <spdlog/fmt/fmt.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <filesystem>

#include "experiment/run/pacer.hpp"
#include "sim/base/log.hpp"
#include "sim/base/state_hash.hpp"
#include "sim/config/message_text.hpp"
#include "sim/state/state_archive.hpp"
#include "sim/world/world_state.hpp"

namespace experiment {

namespace {

constexpr int max_files = 1000;
constexpr const char* suffix = ".snapshot";
/// The interval between two snapshots for rewinding is at least this multiple of the cost of the last one (the
/// following steps are slower too, because their memory is no longer in the caches): in a run that is much faster than
/// real time they are further apart, and the steps between them take less time to compute again.
constexpr int rest_per_snapshot = 80;
/// A client whose last tick is further before the target of a rewind receives an incomplete list, because simulating
/// that interval again would take too long.
constexpr std::int64_t max_lead_s = 60;

/// Concatenates bytes so that the ring can compare them part by part, and splits them again.  The last bytes contain
/// the three sizes.
constexpr std::size_t trailer_bytes = 3 * sizeof(std::uint64_t);

sim::Bytes joined(const sim::Bytes& state, const sim::Bytes& scores, const sim::Bytes& owners) {
  sim::Bytes all;
  all.reserve(state.size() + scores.size() + owners.size() + 64);
  for (const sim::Bytes* part : {&state, &scores, &owners}) all.insert(all.end(), part->begin(), part->end());
  auto trailer = sim::StateArchive::saver();
  trailer.section("sizes");
  for (const sim::Bytes* part : {&state, &scores, &owners}) {
    std::uint64_t size = part->size();
    trailer(size);
  }
  trailer.end();
  const sim::Bytes sizes = trailer.take_bytes();
  all.insert(all.end(), sizes.begin(), sizes.end());
  return all;
}

std::uint64_t hash_of(const sim::Bytes& bytes) {
  sim::StateHash hash;
  hash.add_bytes(bytes.data(), bytes.size());
  return hash.value();
}

/// Returns the first line that differs between two texts.
std::string first_difference(const std::string& there, const std::string& here) {
  std::size_t begin = 0;
  int line = 1;
  while (begin < there.size() && begin < here.size()) {
    const std::size_t end_there = std::min(there.find('\n', begin), there.size());
    const std::size_t end_here = std::min(here.find('\n', begin), here.size());
    const std::string a = there.substr(begin, end_there - begin);
    const std::string b = here.substr(begin, end_here - begin);
    if (a != b) return fmt::format("line {}: '{}' there, '{}' here", line, sim::shortened(a), sim::shortened(b));
    begin = end_here + 1;
    ++line;
  }
  return fmt::format("line {}: one is longer", line);
}

}  // namespace

TimeControl::TimeControl(sim::World& world, sim::RunControl& control, Scoring& scoring, bridges::SimService& service,
                         RunInputs& inputs, Options options, Timeline& timeline)
    : world_(world),
      control_(control),
      scoring_(scoring),
      service_(service),
      inputs_(inputs),
      options_(std::move(options)),
      timeline_(timeline),
      steps_per_second_(std::max<std::int64_t>(1, std::llround(1e6 / static_cast<double>(world.step_time().count())))),
      ring_(std::llround(options_.rewind_s * static_cast<double>(steps_per_second_)), options_.max_bytes) {
  if (options_.rewind_s > 0) inputs_.keep(options_.max_bytes, [this] { discard_all(); });
}

TimeControl::Saved TimeControl::save(History history) const {
  Saved saved;
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

void TimeControl::load(const Saved& saved, History history) {
  world_.state().restore(saved.state);
  load_beside(saved, history);
}

void TimeControl::load_beside(const Saved& saved, History history) {
  auto scores = sim::StateArchive::restorer(saved.scores);
  scoring_.visit_state(scores, history);
  scores.end();
  auto owners = sim::StateArchive::restorer(saved.owners);
  owners.section("owners");
  service_.visit_state(owners);
  owners.end();
}

void TimeControl::after_step() {
  if (options_.rewind_s <= 0) return;
  const std::int64_t step = world_.step_number();
  const bool due = step % steps_per_second_ == 0 || ring_.size() == 0;
  if (!due) return;
  const auto begin = Clock::now();
  if (ring_.size() > 0 && begin < not_before_) return;
  try {
    const Saved saved = save(History::length);
    ring_.add(step, joined(saved.state, saved.scores, saved.owners), inputs_.bytes());
  } catch (const sim::SnapshotError& error) {
    sim::log_warn("this run cannot be rewound: {}", error.what());
    options_.rewind_s = 0;
    return discard_all();
  }
  inputs_.discard_before(*ring_.oldest());
  const auto end = Clock::now();
  not_before_ = end + rest_per_snapshot * (end - begin);
}

void TimeControl::discard_all() {
  ring_.discard_after(-1);
  inputs_.discard_from(-1);
}

bool TimeControl::stop_when_there() {
  const bool there = control_.until && world_.now() >= *control_.until;
  const bool fired =
      !control_.until_event.empty() && world_.event_firings(control_.until_event).value_or(0) > control_.until_firings;
  if (!there && !fired) return false;
  control_.clear_until();
  control_.set_paused(true);
  return true;
}

std::optional<std::string> TimeControl::execute(const std::string& command, const std::string& text, double value) {
  const auto run_on = [&] {
    if (!text.empty() && text != "run")
      throw std::runtime_error("'rewind' takes the text 'run' or none, got '" + sim::shortened(sim::printable(text)) +
                               "'; the seconds are its value: `shoal control rewind --value 30`");
    return text == "run";
  };
  // Snapshots and moves in time.
  if (command == "snapshot") return write_snapshot(text);
  if (command == "restore") return restore(text, value == 1);
  if (command == "rewind") return rewind(value, run_on());
  if (command == "until") return text.empty() ? run_until(value) : run_until_event(text);
  if (command == "where") {
    const std::string waits = service_.waits_for();
    return place() + (waits.empty() ? "" : ", " + waits) + what_is_kept();
  }
  if (command == "step") return step(value);
  if (command == "speed") return set_speed(value);
  if (set_pace(control_, command, value)) return place();
  return std::nullopt;
}

std::string TimeControl::step(double count) {
  set_pace(control_, "step", count);
  return place() + fmt::format(", takes {} step{}", control_.single_steps, control_.single_steps == 1 ? "" : "s");
}

std::string TimeControl::set_speed(double times) {
  set_pace(control_, "speed", times);
  return place() + (times > 0 ? fmt::format(", {:g} x real time", times) : ", as fast as possible");
}

std::string TimeControl::place() const {
  return fmt::format("step {}, {:.6g} s, branch {}{}", world_.step_number(), sim::to_seconds(world_.now()),
                     control_.branch, control_.paused ? ", paused" : "");
}

std::string TimeControl::what_is_kept() const {
  const auto oldest = ring_.oldest();
  if (!oldest) return "";
  return fmt::format("; can be rewound to {:.6g} s, which takes {:.2f} MB",
                     sim::to_seconds(world_.step_time() * *oldest), static_cast<double>(bytes()) / 1e6);
}

std::string TimeControl::run_until(double time_s) {
  if (!(time_s > sim::to_seconds(world_.now()) && time_s <= 1e9))
    throw std::runtime_error(fmt::format("'until' needs a time after now ({:.6g} s) and at most 1e9 s, got {}",
                                         sim::to_seconds(world_.now()), time_s));
  control_.clear_until();
  control_.until = sim::from_seconds(time_s);
  control_.set_paused(false);
  return place() + fmt::format(", runs until {:.6g} s", time_s);
}

std::string TimeControl::run_until_event(const std::string& name) {
  const auto firings = world_.event_firings(name);
  if (!firings)
    throw std::runtime_error("'until' needs a time or the name of an event of the world, got '" +
                             sim::shortened(sim::printable(name)) + "'");
  control_.clear_until();
  control_.until_event = name;
  control_.until_firings = *firings;
  control_.set_paused(false);
  return place() + ", runs until event '" + name + "' fires";
}

std::string TimeControl::rewind(double seconds, bool run_on) {
  if (options_.rewind_s <= 0) throw std::runtime_error("this run keeps no snapshots for a rewind: see --rewind-s");
  if (!(seconds > 0 && seconds <= 1e9))
    throw std::runtime_error(fmt::format("'rewind' needs a value above 0, in seconds, got {}", seconds));
  const double steps = seconds * 1e6 / static_cast<double>(world_.step_time().count());
  if (std::llround(steps) < 1)
    throw std::runtime_error(fmt::format("'rewind' by {} s is less than half a step of {:.6g} s", seconds,
                                         sim::to_seconds(world_.step_time())));
  if (world_.step_number() == first_step_)
    throw std::runtime_error("already at the start of the run: nothing to rewind");
  // A rewind beyond the start goes to the start.
  const std::int64_t target = std::max<std::int64_t>(world_.step_number() - std::llround(steps), first_step_);
  auto base = ring_.newest_until(inputs_.needed_from(target, max_lead_s * steps_per_second_));
  if (!base) base = ring_.newest_until(target);  // some clients will lack reports
  if (!base) {
    const double oldest_s = sim::to_seconds(sim::Time{ring_.oldest().value_or(0) * world_.step_time().count()});
    throw std::runtime_error(fmt::format("cannot rewind {:.6g} s from {:.6g} s: the history starts at {:.6g} s",
                                         seconds, sim::to_seconds(world_.now()), oldest_s));
  }
  rewind_to(*base, target, run_on);
  return place();
}

void TimeControl::rewind_to(std::int64_t base, std::int64_t target, bool run_on) {
  travel(
      [&] {
        const sim::Bytes all = ring_.get(base);
        std::uint64_t sizes[3];
        std::memcpy(sizes, all.data() + all.size() - trailer_bytes, trailer_bytes);
        const auto at = [&](std::uint64_t offset) { return all.begin() + static_cast<std::ptrdiff_t>(offset); };
        load({{at(0), at(sizes[0])},
              {at(sizes[0]), at(sizes[0] + sizes[1])},
              {at(sizes[0] + sizes[1]), at(sizes[0] + sizes[1] + sizes[2])}},
             History::length);
        simulate_again(target);
        ring_.discard_after(target);
        inputs_.discard_from(target);
        written_.erase(written_.upper_bound(target), written_.end());
      },
      target, run_on, true);
}

void TimeControl::simulate_again(std::int64_t to_step) {
  inputs_.restart_replay(world_.step_number());
  while (world_.step_number() < to_step) {
    inputs_.deliver(world_.step_number());
    world_.step();
    service_.publish_step();  // metrics may count it; no other program receives it
    scoring_.after_step();
    if (world_.step_number() < to_step) inputs_.pass(world_.step_number());
  }
}

void TimeControl::travel(const std::function<void()>& work, std::int64_t to_step, bool run_on, bool ours) {
  const Saved before = save(History::whole);
  // Leave the present branch.
  try {
    timeline_.leave_branch(to_step, ours);
  } catch (const std::exception&) {
    timeline_.hold_here();
    throw;
  }
  // Move the world; restore it on failure.
  inputs_.restart_replay(world_.step_number());
  try {
    work();
  } catch (const std::exception&) {
    restore_saved(before);
    throw;
  }
  // Start the new branch.
  inputs_.end_replay();
  ++control_.branch;
  control_.clear_until();
  control_.set_paused(!run_on);
  moved_ = true;
  try {
    timeline_.start_branch(ours);
  } catch (const std::exception& error) {  // the run is partly restored: it cannot continue
    broken_ = error.what();
    throw;
  }
}

void TimeControl::restore_saved(const Saved& before) {
  try {
    load(before, History::whole);
  } catch (const std::exception& error) {
    broken_ = error.what();
  }
  inputs_.end_replay();
  timeline_.hold_here();
}

void TimeControl::go_on_from(const Snapshot& snapshot) {
  if (snapshot.step_us != world_.step_time().count() || snapshot.epoch_us != world_.epoch_us())
    throw std::runtime_error(fmt::format(
        "the snapshot has a step of {} us and an epoch of {}, this world {} us and {}: they cannot be changed",
        snapshot.step_us, snapshot.epoch_us, world_.step_time().count(), world_.epoch_us()));
  world_.state().restore(snapshot.state);
  first_step_ = world_.step_number();
  options_.scores_from_s = snapshot.from_s;
  try {
    load_beside({{}, snapshot.scores, snapshot.owners}, History::whole);
  } catch (const sim::SnapshotError&) {
    throw std::runtime_error(
        "the metrics of the snapshot differ from those of this world: `metrics` cannot be changed");
  }
}

Snapshot TimeControl::snapshot() const {
  Snapshot s;
  s.version = options_.version;
  s.world = world_.config().name;
  s.resolved_world = options_.resolved_world;
  s.files = options_.files;
  s.seed = world_.config().run.seed;
  s.epoch_us = world_.epoch_us();
  s.step_us = world_.step_time().count();
  s.step = world_.step_number();
  s.branch = control_.branch;
  s.from_s = options_.scores_from_s;
  s.state_hash = world_.state().hash();
  for (const auto& vehicle : world_.vehicles()) s.vehicles.push_back(vehicle->name());
  Saved saved = save(History::whole);
  s.state = std::move(saved.state);
  s.scores = std::move(saved.scores);
  s.owners = std::move(saved.owners);
  return s;
}

std::string TimeControl::path_of(const std::string& name) const {
  if (options_.directory.empty())
    throw std::runtime_error("this run has no directory for snapshots: see --snapshots and --results");
  const bool good =
      !name.empty() && name.size() <= 100 && name.front() != '.' && std::all_of(name.begin(), name.end(), [](char c) {
        return std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '.' || c == '-' || c == '_';
      });
  if (!good)
    throw std::runtime_error(
        "a snapshot has a file name of 1 to 100 letters, digits, '.', '-' and '_', not beginning with '.', got '" +
        sim::shortened(sim::printable(name)) + "'");
  return options_.directory + "/" + name + (name.ends_with(suffix) ? "" : suffix);
}

std::string TimeControl::write_snapshot(const std::string& name) {
  if (files_ >= max_files)
    throw std::runtime_error(
        fmt::format("this run already wrote {} requested snapshots, which is the maximum", max_files));
  const std::string text = write_file(name);
  ++files_;
  return text;
}

std::string TimeControl::planned_name(std::int64_t step) const {
  return fmt::format("branch{}_step{}", control_.branch, step);
}

void TimeControl::check_planned_snapshot(std::int64_t step) const {
  const std::string path = path_of(planned_name(step));
  std::error_code error;
  if (!options_.overwrite && std::filesystem::exists(path, error))
    throw std::runtime_error(path + ": a snapshot of an earlier run; give --overwrite, or another --snapshots");
}

std::string TimeControl::write_file(const std::string& name) {
  const std::string path = path_of(!name.empty() ? name : planned_name(world_.step_number()));
  std::error_code error;
  std::filesystem::create_directories(options_.directory, error);
  if (!options_.overwrite && std::filesystem::exists(path, error))
    throw std::runtime_error(path + ": already exists; choose another name");
  const Snapshot written = snapshot();
  experiment::write_snapshot(path, written);
  written_[written.step] = hash_of(written.state);
  return place() + ": " + path;
}

std::string TimeControl::write_planned_snapshot() {
  return write_file("");
}

std::string TimeControl::restore(const std::string& name, bool run_on) {
  const std::string path = path_of(name);
  // Check that the snapshot is of this world.
  const Snapshot snapshot = read_snapshot(path);
  check_version(snapshot, path, options_.version);
  if (snapshot.resolved_world != options_.resolved_world)
    throw std::runtime_error(path + ": is of another world or other values: " +
                             first_difference(snapshot.resolved_world, options_.resolved_world));
  if (snapshot.files != options_.files)
    throw std::runtime_error(
        path + ": its world used other files than this run: " + first_difference(snapshot.files, options_.files));
  // Clients must be rewound with the world.
  if (!inputs_.clients().empty()) {
    restore_with_clients(snapshot, path, run_on);
    return place();
  }
  travel(
      [&] {
        load({snapshot.state, snapshot.scores, snapshot.owners}, History::whole);
        options_.scores_from_s = snapshot.from_s;
        discard_all();
        after_step();
        first_step_ = std::min(first_step_, snapshot.step);
        written_ = {{snapshot.step, hash_of(snapshot.state)}};
      },
      snapshot.step, run_on, false);
  return place();
}

/// A file has no state of the programs, which can only be restored to steps of this run.
void TimeControl::restore_with_clients(const Snapshot& snapshot, const std::string& path, bool run_on) {
  const auto refuse = [&](const std::string& why) {
    throw std::runtime_error(
        fmt::format("{}: {}, and the lockstep clients ({}) cannot be restored to a state that they never had or that "
                    "was discarded: use 'rewind', or continue from the file in a new run, with 'shoal run --from'",
                    path, why, sim::shortened(inputs_.clients())));
  };
  const auto written = written_.find(snapshot.step);
  if (written == written_.end() || written->second != hash_of(snapshot.state))
    refuse("was not written by this run before " + place());
  // Unlike in rewind(), a later start would lack reports for some client.  At the start of the run no client had any.
  const std::int64_t needed = inputs_.needed_from(snapshot.step, max_lead_s * steps_per_second_);
  const auto base = ring_.newest_until(std::max(needed, first_step_));
  if (!base)
    refuse(ring_.oldest() ? fmt::format("t = {:.6g} s precedes this run's history, which starts at {:.6g} s",
                                        snapshot.time_s(), sim::to_seconds(world_.step_time() * *ring_.oldest()))
                          : "this run keeps no history (see --rewind-s)");
  rewind_to(*base, snapshot.step, run_on);
}

}  // namespace experiment
