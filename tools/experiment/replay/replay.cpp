// SPDX-License-Identifier: BSD-3-Clause
#include "tools/experiment/replay/replay.hpp"

#include <spdlog/fmt/fmt.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <map>
#include <memory>
#include <set>

#include "bridges/control/sim_service.hpp"
#include "bridges/lockstep/lockstep_service.hpp"
#include "bridges/log/run_journal.hpp"
#include "messages/yaml/message_writer.hpp"
#include "shoal/message_codec.hpp"
#include "sim/bus/in_process_bus.hpp"
#include "sim/bus/message_gate.hpp"
#include "sim/config/message_text.hpp"
#include "sim/world/world_state.hpp"
#include "tools/experiment/replay/line_difference.hpp"
#include "tools/experiment/replay/replay_messages.hpp"
#include "tools/experiment/replay/replay_ports.hpp"
#include "tools/experiment/run/runner.hpp"
#include "tools/experiment/snapshot/run_identity.hpp"
#include "tools/experiment/snapshot/world_difference.hpp"
#include "tools/experiment/terminal/progress.hpp"

namespace tools {

namespace {

using bridges::RunJournal;
using Input = ReplayLog::Input;

/// Bus without other participants.
struct Line {
  std::unique_ptr<sim::InProcessBus> network = std::make_unique<sim::InProcessBus>();
  std::unique_ptr<sim::MessageGate> gate = std::make_unique<sim::MessageGate>(*network);
};

/// Returns the world to run: that of the log, or a replacement.
sim::LoadedWorld load(const ReplayLog& log, const ReplayOptions& options) {
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

class Replay {
 public:
  explicit Replay(const ReplayOptions& options)
      : options_(options),
        log_(read_replay_log(options.log)),
        loaded_(load(log_, options)),
        messages_(log_),
        main_(make_line()),
        others_(make_others()),
        world_(loaded_.config, *main_.gate, serial_.opener(),
               [this](const std::string& name) -> sim::Bus& { return *others_.at(name).gate; }),
        service_(*main_.gate, *main_.network, world_, control_, lockstep_,
                 {sim::to_yaml(loaded_.resolved), version_text(), build_text(), log_.info.files}) {
    check_times();
    restore();
    world_.use_threads(options.threads);
    for (const Input& input : log_.inputs)
      if (input.bus == RunJournal::serial_bus) serial_.add(input);
  }

  ReplayOutcome run() {
    const auto begin = std::chrono::steady_clock::now();
    outcome_.step_s = sim::to_seconds(world_.step_time());
    const std::int64_t last = last_step();
    outcome_.begin_step = world_.step_number();
    Progress progress(static_cast<double>(last) * outcome_.step_s, options_.quiet);
    // Deliver the inputs and step, as in the run.
    hand_over(RunJournal::before_first_reports);
    after_step();
    try {
      while (world_.step_number() < last && caught_signal() == 0) {
        hand_over(world_.step_number());
        for_each_line([](Line& line) { line.gate->admit(); });
        serial_.begin_step(world_.step_number());
        world_.step();
        after_step();
        progress.update(world_.now(), messages_.equal(), control_, false);
      }
    } catch (const sim::PhysicsFault& error) {
      differ("the world", std::string("physics fault here: ") + error.what());
    }
    // Compare the end of the run.
    progress.clear();
    if (!cut_ && log_.cut.empty() && world_.step_number() == log_.last_step) finish();
    messages_.finish(world_.step_number());
    outcome_.wall_s = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
    conclude();
    return std::move(outcome_);
  }

 private:
  Line make_line() {
    Line line;
    line.gate->set_watch([this](std::string_view channel, std::span<const std::byte> payload) {
      messages_.published(channel, payload, world_.step_number());
    });
    return line;
  }
  std::map<std::string, Line> make_others() {
    std::map<std::string, Line> others;
    for (const sim::BusConfig& bus : loaded_.config.buses) others.emplace(bus.name, make_line());
    return others;
  }
  template <typename Use>
  void for_each_line(Use&& use) {
    use(main_);
    for (auto& [name, line] : others_) use(line);
  }

  void check_times() const {
    if (world_.step_time().count() != log_.info.step_us)
      throw std::runtime_error(
          fmt::format("{}: its run has steps of {} us, the world here of {} us: there is nothing to "
                      "compare",
                      log_.path, log_.info.step_us, world_.step_time().count()));
    if (world_.epoch_us() != log_.info.epoch_utime)
      throw std::runtime_error(fmt::format("{}: its run has the epoch {}, the world here {}: all stamps would differ",
                                           log_.path, log_.info.epoch_utime, world_.epoch_us()));
    if (!log_.bad_snapshot.empty() && !log_.snapshot && log_.usable_step() < log_.last_step)
      throw std::runtime_error(log_.path + ": cannot be replayed: " + log_.bad_snapshot);
    if (log_.proven_step && *log_.proven_step <= log_.begin_step() && log_.usable_step() < log_.last_step)
      throw std::runtime_error(log_.path + ": cannot be replayed from the start: " + log_.holes.front() +
                               "; the log starts later than the run");
    if (log_.last_step == log_.begin_step() && !log_.hashes.contains(log_.begin_step()))
      throw std::runtime_error(log_.path + ": ends before the first step");
  }

  /// Restores the snapshot with which the run, or the branch, started.
  void restore() {
    if (!log_.snapshot) return;
    const std::string who = log_.path + ": sim.snapshot";
    check_version(*log_.snapshot, who, short_version());
    try {
      world_.state().restore(log_.snapshot->state);
      auto owners = sim::StateArchive::restorer(log_.snapshot->owners);
      owners.section("owners");
      service_.visit_state(owners);
      owners.end();
    } catch (const sim::SnapshotError& error) {
      throw std::runtime_error(who + ": " + error.what());
    }
    if (world_.state().hash() != log_.snapshot->state_hash && options_.load.sets.empty() && options_.world.empty())
      throw std::runtime_error(who + ": its state hash after restoring differs from the one that was written");
  }

  std::int64_t last_step() {
    std::int64_t last = log_.usable_step();
    if (options_.until_s) {
      const double steps = std::floor(*options_.until_s / outcome_.step_s + 1e-9);
      if (steps < static_cast<double>(last)) {
        cut_ = true;
        last = static_cast<std::int64_t>(steps);
      }
    }
    if (last < world_.step_number())
      throw std::runtime_error(
          fmt::format("{}: begins at {:.6g} s, after --until", log_.path, sim::to_seconds(world_.now())));
    return last;
  }

  /// Delivers the inputs of the world before this step.
  void hand_over(std::int64_t step) {
    for (; next_input_ < log_.inputs.size() && log_.inputs[next_input_].step <= step; ++next_input_) {
      const Input& input = log_.inputs[next_input_];
      if (input.bus == RunJournal::serial_bus) continue;
      if (input.bus.empty() && input.channel == RunJournal::request_channel) {
        execute(input);
        continue;
      }
      const auto other = input.bus.empty() ? others_.end() : others_.find(input.bus);
      if (!input.bus.empty() && other == others_.end()) {
        note("the world here has no bus '" + sim::printable(sim::shortened(input.bus)) +
             "': its inputs are not delivered");
        continue;
      }
      sim::MessageGate& gate = input.bus.empty() ? *main_.gate : *other->second.gate;
      gate.waiting().push_back({input.channel, input.payload});
    }
  }

  /// Executes the requests after the last step.
  void finish() {
    hand_over(world_.step_number());
    if (!outcome_.first) report_first_messages();
    const auto last = log_.hashes.find(world_.step_number());
    if (last != log_.hashes.end() && last->second.after_inputs) compare_hashes(last->second);
  }

  void execute(const Input& input) {
    try {
      service_.execute_again(shoal::decode<shoal::sim_control_request_t>(input.payload, shoal::Finite::any));
    } catch (const shoal::MessageError& error) {
      note(std::string("a request in the log cannot be read: ") + error.what());
    } catch (const std::exception&) {
      // It was rejected in the run as well, or the state will differ.
    }
  }

  void note(const std::string& text) {
    auto& notes = outcome_.notes;
    if (notes.size() < 20 && std::find(notes.begin(), notes.end(), text) == notes.end()) notes.push_back(text);
  }

  void after_step() {
    service_.publish_step();
    if (!outcome_.first) report_first_messages();
    while (next_hash_ != log_.hashes.end() && next_hash_->first < world_.step_number()) ++next_hash_;
    const bool due = next_hash_ != log_.hashes.end() && next_hash_->first == world_.step_number();
    if (due && !next_hash_->second.after_inputs) compare_hashes(next_hash_->second);
  }

  /// Reports the messages and channels that differ for the first time at this step.
  void report_first_messages() {
    constexpr std::size_t max = 8;
    if (messages_.first() == nullptr) return;
    differ(who(messages_.first()->channel), messages_.first()->what);
    for (const auto& [channel, difference] : messages_.by_channel())
      if (channel != messages_.first()->channel && outcome_.first->what.size() < max)
        differ(who(channel), difference.what);
  }

  void compare_hashes(const ReplayLog::Hashes& logged) {
    ++outcome_.hashes;
    if (logged.whole == world_.state().hash()) {
      if (logged.run && *logged.run != world_.state().run_hash() && !outcome_.first)
        differ("the world",
               "its run hash differs and its state hash does not: a message or a state before was another");
      if (equal_parts_.size() < logged.parts.size())
        for (const sim::PartHash& part : logged.parts) equal_parts_.insert(part.part);
      return;
    }
    if (!outcome_.first || outcome_.first->step == world_.step_number()) differ("the world", "its state hash differs");
    if (!parts_.empty() && motion_step_) return;  // at later steps nearly all parts differ
    std::map<std::string, std::uint64_t> here;
    for (const auto& part : world_.state().part_hashes()) here[part.part] = part.hash;
    compare_motion(logged, here);
    compare_parts(logged, here);
  }

  /// Finds the first motion that differs, of vehicles and objects that were equal at an earlier hash: those with
  /// different definitions differ from the start.
  void compare_motion(const ReplayLog::Hashes& logged, const std::map<std::string, std::uint64_t>& here) {
    if (motion_step_) return;
    for (const sim::PartHash& part : logged.parts) {
      const bool moves = part.part == "objects" || world_.find_vehicle(part.part) != nullptr;
      const auto own = here.find(part.part);
      if (!moves || own == here.end()) continue;
      if (own->second == part.hash) {
        equal_parts_.insert(part.part);
      } else if (equal_parts_.contains(part.part)) {
        motion_step_ = world_.step_number();
        moved_parts_.push_back(part.part);
      }
    }
  }

  void compare_parts(const ReplayLog::Hashes& logged, std::map<std::string, std::uint64_t> here) {
    if (!parts_.empty()) return;
    for (const sim::PartHash& part : logged.parts) {
      const auto own = here.find(part.part);
      if (own == here.end())
        parts_.push_back(part.part + " (only in the log)");
      else if (own->second != part.hash)
        parts_.push_back(part.part);
      if (own != here.end()) here.erase(own);
    }
    for (const auto& [part, hash] : here)
      if (!logged.parts.empty()) parts_.push_back(part + " (only here)");
    if (parts_.empty()) return;
    parts_step_ = world_.step_number();
    if (outcome_.first && outcome_.first->step == parts_step_)
      outcome_.first->what.push_back("state that differs: " + fmt::format("{}", fmt::join(few(parts_), ", ")));
  }

  static std::vector<std::string> few(const std::vector<std::string>& all) {
    constexpr std::size_t max = 12;
    std::vector<std::string> some(all.begin(), all.begin() + static_cast<std::ptrdiff_t>(std::min(all.size(), max)));
    if (all.size() > max) some.push_back(fmt::format("and {} more", all.size() - max));
    return some;
  }

  void differ(const std::string& subject, const std::string& what) {
    if (!outcome_.first) outcome_.first = ReplayOutcome::First{world_.step_number(), {}};
    if (outcome_.first->step == world_.step_number()) outcome_.first->what.push_back(subject + ": " + what);
  }

  /// Returns the device that reports on a channel, else the channel.
  std::string who(const std::string& channel) const {
    for (const auto& device : world_.devices())
      if (device && device->report_channel() == channel) return device->full_name() + " (" + channel + ")";
    return channel;
  }

  void conclude() {
    outcome_.steps = world_.step_number() - outcome_.begin_step;
    outcome_.sim_time_s = static_cast<double>(outcome_.steps) * outcome_.step_s;
    outcome_.messages = messages_.equal();
    outcome_.missing_messages = messages_.missing();
    if (!outcome_.first) report_first_messages();
    outcome_.interrupted = caught_signal() != 0;
    outcome_.complete = cut_ || (log_.usable_step() >= log_.last_step && !outcome_.interrupted);
    if (outcome_.hashes + outcome_.messages == 0 && !outcome_.first)
      throw std::runtime_error(log_.path + ": holds neither hashes nor messages to compare with");
    report_log();
    if (!options_.world.empty() || !options_.load.sets.empty()) compare_worlds();
    if (outcome_.first) outcome_.motion = motion();
    if (outcome_.first) write_report();
  }

  void compare_worlds() {
    constexpr std::size_t max_lines = 12;
    std::vector<std::string>& world = outcome_.world;
    try {
      sim::LoadOptions load = options_.load;
      load.sets.clear();
      load.serial_ports = false;
      allow_files(log_.info.files, load);
      load.encode_message = shoal::encode_own_message;
      const sim::WorldConfig logged =
          sim::load_world_text(log_.info.resolved_config, log_.path + ": sim.info", load).config;
      for (const std::string& entity : entities_only_in(logged, loaded_.config))
        world.push_back("only in the log: " + entity);
      for (const std::string& entity : entities_only_in(loaded_.config, logged))
        world.push_back("only here: " + entity);
    } catch (const std::exception&) {
      // A mesh of the log may be missing; its lines can be compared nevertheless.
    }
    for (std::string& line : line_difference(log_.info.resolved_config, sim::to_yaml(loaded_.resolved), max_lines))
      world.push_back(std::move(line));
  }

  std::string motion() const {
    const ReplayMessages::Difference* first = messages_.first_motion();
    if (first != nullptr && (!motion_step_ || first->step <= *motion_step_))
      return at(first->step) + ", by sim.state: " + first->what;
    if (motion_step_)
      return at(*motion_step_) + ", by the hash: " + fmt::format("{}", fmt::join(few(moved_parts_), ", "));
    return "";
  }

  void report_log() {
    // Gaps of the log.
    if (!log_.cut.empty()) note(log_.cut);
    for (const std::string& hole : log_.holes) note(hole);
    if (!outcome_.complete && !log_.holes.empty())
      note(
          fmt::format("the log lacks inputs after step {}, although it extends to step {}: nothing after step {} can "
                      "be verified",
                      log_.usable_step(), log_.last_step, log_.usable_step()));
    // Properties of the log.
    const std::string wrote = log_.info.versions.substr(0, log_.info.versions.find('\n'));
    if (wrote != "shoal " + short_version())
      note("written by " + sim::shortened(sim::printable(wrote)) + "; this is shoal " + short_version());
    if (outcome_.interrupted) note("interrupted");
    if (log_.is_rewound) note("the log holds several branches; only hashes are compared");
    if (!log_.bad_snapshot.empty()) note(log_.bad_snapshot);
    if (log_.first_step > log_.begin_step()) note(fmt::format("the log begins at step {}", log_.first_step));
    if (log_.hashes.empty()) note("the log holds no hashes: only messages are compared");
    // Messages that the log lacks.
    if (outcome_.missing_messages > 0 && !(log_.own_stamps && outcome_.first))
      note(fmt::format("{} messages that were published here are not in the log, the first at {}: {}",
                       outcome_.missing_messages, at(messages_.first_missing()->step),
                       messages_.first_missing()->channel));
    // Problems and interventions.
    for (const std::string& problem : log_.problems) note("the log: " + problem);
    for (const std::string& audit_entry : log_.audit) note("in the run: " + audit_entry);
  }

  std::string at(std::int64_t step) const {
    return fmt::format("step {} ({:.3f} s)", step, static_cast<double>(step) * outcome_.step_s);
  }

  void write_report() {
    auto& report = outcome_.report;
    const auto section = [&](const std::string& title, const std::vector<std::string>& lines) {
      if (lines.empty()) return;
      report.push_back(title + ":");
      for (const std::string& line : lines) report.push_back("  " + line);
    };
    // Versions and state.
    section("Versions (- in the log, + here)", line_difference(log_.info.versions, version_text()));
    section("Machine (- in the log, + here)", line_difference(log_.info.build, build_text()));
    if (!parts_.empty()) section("State that differs at the first hash that does, " + at(parts_step_), few(parts_));
    // True positions.
    std::vector<std::string> lines;
    for (const auto& [vehicle, distance] : messages_.distances())
      lines.push_back(fmt::format("{}: from {} on, at most {:.6g} m at {}", vehicle, at(distance.first_step),
                                  distance.max_m, at(distance.max_step)));
    section("True positions", lines);
    // Channels in order of their first difference.
    lines.clear();
    std::vector<const ReplayMessages::Difference*> channels;
    for (const auto& [channel, difference] : messages_.by_channel()) channels.push_back(&difference);
    std::stable_sort(channels.begin(), channels.end(), [](const auto* a, const auto* b) { return a->step < b->step; });
    for (const ReplayMessages::Difference* difference : channels)
      lines.push_back(fmt::format("{}: {}: {}", at(difference->step), difference->channel, difference->what));
    section(fmt::format("Channels, where each differs first ({} messages differ)", messages_.different()), lines);
  }

  const ReplayOptions& options_;
  ReplayLog log_;
  sim::LoadedWorld loaded_;
  ReplayOutcome outcome_;
  ReplayMessages messages_;
  ReplayPorts serial_;
  Line main_;
  std::map<std::string, Line> others_;
  sim::RunControl control_;
  sim::World world_;
  bridges::LockstepService lockstep_{world_, control_};  // no client joins
  bridges::SimService service_;
  std::size_t next_input_ = 0;
  std::map<std::int64_t, ReplayLog::Hashes>::const_iterator next_hash_ = log_.hashes.begin();
  bool cut_ = false;
  std::vector<std::string> parts_;
  std::int64_t parts_step_ = 0;
  std::set<std::string> equal_parts_;        // moving parts that were equal at a hash
  std::vector<std::string> moved_parts_;     // parts that differ at the first hash at which one of those does
  std::optional<std::int64_t> motion_step_;  // step of that hash
};

}  // namespace

ReplayOutcome replay(const ReplayOptions& options) {
  return std::make_unique<Replay>(options)->run();
}

}  // namespace tools
