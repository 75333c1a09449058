// SPDX-License-Identifier: BSD-3-Clause
#include "autonomy/cooperative/driver/nav_record.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <map>
#include <memory>
#include <stdexcept>

#include "autonomy/cooperative/driver/land_team.hpp"
#include "bridges/log/record_reader.hpp"
#include "shoal/message_codec.hpp"
#include "shoal/sim_info_t.hpp"
#include "sim/config/param_reader.hpp"

namespace navigation {

namespace {

using Decoder = std::function<NavRecord::Message(std::span<const std::byte>)>;

/// Channel of a device that navigation uses.
struct NavChannel {
  int vehicle = 0;
  Decoder decode;
};

template <class Message>
Decoder decoder_of() {
  return [](std::span<const std::byte> payload) -> NavRecord::Message {
    return shoal::decode<Message>(payload, shoal::Finite::any);
  };
}

std::map<std::string, NavChannel, std::less<>> channels_of(const NavTeam& team) {
  std::map<std::string, NavChannel, std::less<>> channels;
  for (std::size_t i = 0; i < team.vehicles.size(); ++i) {
    const NavVehicle& vehicle = team.vehicles[i];
    const auto add = [&](const std::optional<NavDevice>& device, Decoder decode) {
      if (device) channels[device->channel] = {static_cast<int>(i), std::move(decode)};
    };
    add(vehicle.dvl, decoder_of<shoal::dvl_t>());
    add(vehicle.ahrs, decoder_of<shoal::ins_t>());
    add(vehicle.compass, decoder_of<shoal::compass_t>());
    add(vehicle.pressure, decoder_of<shoal::pressure_t>());
    add(vehicle.gps, decoder_of<shoal::gps_data_t>());
    add(vehicle.usbl, decoder_of<shoal::usbl_t>());
    add(vehicle.modem, vehicle.land ? decoder_of<shoal::modem_received_t>() : decoder_of<shoal::acoustic_received_t>());
    if (vehicle.modem) channels[vehicle.modem_command] = {static_cast<int>(i), decoder_of<shoal::modem_send_t>()};
    if (!vehicle.land) continue;
    add(vehicle.land->odometry, decoder_of<shoal::odometry_t>());
    add(vehicle.land->swarm, decoder_of<shoal::swarm_position_t>());
  }
  return channels;
}

void begin(NavRecord& record, const shoal::sim_info_t& info) {
  record.world = info.world;
  record.epoch_utime = info.epoch_utime;
  const sim::WorldConfig world = world_of_text(info.resolved_config);
  record.team = std::make_shared<NavTeam>(is_on_land(world) ? land_team_of(world) : team_of(world));
  begin_truth(record, info.resolved_config);
  const auto arguments = nav_arguments_of(info.resolved_config);
  for (const NavVehicle& vehicle : record.team->vehicles) {
    const auto own = arguments.find(vehicle.name);
    record.arguments.push_back(own != arguments.end() ? own->second : NavArguments{});
  }
}

}  // namespace

NavRecord read_record(const std::string& path) {
  NavRecord record;
  const std::unique_ptr<bridges::RecordReader> reader = bridges::open_record(path);
  bridges::RecordEvent event;
  std::map<std::string, NavChannel, std::less<>> channels;
  while (reader->next(event)) {
    if (event.channel == "sim.info" && !record.team) {
      begin(record, bridges::read_run_info(event.payload));
      channels = channels_of(*record.team);
    }
    if (!record.team) continue;
    record.end_us = std::max(record.end_us, event.utime - record.epoch_utime);
    if (event.channel == "sim.state")
      add_truth(record, shoal::decode<shoal::sim_state_t>(event.payload, shoal::Finite::any));
    const auto channel = channels.find(event.channel);
    if (channel == channels.end()) continue;
    try {
      record.items.push_back(
          {event.utime - record.epoch_utime, channel->second.vehicle, channel->second.decode(event.payload)});
    } catch (const shoal::MessageError&) {
      continue;  // the live program does not handle it either
    }
    if (const auto* send = std::get_if<shoal::modem_send_t>(&record.items.back().message))
      record.frame_bytes = std::max(record.frame_bytes, send->data.size());
  }
  record.problems = reader->problems();
  if (!record.team) throw std::invalid_argument("'" + path + "' has no sim.info: it is not the record of a run");
  // A radio carries what it must, unlike sound.
  if (record.team->is_on_land()) record.frame_bytes = max_frame_bytes;
  return record;
}

void begin_truth(NavRecord& record, const std::string& resolved_world) {
  record.truth.resize(record.team->vehicles.size());
  std::vector<std::optional<std::int64_t>> until_us(record.truth.size());
  sim::Diagnostics diagnostics;
  const sim::ConfigNode world = sim::parse_config_text(resolved_world, "sim.info", diagnostics);
  diagnostics.throw_if_any();
  constexpr auto never = std::numeric_limits<std::int64_t>::max();
  const sim::ConfigNode* metrics = world.find("metrics");
  for (const sim::ConfigNode& item : metrics != nullptr ? metrics->items : std::vector<sim::ConfigNode>()) {
    std::string type, name;
    std::optional<double> until_s;
    sim::ParamReader in(item, "metrics", diagnostics);  // the run has checked it
    in.read("type", type, "");
    in.read("vehicle", name, "");
    in.read("until_s", until_s, sim::at_least(0), "");
    const auto vehicle = record.team->index_of(name);
    if (!vehicle || (type != "position_error" && type != "consistency")) continue;
    auto& until = until_us[static_cast<std::size_t>(*vehicle)];
    until = std::max(until.value_or(0), until_s ? static_cast<std::int64_t>(std::llround(1e6 * *until_s)) : never);
  }
  for (const auto& until : until_us) record.truth_until_us.push_back(until.value_or(never));
}

void add_truth(NavRecord& record, const shoal::sim_state_t& state) {
  const std::int64_t time_us = state.utime - record.epoch_utime;
  for (std::size_t i = 0; i < state.vehicle.size(); ++i) {
    const auto vehicle = record.team->index_of(state.vehicle[i]);
    if (!vehicle || time_us > record.truth_until_us[static_cast<std::size_t>(*vehicle)]) continue;
    const auto& p = state.position_m[i];
    record.truth[static_cast<std::size_t>(*vehicle)].push_back({time_us, Eigen::Vector3d(p[0], p[1], p[2])});
  }
}

std::optional<Eigen::Vector3d> true_position(const std::vector<NavRecord::Truth>& truth, std::int64_t time_us) {
  const auto after =
      std::upper_bound(truth.begin(), truth.end(), time_us,
                       [](std::int64_t time, const NavRecord::Truth& each) { return time < each.time_us; });
  if (after == truth.begin()) return std::nullopt;
  const auto before = std::prev(after);
  if (after == truth.end()) return before->time_us == time_us ? std::optional(before->p_W) : std::nullopt;
  const double share =
      static_cast<double>(time_us - before->time_us) / static_cast<double>(after->time_us - before->time_us);
  return before->p_W + share * (after->p_W - before->p_W);
}

}  // namespace navigation
