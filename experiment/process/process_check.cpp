// SPDX-License-Identifier: BSD-3-Clause
#include "experiment/process/process_check.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numeric>
#include <optional>
#include <set>
#include <stdexcept>
#include <string>
#include <vector>

#include "experiment/process/process_group.hpp"
#include "experiment/process/world_programs.hpp"
#include "sim/base/number.hpp"
#include "sim/config/message_text.hpp"
#include "sim/program/find_program.hpp"
#include "sim/program/program_args.hpp"
#include "sim/vehicle/vehicle.hpp"
#include "sim/world_file/config_warnings.hpp"

namespace experiment {
namespace {

/// Slots of a sender, in microseconds.
struct Slots {
  std::int64_t start_us, length_us, cycle_us;
  /// Returns whether a slot of one ever overlaps a slot of the other.
  bool meets(const Slots& other) const {
    const std::int64_t common_us = std::gcd(cycle_us, other.cycle_us);
    const std::int64_t apart_us = ((other.start_us - start_us) % common_us + common_us) % common_us;
    return apart_us < length_us || common_us - apart_us < other.length_us;
  }
};

/// Process, with the declaration of its program if it has one.
class Program {
 public:
  Program(const sim::LoadedWorld& loaded, std::size_t index)
      : config_(loaded.config.processes[index]), written_(written_process(loaded, index)) {
    if (written_.program.empty() || config_.command.empty()) return;
    sim::Diagnostics ignored;
    declaration_ = sim::read_declaration_file(config_.command.front() + sim::declaration_ending, ignored);
    if (!ignored.ok()) declaration_.reset();
  }

  const sim::ProcessConfig& config() const { return config_; }
  std::string who() const { return (written_.is_bridge ? "bridge '" : "process '") + config_.name + "'"; }
  /// Returns whether the program comes with Shoal, so that the meaning of its arguments is known.
  bool is_shipped() const { return declaration_ && written_.program.starts_with("shoal-"); }
  const sim::SourcePlace& place(const char* argument) const {
    const sim::ConfigNode* value = written_.args->find(argument);
    return value != nullptr ? value->place : written_.place;
  }

  bool has(const char* argument) const { return written_.args->find(argument) != nullptr; }
  /// Value in the world or the declaration; empty: in neither.
  std::string value_of(const char* argument) const {
    return declaration_ ? sim::text_of_arg(*declaration_, *written_.args, argument) : std::string();
  }
  /// Vehicle that it drives, which is also its name in the lockstep.
  std::string vehicle() const { return value_of("name"); }
  /// The channels that it publishes on; empty: unknown.
  std::optional<std::vector<std::string>> published() const {
    return declaration_ ? channels(declaration_->publishes) : std::nullopt;
  }
  /// The channels that it subscribes to; empty: unknown.
  std::optional<std::vector<std::string>> subscribed() const {
    return declaration_ ? channels(declaration_->subscribes) : std::nullopt;
  }
  bool sends() const { return has("slot") || has("random_s"); }
  std::string slot_text() const { return value_of("slot") + "/" + value_of("slots"); }

  /// Returns std::nullopt without slots, and for text that the program itself rejects.
  std::optional<Slots> slots() const {
    try {
      const int slot = std::stoi(value_of("slot")), slots = std::stoi(value_of("slots"));
      const double slot_s = sim::read_number(value_of("slot_s")).value_or(0);
      if (slot < 0 || slot >= slots || !(slot_s >= 0.1 && slot_s <= 3600)) return std::nullopt;
      const std::int64_t length_us = std::llround(slot_s * 1e6);
      return Slots{slot * length_us, length_us, slots * length_us};
    } catch (const std::exception&) {
      return std::nullopt;
    }
  }

 private:
  std::optional<std::vector<std::string>> channels(const std::optional<std::vector<std::string>>& patterns) const {
    if (!patterns) return std::nullopt;
    std::vector<std::string> channels;
    for (const std::string& pattern : *patterns)
      channels.push_back(sim::channel_of(*declaration_, *written_.args, pattern));
    return channels;
  }

  const sim::ProcessConfig& config_;
  WrittenProcess written_;
  std::optional<sim::ProgramDeclaration> declaration_;
};

std::vector<Program> programs_of(const sim::LoadedWorld& loaded) {
  std::vector<Program> programs;
  for (std::size_t i = 0; i < loaded.config.processes.size(); ++i) programs.emplace_back(loaded, i);
  return programs;
}

const sim::VehicleInstance* find_vehicle(const sim::WorldConfig& world, const std::string& name) {
  const auto found = std::find_if(world.vehicles.begin(), world.vehicles.end(),
                                  [&](const sim::VehicleInstance& each) { return each.name == name; });
  return found == world.vehicles.end() ? nullptr : &*found;
}

/// Returns a key of the device `modem` of a vehicle from its file; empty: not set.
std::string key_of_modem(const sim::WorldConfig& world, const std::string& vehicle, const char* key) {
  const sim::VehicleInstance* found = find_vehicle(world, vehicle);
  if (found == nullptr) return {};
  for (const sim::DeviceConfig& device : found->config->devices)
    if (device.name == "modem" && device.source)
      if (const sim::ConfigNode* value = device.source->find(key)) return value->scalar;
  return {};
}

/// Returns whether two modems can interfere: their configuration does not separate them in frequency.
bool share_the_water(const sim::WorldConfig& world, const std::string& a, const std::string& b) {
  for (const char* key : {"frequency_Hz", "preset"}) {
    const std::string of_a = key_of_modem(world, a, key), of_b = key_of_modem(world, b, key);
    if (!of_a.empty() && !of_b.empty() && of_a != of_b) return false;
  }
  return true;
}

void check_slots(const sim::WorldConfig& world, const std::vector<Program>& programs, sim::Warnings& warnings) {
  for (std::size_t i = 0; i < programs.size(); ++i)
    for (std::size_t j = 0; j < i; ++j) {
      const Program &later = programs[i], &earlier = programs[j];
      if (!later.is_shipped() || !earlier.is_shipped()) continue;
      const auto slots = later.slots(), taken = earlier.slots();
      if (!slots || !taken || !slots->meets(*taken)) continue;
      // Packets only collide where both are received.
      if (!share_the_water(world, later.vehicle(), earlier.vehicle())) continue;
      const std::string both =
          slots->cycle_us == taken->cycle_us
              ? "is also that of " + earlier.who()
              : "meets that of " + earlier.who() + " (" + earlier.slot_text() + "), whose cycle has another length";
      warnings.warn(later.place("slot"), later.who(),
                    "its slot " + later.slot_text() + " " + both + ": their packets collide");
    }
}

void check_follow(const sim::WorldConfig& world, const std::vector<Program>& programs, sim::Warnings& warnings) {
  for (const Program& program : programs) {
    if (!program.is_shipped() || !program.has("follow")) continue;
    const std::string other = program.value_of("follow");
    if (find_vehicle(world, other) == nullptr) {
      warnings.warn(program.place("follow"), program.who(),
                    "it is to follow '" + other + "', and there is no such vehicle");
      continue;
    }
    const auto driver = std::find_if(programs.begin(), programs.end(),
                                     [&](const Program& each) { return each.is_shipped() && each.vehicle() == other; });
    if (driver != programs.end() && !driver->sends())
      warnings.warn(
          program.place("follow"), program.who(),
          "it is to follow '" + other + "', whose program sends nothing: it has neither 'slot' nor 'random_s'");
  }
}

void check_names(const std::vector<Program>& programs, sim::Warnings& warnings) {
  for (const Program& program : programs) {
    const std::string &client = program.config().client, vehicle = program.vehicle();
    if (program.is_shipped() && !client.empty() && !vehicle.empty() && client != vehicle)
      warnings.warn(program.place("name"), program.who(),
                    "the run waits for client '" + client + "', but its program joins as '" + vehicle + "'");
  }
}

void check_metrics(const sim::WorldConfig& world, const std::vector<Program>& programs, sim::Warnings& warnings) {
  if (programs.empty()) return;  // the loader has checked the others
  std::set<std::string> spoken = sim::channels_of(world);
  for (const Program& program : programs) {
    const auto channels = program.published();
    if (!channels) return;
    spoken.insert(channels->begin(), channels->end());
  }
  for (const sim::MetricConfig& metric : world.metrics) {
    const std::string& channel = metric.params->channel;
    if (channel.empty() || channel.starts_with("sim.") || spoken.contains(channel)) continue;
    warnings.warn(metric.place, "metric '" + metric.name + "'",
                  "no device and no program of this world publishes on '" + channel + "'" +
                      sim::did_you_mean(channel, {spoken.begin(), spoken.end()}));
  }
}

/// Warns of events that publish where no device, metric, condition or program subscribes.
void check_events(const sim::WorldConfig& world, const std::vector<Program>& programs, sim::Warnings& warnings) {
  std::set<std::string> subscribed = sim::subscribed_channels_of(world);
  for (const Program& program : programs) {
    const auto channels = program.subscribed();
    if (!channels) return;
    subscribed.insert(channels->begin(), channels->end());
  }
  for (const sim::EventConfig& event : world.events) {
    std::set<std::string> published;
    for (const sim::ActionEntry& entry : event.actions)
      if (entry.action) entry.action->add_channels(published);
    for (const std::string& channel : published)
      if (!subscribed.contains(channel))
        warnings.warn(event.place, "event '" + event.name + "'",
                      "no device and no program of this world subscribes to '" + channel + "'" +
                          sim::did_you_mean(channel, {subscribed.begin(), subscribed.end()}));
  }
}

}  // namespace

void warn_of_processes(const sim::LoadedWorld& loaded, sim::Warnings& warnings) {
  const std::vector<Program> programs = programs_of(loaded);
  check_slots(loaded.config, programs, warnings);
  check_follow(loaded.config, programs, warnings);
  check_names(programs, warnings);
  check_metrics(loaded.config, programs, warnings);
  check_events(loaded.config, programs, warnings);
}

std::set<std::string> channels_of_programs(const sim::LoadedWorld& loaded) {
  std::set<std::string> declared;
  for (const Program& program : programs_of(loaded))
    for (const auto& channels : {program.published(), program.subscribed()})
      if (channels) declared.insert(channels->begin(), channels->end());
  return declared;
}

void warn_of_missing_programs(const sim::LoadedWorld& loaded, sim::Warnings& warnings) {
  for (std::size_t i = 0; i < loaded.config.processes.size(); ++i) {
    const sim::ProcessConfig& process = loaded.config.processes[i];
    if (process.command.empty() || can_be_started(process.command.front())) continue;
    const std::string& program = process.command.front();
    warnings.warn(written_process(loaded, i).place, "process '" + process.name + "'",
                  "there is no program '" + program + "'" +
                      (program.find('/') == std::string::npos ? " beside shoal or in PATH" : ""));
  }
}

void warn_of_unchecked_arguments(const sim::LoadedWorld& loaded, sim::Warnings& warnings) {
  const std::vector<std::string> folders = sim::program_folders();
  for (std::size_t i = 0; i < loaded.config.processes.size(); ++i) {
    const sim::ProcessConfig& process = loaded.config.processes[i];
    const WrittenProcess written = written_process(loaded, i);
    if (!written.program.empty() || process.command.empty()) continue;
    const std::string& program = process.command.front();
    // Only a hint is derived from the declaration; its own errors are reported elsewhere.
    sim::Diagnostics ignored;
    const sim::FoundProgram found =
        sim::find_program(program, folders, loaded.config.files.get(), written.place, "", ignored);
    if (found.declaration != nullptr)
      warnings.warn(written.place, "process '" + process.name + "'",
                    "the arguments in 'command' are not checked; those of 'program: " + program +
                        "' with 'args:' are, by its declaration");
  }
}

namespace {

using Names = std::set<std::string, std::less<>>;

std::string in_quotes(std::string_view name) {
  return "'" + sim::shortened(name) + "'";
}

class ChannelCheck {
 public:
  ChannelCheck(const sim::LoadedWorld& loaded, const sim::World& world, const bridges::ChannelUse& use,
               bool is_recorded, sim::Warnings& warnings)
      : world_(world),
        use_(use),
        is_recorded_(is_recorded),
        warnings_(warnings),
        declared_(channels_of_programs(loaded)) {
    for (const std::string& channel : sim::channels_of(loaded.config)) spoken_.insert(channel);
    Names received;
    for (const std::string& channel : sim::subscribed_channels_of(loaded.config)) received.insert(channel);
    for (const auto& device : world.devices()) {  // also those of vehicles that were added
      if (!device) continue;
      if (device->senses()) {
        spoken_.insert(device->report_channel());
        if (device->config().truth)
          spoken_.insert(sim::device_channel(loaded.config.channels, device->vehicle().name(), device->config(),
                                             sim::ChannelKind::truth));
      }
      if (device->mailbox() != nullptr) received.insert(device->command_channel());
    }
    for (const auto& [client, channels] : use.clients())
      for (const auto& [channel, each] : channels) {
        if (each.published > 0) spoken_.insert(channel);
        if (each.is_subscribed) received.insert(channel);
      }
    for (const auto& [client, channels] : use.clients())
      for (const auto& [channel, each] : channels)
        if (each.published > 0) received.erase(channel);
    unused_.assign(received.begin(), received.end());
  }

  void check() const {
    for (const auto& [client, channels] : use_.clients()) {
      const std::string who = "client " + in_quotes(client);
      std::vector<std::string> unread;
      for (const auto& [channel, each] : channels) {
        // Declared programs are checked before the run, with the line of the world.
        if (declared_.contains(channel) || channel.starts_with("sim.")) continue;
        if (each.published > 0) check_published(who, channel, each, unread);
        if (each.is_subscribed && !each.has_received && !spoken_.contains(channel))
          warnings_.warn({}, who,
                         "it subscribes to " + in_quotes(channel) + ", on which nothing was published" +
                             sim::did_you_mean(channel, {spoken_.begin(), spoken_.end()}));
      }
      if (!unread.empty())
        warnings_.warn(
            {}, who,
            "no device, metric or client of this run receives what it published on " + sim::list_text(unread, 5));
    }
  }

 private:
  /// Adds a channel that nothing reads to `unread`, unless its fault is known.
  void check_published(const std::string& who, const std::string& channel, const bridges::ChannelUse::Use& use,
                       std::vector<std::string>& unread) const {
    const std::string published = "it published " + std::to_string(use.published) +
                                  (use.published == 1 ? " message" : " messages") + " on " + in_quotes(channel);
    for (const auto& device : world_.devices())
      if (device && device->mailbox() != nullptr && device->senses() && device->report_channel() == channel)
        return warnings_.warn({}, who,
                              published + ", where device '" + device->full_name() +
                                  "' reports; it takes commands on " + in_quotes(device->command_channel()));
    if (use.is_read) return;
    const std::string meant = sim::did_you_mean(channel, unused_);
    if (!meant.empty()) return warnings_.warn({}, who, published + ", which nothing reads" + meant);
    if (!is_recorded_ || channel.ends_with(".cmd")) unread.push_back(in_quotes(channel));
  }

  const sim::World& world_;
  const bridges::ChannelUse& use_;
  const bool is_recorded_;
  sim::Warnings& warnings_;
  const std::set<std::string> declared_;
  Names spoken_;                     // published by something
  std::vector<std::string> unused_;  // received by something, and published by no client
};

}  // namespace

void warn_of_channels(const sim::LoadedWorld& loaded, const sim::World& world, const bridges::ChannelUse& use,
                      bool is_recorded, sim::Warnings& warnings) {
  ChannelCheck(loaded, world, use, is_recorded, warnings).check();
}

}  // namespace experiment
