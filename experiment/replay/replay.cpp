// SPDX-License-Identifier: BSD-3-Clause
#include "experiment/replay/replay.hpp"

#include <spdlog/fmt/fmt.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <map>
#include <memory>
#include <set>

#include "experiment/replay/replay_messages.hpp"
#include "experiment/replay/replayed_world.hpp"
#include "experiment/run/version.hpp"
#include "experiment/snapshot/run_identity.hpp"
#include "experiment/terminal/progress.hpp"
#include "messages/yaml/message_writer.hpp"
#include "sim/config/message_text.hpp"
#include "sim/world/world_state.hpp"

namespace experiment {

namespace {

class Replay {
 public:
  explicit Replay(const ReplayOptions& options)
      : options_(options),
        log_(read_replay_log(options.log)),
        messages_(log_),
        replayed_(log_, {options.world, options.load, options.threads},
                  [this](std::string_view channel, std::span<const std::byte> payload) {
                    messages_.published(channel, payload, replayed_.world().step_number());
                  }),
        world_(replayed_.world()) {}

  ReplayOutcome run() {
    const auto begin = std::chrono::steady_clock::now();
    outcome_.step_s = sim::to_seconds(world_.step_time());
    const std::int64_t last = last_step();
    outcome_.begin_step = world_.step_number();
    Progress progress(static_cast<double>(last) * outcome_.step_s, options_.quiet);
    // Deliver the inputs and step, as in the run.
    replayed_.start();
    after_step();
    try {
      while (world_.step_number() < last && caught_signal() == 0) {
        replayed_.step();
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

  /// Executes the requests after the last step.
  void finish() {
    replayed_.finish();
    if (!outcome_.first) report_first_messages();
    const auto last = log_.hashes.find(world_.step_number());
    if (last != log_.hashes.end() && last->second.after_inputs) compare_hashes(last->second);
  }

  void note(const std::string& text) {
    auto& notes = outcome_.notes;
    if (notes.size() < 20 && std::find(notes.begin(), notes.end(), text) == notes.end()) notes.push_back(text);
  }

  void after_step() {
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
      for (const std::string& entity : entities_only_in(logged, replayed_.loaded().config))
        world.push_back("only in the log: " + entity);
      for (const std::string& entity : entities_only_in(replayed_.loaded().config, logged))
        world.push_back("only here: " + entity);
    } catch (const std::exception&) {
      // A mesh of the log may be missing; its lines can be compared nevertheless.
    }
    for (std::string& line :
         line_difference(log_.info.resolved_config, sim::to_yaml(replayed_.loaded().resolved), max_lines))
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
    for (const std::string& text : replayed_.notes()) note(text);
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
  ReplayOutcome outcome_;
  ReplayMessages messages_;
  ReplayedWorld replayed_;
  sim::World& world_;
  sim::RunControl control_;
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

}  // namespace experiment
