// SPDX-License-Identifier: BSD-3-Clause
#include "tools/experiment/process/process_check.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <filesystem>
#include <map>
#include <numeric>
#include <optional>
#include <set>
#include <stdexcept>
#include <vector>

#include "sim/config/message_text.hpp"
#include "sim/world_file/config_warnings.hpp"
#include "tools/autonomy/acomms/tdma.hpp"
#include "tools/experiment/process/process_group.hpp"

namespace tools {

namespace {

/// What a program that comes with Shoal publishes, after `NAME.`.
const std::map<std::string, std::vector<std::string>>& known_programs() {
  static const std::map<std::string, std::vector<std::string>> programs{
      {"shoal-coop-rover", {"drive.cmd", "modem.cmd", "estimate", "odometry_only"}},
      {"shoal-coop-auv", {"autopilot.cmd", "modem.cmd", "estimate", "dead_reckoning"}},
      {"shoal-coop-craft", {"autopilot.cmd", "modem.cmd", "estimate"}},
      {"shoal-coop-station", {"radio.cmd", "knowledge"}},
      {"shoal-balance", {"left_motor.cmd", "right_motor.cmd", "fallen"}}};
  return programs;
}

/// The slots of a sender, in microseconds.
struct Slots {
  std::int64_t begin_us, length_us, cycle_us;
  /// A slot of one meets a slot of the other, sooner or later.
  bool meets(const Slots& other) const {
    const std::int64_t common_us = std::gcd(cycle_us, other.cycle_us);
    const std::int64_t apart_us = ((other.begin_us - begin_us) % common_us + common_us) % common_us;
    return apart_us < length_us || common_us - apart_us < other.length_us;
  }
};

/// A process, with the places of its arguments.
class Program {
 public:
  Program(const sim::ProcessConfig& config, const sim::ConfigNode* node) : config_(config) {
    if (node != nullptr) place_ = node->place;
    const sim::ConfigNode* command = node != nullptr ? node->find("command") : nullptr;
    for (std::size_t i = 0; i < config.command.size(); ++i)
      places_.push_back(command != nullptr && i < command->items.size() ? command->items[i].place : place_);
  }

  const sim::ProcessConfig& config() const { return config_; }
  std::string who() const { return "process '" + config_.name + "'"; }
  const std::string& path() const { return config_.command.front(); }
  std::string file_name() const { return std::filesystem::path(path()).filename().string(); }
  bool known() const { return known_programs().contains(file_name()); }
  const sim::SourcePlace& place(std::size_t argument = 0) const {
    return argument < places_.size() ? places_[argument] : place_;
  }

  /// Which argument has the value of an option, `--slot 0/2` or `--slot=0/2`.
  std::optional<std::size_t> argument_of(const std::string& option) const {
    for (std::size_t i = 1; i < config_.command.size(); ++i) {
      if (config_.command[i] == option && i + 1 < config_.command.size()) return i + 1;
      if (config_.command[i].starts_with(option + "=")) return i;
    }
    return std::nullopt;
  }
  std::string value_of(const std::string& option) const {
    const auto at = argument_of(option);
    if (!at) return {};
    const std::string& text = config_.command[*at];
    return text.starts_with(option + "=") ? text.substr(option.size() + 1) : text;
  }
  /// The vehicle that it drives, which is its name in the lockstep too.
  std::string vehicle() const { return value_of("--name"); }
  bool sends() const { return argument_of("--slot") || argument_of("--random-s"); }

  /// Nothing when it has none, or one that the program itself refuses.
  std::optional<Slots> slots() const {
    try {
      const autonomy::Tdma::Params slot = autonomy::parse_slot(value_of("--slot"));
      const std::string given = value_of("--slot-s");
      const double slot_s = given.empty() ? slot.slot_s : std::stod(given);
      if (!(slot_s >= 0.1 && slot_s <= 3600)) return std::nullopt;
      const std::int64_t length_us = std::llround(slot_s * 1e6);
      return Slots{slot.slot * length_us, length_us, slot.slots * length_us};
    } catch (const std::exception&) {
      return std::nullopt;
    }
  }

 private:
  const sim::ProcessConfig& config_;
  sim::SourcePlace place_;
  std::vector<sim::SourcePlace> places_;
};

std::vector<Program> programs_of(const sim::LoadedWorld& loaded) {
  const sim::ConfigNode* list = loaded.resolved.find("processes");
  std::vector<Program> programs;
  for (std::size_t i = 0; i < loaded.config.processes.size(); ++i)
    if (!loaded.config.processes[i].command.empty())
      programs.emplace_back(loaded.config.processes[i],
                            list != nullptr && i < list->items.size() ? &list->items[i] : nullptr);
  return programs;
}

const sim::VehicleInstance* find_vehicle(const sim::WorldConfig& world, const std::string& name) {
  const auto found = std::find_if(world.vehicles.begin(), world.vehicles.end(),
                                  [&](const sim::VehicleInstance& each) { return each.name == name; });
  return found == world.vehicles.end() ? nullptr : &*found;
}

/// A key as the file gives it to the device `modem` of a vehicle; empty: it does not.
std::string key_of_modem(const sim::WorldConfig& world, const std::string& vehicle, const char* key) {
  const sim::VehicleInstance* found = find_vehicle(world, vehicle);
  if (found == nullptr) return {};
  for (const sim::DeviceConfig& device : found->config->devices)
    if (device.name == "modem" && device.source)
      if (const sim::ConfigNode* value = device.source->find(key)) return value->scalar;
  return {};
}

/// They can disturb each other: what their modems were given does not put them on other frequencies.
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
      if (!later.known() || !earlier.known()) continue;
      const auto slots = later.slots(), taken = earlier.slots();
      if (!slots || !taken || !slots->meets(*taken)) continue;
      if (!share_the_water(world, later.vehicle(), earlier.vehicle())) continue;
      const std::string both = slots->cycle_us == taken->cycle_us
                                   ? "is also that of " + earlier.who()
                                   : "meets that of " + earlier.who() + " (" + earlier.value_of("--slot") +
                                         "), whose cycle has another length";
      warnings.warn(later.place(*later.argument_of("--slot")), later.who(),
                    "its slot " + later.value_of("--slot") + " " + both + ": their packets collide");
    }
}

void check_follow(const sim::WorldConfig& world, const std::vector<Program>& programs, sim::Warnings& warnings) {
  for (const Program& program : programs) {
    const std::string behaviour = program.value_of("--behaviour");
    if (!program.known() || !behaviour.starts_with("follow:")) continue;
    const std::string other = behaviour.substr(7, behaviour.find(',') - 7);
    const sim::SourcePlace& place = program.place(*program.argument_of("--behaviour"));
    if (find_vehicle(world, other) == nullptr) {
      warnings.warn(place, program.who(), "it is to follow '" + other + "', and there is no such vehicle");
      continue;
    }
    const auto driver = std::find_if(programs.begin(), programs.end(),
                                     [&](const Program& each) { return each.known() && each.vehicle() == other; });
    if (driver != programs.end() && !driver->sends())
      warnings.warn(
          place, program.who(),
          "it is to follow '" + other + "', whose program sends nothing: it has neither --slot nor --random-s");
  }
}

void check_names(const std::vector<Program>& programs, sim::Warnings& warnings) {
  for (const Program& program : programs) {
    const std::string &client = program.config().client, vehicle = program.vehicle();
    if (program.known() && !client.empty() && !vehicle.empty() && client != vehicle)
      warnings.warn(program.place(*program.argument_of("--name")), program.who(),
                    "the run waits for client '" + client + "', and it joins as '" + vehicle + "'");
  }
}

void check_metrics(const sim::WorldConfig& world, const std::vector<Program>& programs, sim::Warnings& warnings) {
  if (programs.empty()) return;  // the loader looked at those
  std::set<std::string> spoken = sim::channels_of(world);
  for (const Program& program : programs) {
    const auto known = known_programs().find(program.file_name());
    if (known == known_programs().end() || program.vehicle().empty()) return;  // who knows what it publishes
    for (const std::string& channel : known->second) spoken.insert(program.vehicle() + "." + channel);
  }
  for (const sim::MetricConfig& metric : world.metrics) {
    const std::string& channel = metric.params->channel;
    if (channel.empty() || channel.starts_with("sim.") || spoken.contains(channel)) continue;
    const std::string meant = sim::closest_name(channel, {spoken.begin(), spoken.end()});
    warnings.warn(metric.place, "metric '" + metric.name + "'",
                  "no device and no program of this world publishes on '" + channel + "'" +
                      (meant.empty() ? "" : "; did you mean '" + meant + "'?"));
  }
}

}  // namespace

void warn_of_processes(const sim::LoadedWorld& loaded, sim::Warnings& warnings) {
  const std::vector<Program> programs = programs_of(loaded);
  check_slots(loaded.config, programs, warnings);
  check_follow(loaded.config, programs, warnings);
  check_names(programs, warnings);
  check_metrics(loaded.config, programs, warnings);
}

void warn_of_missing_programs(const sim::LoadedWorld& loaded, sim::Warnings& warnings) {
  for (const Program& program : programs_of(loaded))
    if (!can_be_started(program.path()))
      warnings.warn(program.place(), program.who(),
                    program.path().find('/') == std::string::npos
                        ? "there is no program '" + program.path() + "' beside shoal or in PATH"
                        : "there is no program '" + program.path() + "'");
}

}  // namespace tools
