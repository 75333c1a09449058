// SPDX-License-Identifier: BSD-3-Clause
#include "experiment/run/time_control.hpp"

#include <spdlog/fmt/fmt.h>

#include <algorithm>
#include <filesystem>

#include "sim/base/log.hpp"
#include "sim/base/state_hash.hpp"
#include "sim/config/message_text.hpp"
#include "sim/state/state_archive.hpp"
#include "sim/world/world_state.hpp"

namespace experiment {

namespace {

constexpr int max_files = 1000;
constexpr const char* suffix = ".snapshot";
/// A client whose last tick is further before the target of a rewind receives an incomplete list, because simulating
/// that interval again would take too long.
constexpr std::int64_t max_lead_s = 60;

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
      time_(world, control, scoring, service, {options_.rewind_s, options_.max_bytes}) {
  if (time_.keeps()) inputs_.keep(options_.max_bytes, [this] { discard_all(); });
}

void TimeControl::after_step() {
  try {
    if (time_.keep(inputs_.bytes())) inputs_.discard_before(*time_.oldest_kept());
  } catch (const sim::SnapshotError& error) {
    sim::log_warn("this run cannot be rewound: {}", error.what());
    time_.stop_keeping();
    discard_all();
  }
}

void TimeControl::discard_all() {
  time_.forget_after(-1);
  inputs_.discard_from(-1);
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
  if (command == "where") {
    const std::string waits = service_.waits_for();
    return place() + (waits.empty() ? "" : ", " + waits) + what_is_kept();
  }
  const auto more = time_.execute(command, text, value);
  return more ? std::optional(place() + *more) : std::nullopt;
}

std::string TimeControl::place() const {
  return fmt::format("{}, branch {}{}", time_.place(), control_.branch, control_.paused ? ", paused" : "");
}

std::string TimeControl::what_is_kept() const {
  const auto oldest = time_.oldest_kept();
  if (!oldest) return "";
  return fmt::format("; can be rewound to {:.6g} s, which takes {:.2f} MB", time_.seconds_at(*oldest),
                     static_cast<double>(bytes()) / 1e6);
}

std::string TimeControl::rewind(double seconds, bool run_on) {
  if (!time_.keeps()) throw std::runtime_error("this run keeps no snapshots for a rewind: see --rewind-s");
  // A rewind beyond the start goes to the start.
  const std::int64_t target = time_.step_before(seconds, first_step_);
  auto base = time_.newest_kept_until(inputs_.needed_from(target, max_lead_s * time_.steps_per_second()));
  if (!base) base = time_.newest_kept_until(target);  // some clients will lack reports
  if (!base)
    throw std::runtime_error(fmt::format("cannot rewind {:.6g} s from {:.6g} s: the history starts at {:.6g} s",
                                         seconds, sim::to_seconds(world_.now()),
                                         time_.seconds_at(time_.oldest_kept().value_or(0))));
  rewind_to(*base, target, run_on);
  return place();
}

void TimeControl::rewind_to(std::int64_t base, std::int64_t target, bool run_on) {
  travel(
      [&] {
        time_.load_kept(base);
        simulate_again(target);
        time_.forget_after(target);
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
  const SavedRun before = time_.save(History::whole);
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

void TimeControl::restore_saved(const SavedRun& before) {
  try {
    time_.load(before, History::whole);
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
    time_.load_beside({{}, snapshot.scores, snapshot.owners}, History::whole);
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
  SavedRun saved = time_.save(History::whole);
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
        time_.load({snapshot.state, snapshot.scores, snapshot.owners}, History::whole);
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
  const std::int64_t needed = inputs_.needed_from(snapshot.step, max_lead_s * time_.steps_per_second());
  const auto base = time_.newest_kept_until(std::max(needed, first_step_));
  if (!base)
    refuse(time_.oldest_kept() ? fmt::format("t = {:.6g} s precedes this run's history, which starts at {:.6g} s",
                                             snapshot.time_s(), time_.seconds_at(*time_.oldest_kept()))
                               : "this run keeps no history (see --rewind-s)");
  rewind_to(*base, snapshot.step, run_on);
}

}  // namespace experiment
