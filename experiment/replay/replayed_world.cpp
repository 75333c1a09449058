// SPDX-License-Identifier: BSD-3-Clause
#include "experiment/replay/replayed_world.hpp"

#include <spdlog/fmt/fmt.h>

#include <algorithm>
#include <cstdint>
#include <set>
#include <sstream>
#include <stdexcept>

#include "bridges/log/run_journal.hpp"
#include "experiment/process/world_programs.hpp"
#include "experiment/run/runner.hpp"
#include "experiment/run/version.hpp"
#include "experiment/snapshot/run_identity.hpp"
#include "messages/yaml/message_writer.hpp"
#include "shoal/message_codec.hpp"
#include "sim/config/message_text.hpp"
#include "sim/world/world_state.hpp"

namespace experiment {
namespace {

using bridges::RunJournal;

/// Returns the world to run: that of the log, or a replacement.
sim::LoadedWorld load_world_of(const ReplayLog& log, const ReplayedWorld::Options& options) {
  sim::LoadOptions load = options.load;
  load.serial_ports = false;
  load.encode_message = shoal::encode_own_message;
  if (!options.world.empty()) {
    sim::LoadedWorld loaded = sim::load_world(options.world, load);
    if (static_cast<std::int64_t>(loaded.config.run.seed) == log.info.seed) return loaded;
    load.seed = log.info.seed;  // it is then part of the resolved world
    return sim::load_world(options.world, load);
  }
  const std::vector<std::string> changed = changed_files(log.info.files);
  if (!changed.empty()) {
    std::string text = log.path + ": these input files changed since the run was recorded:";
    for (const std::string& file : changed) text += "\n  " + sim::printable(file);
    throw std::runtime_error(text);
  }
  allow_files(log.info.files, load);
  sim::LoadedWorld loaded = sim::load_world_text(log.info.resolved_config, log.path + ": sim.info", load);
  loaded.config.name = log.info.world;
  return loaded;
}

/// Returns the index of the first input at this step or later.
std::size_t index_from(const std::vector<ReplayLog::Input>& inputs, std::int64_t step) {
  const auto next =
      std::find_if(inputs.begin(), inputs.end(), [step](const ReplayLog::Input& input) { return input.step >= step; });
  return static_cast<std::size_t>(next - inputs.begin());
}

RunOptions bus_options(const ReplayedWorld::Options& options) {
  RunOptions run;
  run.bus = options.for_programs ? "lcm" : "none";
  run.lcm_url = options.for_programs.value_or("");
  return run;
}

}  // namespace

ReplayedWorld::ReplayedWorld(const ReplayLog& log, const Options& options, Watch watch)
    : log_(log),
      loaded_(load_world_of(log_, options)),
      watch_(std::move(watch)),
      inputs_(options.inputs),
      for_programs_(options.for_programs.has_value()),
      parts_(loaded_, bus_options(options), parts_options()) {
  if (for_programs_) {
    parts_.buses.set_muted(true);
    read_programs(loaded_, {true, options.load.allow_paths});
    parts_.journal.set_listener([this](std::int64_t step, const RunJournal::Input& input) {
      if (live_) own_inputs_.push_back({step, input.bus, input.channel, input.payload});
    });
    parts_.journal.start();
  }
  check_times();
  restore(options.load.sets.empty() && options.world.empty());
  parts_.world.use_threads(options.threads);
  add_serial_inputs(parts_.world.step_number());
}

/// Gives the ports the bytes from a step on.
void ReplayedWorld::add_serial_inputs(std::int64_t from_step) {
  serial_.clear();
  for (const ReplayLog::Input& input : log_.inputs)
    if (input.bus == RunJournal::serial_bus && input.step >= from_step && input.step < end_of_inputs_)
      serial_.add(input);
}

RunParts::Options ReplayedWorld::parts_options() {
  RunParts::Options parts;
  parts.files = log_.info.files;
  parts.tap = [this](std::string_view channel, std::span<const std::byte> payload, sim::Time) {
    if (watch_) watch_(channel, payload);
  };
  parts.taps = RunBuses::Tap::published;  // also while the programs are not started
  parts.ports = serial_.opener();
  parts.journal = &unread_;
  parts.has_clients = for_programs_;
  return parts;
}

void ReplayedWorld::check_times() const {
  if (parts_.world.step_time().count() != log_.info.step_us)
    throw std::runtime_error(
        fmt::format("{}: its run has steps of {} us, the world here of {} us: there is nothing to "
                    "compare",
                    log_.path, log_.info.step_us, parts_.world.step_time().count()));
  if (parts_.world.epoch_us() != log_.info.epoch_utime)
    throw std::runtime_error(fmt::format("{}: its run has the epoch {}, the world here {}: all stamps would differ",
                                         log_.path, log_.info.epoch_utime, parts_.world.epoch_us()));
  if (!log_.bad_snapshot.empty() && !log_.snapshot && log_.usable_step() < log_.last_step)
    throw std::runtime_error(log_.path + ": cannot be replayed: " + log_.bad_snapshot);
  if (log_.proven_step && *log_.proven_step <= log_.begin_step() && log_.usable_step() < log_.last_step)
    throw std::runtime_error(log_.path + ": cannot be replayed from the start: " + log_.holes.front() +
                             "; the log starts later than the run");
  if (log_.last_step == log_.begin_step() && !log_.hashes.contains(log_.begin_step()))
    throw std::runtime_error(log_.path + ": ends before the first step");
}

void ReplayedWorld::restore(bool same_world) {
  if (!log_.snapshot) return;
  const std::string who = log_.path + ": sim.snapshot";
  check_version(*log_.snapshot, who, short_version());
  try {
    parts_.world.state().restore(log_.snapshot->state);
    auto owners = sim::StateArchive::restorer(log_.snapshot->owners);
    owners.section("owners");
    parts_.service.visit_state(owners);
    owners.end();
  } catch (const sim::SnapshotError& error) {
    throw std::runtime_error(who + ": " + error.what());
  }
  if (same_world && parts_.world.state().hash() != log_.snapshot->state_hash)
    throw std::runtime_error(who + ": its state hash after restoring differs from the one that was written");
}

void ReplayedWorld::start() {
  deliver(RunJournal::before_first_reports);
  parts_.service.publish_step();
}

void ReplayedWorld::step() {
  if (for_programs_) parts_.journal.begin_step();
  deliver(parts_.world.step_number());
  int link = 0;
  admit("", link);
  for (const sim::BusConfig& bus : loaded_.config.buses) admit(bus.name, ++link);
  serial_.begin_step(parts_.world.step_number());
  parts_.world.step();
  parts_.service.publish_step();
  if (for_programs_) parts_.journal.after_step();
}

/// Delivers the inputs on a bus: those that are due, or those from outside.
void ReplayedWorld::admit(const std::string& bus, int link) {
  sim::MessageGate& gate = parts_.buses.gate(bus);
  std::vector<sim::MessageGate::Delivery>& due = due_[bus];
  const auto pass = [this](std::span<const sim::MessageGate::Delivery> inputs) {
    if (!inputs_) return;
    for (const sim::MessageGate::Delivery& input : inputs) inputs_(input.channel, input.payload);
  };
  if (live_) {
    const std::vector<sim::MessageGate::Delivery>& inputs = gate.admit();
    for (const sim::MessageGate::Delivery& input : inputs)
      own_inputs_.push_back({parts_.world.step_number(), bus, input.channel, input.payload});
    return pass(inputs);
  }
  // Afterwards `due` has what programs have published in the meantime.
  const std::vector<sim::MessageGate::Delivery>& recorded = gate.admit_instead(due);
  for (const sim::MessageGate::Delivery& message : due) spoken_.emplace(link, message.channel);
  due.clear();
  pass(recorded);
  if (parts_.lockstep.empty()) return;
  // What others than its programs sent in the recorded run.
  for (const sim::MessageGate::Delivery& input : recorded)
    if (parts_.lockstep.has_receiver(input.channel, link) && !spoken_.contains({link, input.channel}))
      parts_.lockstep.post(link, input.channel, input.payload);
}

bool ReplayedWorld::has_commands() const {
  return std::any_of(log_.inputs.begin(), log_.inputs.end(), [](const ReplayLog::Input& input) {
    return !input.bus.empty() || input.channel != RunJournal::request_channel;
  });
}

void ReplayedWorld::drop_inputs_from(std::int64_t step) {
  end_of_inputs_ = std::min(end_of_inputs_, step);
  std::erase_if(own_inputs_, [step](const ReplayLog::Input& input) { return input.step >= step; });
}

void ReplayedWorld::restore_inputs() {
  end_of_inputs_ = std::numeric_limits<std::int64_t>::max();
  own_inputs_.clear();
}

void ReplayedWorld::repeat_inputs() {
  // The inputs before this step have been delivered.
  const std::int64_t step = parts_.world.step_number();
  due_.clear();
  spoken_.clear();
  next_input_ = index_from(log_.inputs, step);
  next_own_ = index_from(own_inputs_, step);
  add_serial_inputs(step);
}

void ReplayedWorld::deliver(std::int64_t step) {
  const std::int64_t last = std::min(step, end_of_inputs_ - 1);
  for (; next_input_ < log_.inputs.size() && log_.inputs[next_input_].step <= last; ++next_input_)
    deliver(log_.inputs[next_input_]);
  if (live_) return;
  for (; next_own_ < own_inputs_.size() && own_inputs_[next_own_].step <= step; ++next_own_)
    deliver(own_inputs_[next_own_]);
}

void ReplayedWorld::deliver(const ReplayLog::Input& input) {
  if (input.bus == RunJournal::serial_bus) return;
  if (input.bus.empty() && input.channel == RunJournal::request_channel) return execute(input);
  if (!parts_.buses.has(input.bus))
    return note("the world here has no bus '" + sim::printable(sim::shortened(input.bus)) +
                "': its inputs are not delivered");
  due_[input.bus].push_back({input.channel, input.payload});
}

void ReplayedWorld::execute(const ReplayLog::Input& input) {
  try {
    parts_.service.execute_again(shoal::decode<shoal::sim_control_request_t>(input.payload, shoal::Finite::any));
  } catch (const shoal::MessageError& error) {
    note(std::string("a request in the log cannot be read: ") + error.what());
  } catch (const std::exception&) {
    // It was rejected in the run as well, or the state will differ.
  }
}

void ReplayedWorld::note(const std::string& text) {
  if (notes_.size() < 20 && std::find(notes_.begin(), notes_.end(), text) == notes_.end()) notes_.push_back(text);
}

namespace {

using Lines = std::vector<std::string>;

Lines lines_of(const std::string& text) {
  Lines lines;
  std::istringstream in(text);
  for (std::string line; std::getline(in, line);) lines.push_back(line);
  return lines;
}

/// lengths[i][j]: length of the longest common subsequence of a from i and b from j.
std::vector<std::vector<std::uint32_t>> common_lengths(const Lines& a, const Lines& b) {
  std::vector<std::vector<std::uint32_t>> lengths(a.size() + 1, std::vector<std::uint32_t>(b.size() + 1));
  for (std::size_t i = a.size(); i-- > 0;)
    for (std::size_t j = b.size(); j-- > 0;)
      lengths[i][j] = a[i] == b[j] ? lengths[i + 1][j + 1] + 1 : std::max(lengths[i + 1][j], lengths[i][j + 1]);
  return lengths;
}

}  // namespace

std::vector<std::string> line_difference(const std::string& first, const std::string& second, std::size_t max) {
  // Remove the common start and end.
  Lines a = lines_of(first), b = lines_of(second);
  std::size_t begin = 0;
  while (begin < a.size() && begin < b.size() && a[begin] == b[begin]) ++begin;
  std::size_t end = 0;
  while (end < a.size() - begin && end < b.size() - begin && a[a.size() - 1 - end] == b[b.size() - 1 - end]) ++end;
  const auto middle = [&](const Lines& lines) {
    return Lines(lines.begin() + static_cast<std::ptrdiff_t>(begin), lines.end() - static_cast<std::ptrdiff_t>(end));
  };
  a = middle(a);
  b = middle(b);
  // Follow the longest common subsequence.
  std::vector<std::string> result;
  std::size_t count = 0;
  const auto report = [&](char sign, std::size_t line, const std::string& text) {
    if (++count <= max) result.push_back(fmt::format("{} {:>5}  {}", sign, begin + line + 1, text));
  };
  std::size_t i = 0, j = 0;
  if (a.size() * b.size() <= 25'000'000) {
    const auto lengths = common_lengths(a, b);
    while (i < a.size() && j < b.size()) {
      if (a[i] == b[j]) {
        ++i, ++j;
      } else if (lengths[i + 1][j] >= lengths[i][j + 1]) {
        report('-', i, a[i]), ++i;
      } else {
        report('+', j, b[j]), ++j;
      }
    }
  }
  // Remaining lines.
  for (; i < a.size(); ++i) report('-', i, a[i]);
  for (; j < b.size(); ++j) report('+', j, b[j]);
  if (count > max) result.push_back(fmt::format("and {} more lines", count - max));
  return result;
}

namespace {

std::vector<std::string> entities_in(const sim::WorldConfig& world) {
  std::vector<std::string> entities;
  const auto add = [&](const std::string& kind, const std::string& name) {
    if (!name.empty()) entities.push_back(kind + " '" + name + "'");
  };
  for (const sim::ObjectConfig& object : world.objects) add("object", object.name);
  for (const sim::VehicleInstance& vehicle : world.vehicles) {
    add("vehicle", vehicle.name);
    for (const sim::DeviceConfig& device : vehicle.config->devices) add("device", vehicle.name + "/" + device.name);
  }
  for (const sim::EventConfig& event : world.events) add("event", event.name);
  return entities;
}

}  // namespace

std::vector<std::string> entities_only_in(const sim::WorldConfig& world, const sim::WorldConfig& other) {
  const std::vector<std::string> others = entities_in(other);
  const std::set<std::string> known(others.begin(), others.end());
  std::vector<std::string> entities = entities_in(world);
  std::erase_if(entities, [&](const std::string& entity) { return known.contains(entity); });
  return entities;
}

}  // namespace experiment
