// SPDX-License-Identifier: BSD-3-Clause
#include "bridges/control/spawned_vehicles.hpp"

#include <spdlog/fmt/fmt.h>

#include <vector>

#include "bridges/log/run_journal.hpp"
#include "shoal/message_codec.hpp"
#include "sim/base/log.hpp"
#include "sim/config/message_text.hpp"
#include "sim/state/state_archive.hpp"
#include "sim/world/world_editor.hpp"
#include "sim/world_file/vehicle_loader.hpp"

namespace bridges {

namespace {

/// Returns one line: `rover7: lidar (shoal.planar_lidar_t on rover7.lidar, 10 Hz); drive (takes ... on
/// rover7.drive.cmd)`.
std::string in_words(const shoal::sim_vehicle_t& message) {
  std::string text = message.vehicle + ":";
  for (std::size_t i = 0; i < message.device.size(); ++i) {
    std::vector<std::string> traffic;
    if (!message.report_channel[i].empty())
      traffic.push_back(fmt::format("{} on {}, {}", message.report_type[i], message.report_channel[i],
                                    message.rate_hz[i] > 0 ? fmt::format("{} Hz", message.rate_hz[i]) : "every step"));
    if (!message.command_channel[i].empty())
      traffic.push_back(fmt::format("takes {} on {}", message.command_types[i], message.command_channel[i]));
    text += fmt::format("{} {} ({})", i > 0 ? ";" : "", message.device[i], fmt::join(traffic, "; "));
  }
  return text;
}

/// Reads a request.  The requester receives only the place of an error in a vehicle file; the log of the run has the
/// whole error.
sim::SpawnRequest read_request(const sim::WorldConfig& world, const std::string& text) {
  std::vector<std::string> hidden;
  try {
    return sim::read_spawn_request(world, text, &hidden);
  } catch (const sim::ConfigError&) {
    for (const std::string& line : hidden) sim::log_warn("{}", line);
    throw;
  }
}

/// Returns `FILE:LINE:COLUMN` of a line `FILE:LINE:COLUMN: TEXT`, by the last such place; empty: it has none.
std::string place_in_file(const std::string& line) {
  const auto skip_number = [&line](std::size_t colon) {  // backwards from a colon, to the colon before its number
    std::size_t at = colon;
    while (at > 0 && line[at - 1] >= '0' && line[at - 1] <= '9') --at;
    return at > 1 && at < colon && line[at - 1] == ':' ? at - 1 : std::string::npos;
  };
  for (std::size_t end = line.rfind(": "); end != std::string::npos && end > 0; end = line.rfind(": ", end - 1)) {
    const std::size_t column = skip_number(end);
    if (column != std::string::npos && skip_number(column) != std::string::npos) return line.substr(0, end);
  }
  return "";
}

/// Throws the error of the construction of a vehicle for the requester: with only the place of an error in a file.
[[noreturn]] void throw_without_files(const sim::ConfigError& error) {
  std::vector<std::string> lines;
  for (const std::string& line : error.lines()) {
    const std::string place = line.starts_with("spawn:") ? "" : place_in_file(line);
    if (!place.empty()) sim::log_warn("{}", line);
    lines.push_back(place.empty() ? line : place + ": is wrong; the file is not quoted");
  }
  throw sim::ConfigError(lines);
}

}  // namespace

shoal::sim_vehicle_t vehicle_message(const sim::Vehicle& vehicle) {
  shoal::sim_vehicle_t message{};
  message.vehicle = vehicle.name();
  message.count = static_cast<std::int32_t>(vehicle.devices().size());
  for (const sim::MountedDevice* device : vehicle.devices()) {
    const sim::DeviceType& type = *device->config().device_type;
    message.device.push_back(device->config().name);
    message.device_type.push_back(type.name);
    message.report_channel.push_back(type.reports() ? device->report_channel() : "");
    message.report_type.push_back(type.report_message);
    message.rate_hz.push_back(type.reports() ? device->config().rate_hz : 0);
    message.command_channel.push_back(type.takes_commands() ? device->command_channel() : "");
    message.command_types.push_back(type.command_messages);
  }
  return message;
}

SpawnedVehicles::SpawnedVehicles(sim::World& world, sim::Bus& bus, RunJournal* journal)
    : world_(world), bus_(bus), journal_(journal) {
  record_all();
}

void SpawnedVehicles::report(sim::Bus& bus, shoal::sim_vehicle_t& message, bool present) {
  message.utime = world_.epoch_us() + world_.now().count();
  message.present = present;
  const auto owner = owners_.find(message.vehicle);
  // The owner may be unknown after a rewind to a time before the spawn.
  if (owner != owners_.end() || present) message.client = owner == owners_.end() ? "" : owner->second.client;
  shoal::encode_into(message, buffer_);
  bus.publish("sim.vehicle", buffer_, world_.now());
}

void SpawnedVehicles::write_down(const std::string& client, const std::string& command, const std::string& text) {
  if (journal_ == nullptr) return;
  shoal::sim_control_request_t request{};
  request.utime = world_.epoch_us() + world_.now().count();
  request.id = 0;
  request.client = client;
  request.command = command;
  request.value = 0;
  request.text = text;
  journal_->request(request);
}

void SpawnedVehicles::report_changes() {
  if (generation_ == world_.generation()) return;
  generation_ = world_.generation();
  report_difference(known_, bus_);
}

void SpawnedVehicles::report_difference(Known& known, sim::Bus& bus) {
  for (auto reported = known.begin(); reported != known.end();) {
    if (world_.find_vehicle(reported->first) != nullptr) {
      ++reported;
      continue;
    }
    // Removals go first, so that a vehicle of the same name that was added since is reported as new.
    report(bus, reported->second, false);
    owners_.erase(reported->first);
    reported = known.erase(reported);
  }
  for (const auto& vehicle : world_.vehicles()) {
    const auto [reported, fresh] = known.try_emplace(vehicle->name());
    if (!fresh) continue;
    reported->second = vehicle_message(*vehicle);
    report(bus, reported->second, true);
  }
}

void SpawnedVehicles::report_to_other_timeline(sim::Bus& network) {
  if (!known_to_others_) return;
  report_difference(*known_to_others_, network);
  known_to_others_.reset();
}

void SpawnedVehicles::record_all() {
  known_.clear();
  for (const auto& vehicle : world_.vehicles()) known_.emplace(vehicle->name(), vehicle_message(*vehicle));
  generation_ = world_.generation();
}

std::string SpawnedVehicles::spawn(const std::string& client, const std::string& text) {
  // A request that is refused here changes nothing and is not recorded: with its file included, a replay of the journal
  // would allow more, and subscribers could read the file.
  const sim::SpawnRequest request = read_request(world_.config(), text);
  if (journal_ != nullptr) write_down(client, "spawn", sim::self_contained_spawn(world_.config(), text));
  try {
    return add(client, request);
  } catch (const sim::ConfigError& error) {
    throw_without_files(error);
  }
}

void SpawnedVehicles::report_again(sim::Bus& network, const std::string& line) {
  const auto known = known_.find(line.substr(0, line.find(':')));
  if (known == known_.end()) return;  // removed meanwhile
  report(network, known->second, true);
}

std::string SpawnedVehicles::spawn_again(const std::string& client, const std::string& text) {
  return add(client, sim::read_journalled_spawn(world_.config(), text));
}

std::string SpawnedVehicles::add(const std::string& client, const sim::SpawnRequest& request) {
  if (request.with_client && client.empty())
    throw std::runtime_error("a vehicle with 'with_client' needs a client name");
  const sim::Vehicle& vehicle = world_.editor().add_vehicle(request.vehicle);
  owners_[vehicle.name()] = {client, request.with_client};
  if (request.with_client) {
    Client& owner = clients_[client];
    owner.last_seen = Clock::now();
    // A client with several vehicles has one time-out, the longest that it asked for.
    owner.timeout = std::max(owner.timeout, std::chrono::duration<double>(request.alive_timeout_s));
  }
  sim::log_info("client '{}' spawned vehicle '{}' at {:.3f} s", sim::printable(sim::shortened(client)), vehicle.name(),
                sim::to_seconds(world_.now()));
  report_changes();
  return in_words(known_.at(vehicle.name()));
}

void SpawnedVehicles::remove(const std::string& client, const std::string& name) {
  write_down(client, "remove", name);
  const sim::Vehicle* vehicle = world_.find_vehicle(name);
  if (vehicle == nullptr) return world_.editor().remove_object(name);
  world_.editor().remove_vehicle(std::string(vehicle->name()));
  report_changes();
}

std::string SpawnedVehicles::describe(const std::string& client, const std::string& name) {
  write_down(client, "describe", name);
  const sim::Vehicle* vehicle = world_.find_vehicle(name);
  if (vehicle == nullptr) throw sim::WorldError("there is no vehicle '" + sim::shortened(sim::printable(name)) + "'");
  report_changes();
  shoal::sim_vehicle_t& message = known_.at(vehicle->name());
  report(bus_, message, true);
  return in_words(message);
}

void SpawnedVehicles::act(const std::string& client, const std::string& text) {
  write_down(client, "do", text);
  const sim::ConfigNode action = sim::parse_untrusted(text, "do");
  sim::Diagnostics diagnostics;
  sim::check_untrusted(action, "", diagnostics);
  diagnostics.throw_if_any();
  world_.editor().run_action(action);
  report_changes();
}

void SpawnedVehicles::client_alive(const std::string& client) {
  const auto known = clients_.find(client);
  if (known != clients_.end()) known->second.last_seen = Clock::now();
}

void SpawnedVehicles::remove_timed_out(const std::function<bool(const std::string& client)>& takes_part) {
  if (clients_.empty()) return;
  const Clock::time_point now = Clock::now();
  std::vector<std::string> silent;
  for (auto& [name, client] : clients_) {
    // Taking part in the lockstep is a sign of life.
    if (takes_part(name)) client.last_seen = now;
    if (now - client.last_seen > client.timeout) silent.push_back(name);
  }
  for (const std::string& name : silent) {
    sim::log_warn("client '{}' timed out: its vehicles are removed", sim::printable(sim::shortened(name)));
    remove_vehicles_of(name);
  }
}

void SpawnedVehicles::remove_vehicles_of(const std::string& client) {
  std::vector<std::string> going;
  for (const auto& [vehicle, owner] : owners_)
    if (owner.with_client && owner.client == client) going.push_back(vehicle);
  for (const std::string& vehicle : going) {
    try {
      if (world_.find_vehicle(vehicle) != nullptr) remove(client, vehicle);  // otherwise an event has removed it
    } catch (const std::runtime_error& error) {
      sim::log_warn("{}", error.what());
    }
    owners_.erase(vehicle);
  }
  clients_.erase(client);
}

void SpawnedVehicles::Client::visit_state(sim::StateArchive& archive) {
  archive(timeout);
  if (archive.restoring()) last_seen = Clock::now();
}

void SpawnedVehicles::Owner::visit_state(sim::StateArchive& archive) {
  archive(client, with_client);
}

void SpawnedVehicles::visit_state(sim::StateArchive& archive) {
  archive(owners_, clients_);
  if (!archive.restoring()) return;
  if (!known_to_others_) known_to_others_ = known_;
  record_all();
}

}  // namespace bridges
