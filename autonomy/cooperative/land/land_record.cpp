// SPDX-License-Identifier: BSD-3-Clause
#include "autonomy/cooperative/land/land_record.hpp"

#include <algorithm>
#include <functional>
#include <map>
#include <memory>
#include <stdexcept>

#include "autonomy/cooperative/driver/nav_frame.hpp"
#include "bridges/log/record_reader.hpp"
#include "bridges/log/run_info.hpp"
#include "shoal/message_codec.hpp"
#include "shoal/sim_info_t.hpp"

namespace navigation {

namespace {

struct LandChannel {
  int vehicle = 0;
  std::function<LandRecord::Message(std::span<const std::byte>)> decode;
};
using LandChannels = std::map<std::string, LandChannel, std::less<>>;

LandChannels channels_on_land(const LandTeam& team) {
  LandChannels channels;
  for (std::size_t i = 0; i < team.vehicles.size(); ++i) {
    const LandVehicle& vehicle = team.vehicles[i];
    const auto add = [&]<class Message>(const std::string& channel, const Message&) {
      channels[channel] = {static_cast<int>(i), [](std::span<const std::byte> payload) -> LandRecord::Message {
                             return shoal::decode<Message>(payload, shoal::Finite::any);
                           }};
    };
    add(vehicle.odometry.channel, shoal::odometry_t{});
    if (vehicle.swarm) add(vehicle.swarm->channel, shoal::swarm_position_t{});
    if (vehicle.gps) add(vehicle.gps->channel, shoal::gps_data_t{});
    if (vehicle.modem) {
      add(vehicle.modem->channel, shoal::modem_received_t{});
      add(vehicle.modem_command, shoal::modem_send_t{});
    }
  }
  return channels;
}

void begin(const shoal::sim_info_t& info, const sim::WorldConfig& world, LandRecord& record) {
  record.land = land_team_of(world);
  auto names = std::make_shared<NavTeam>();
  for (const LandVehicle& vehicle : record.land.vehicles) {
    names->vehicles.emplace_back();
    names->vehicles.back().name = vehicle.name;
  }
  record.run.team = std::move(names);
  record.run.world = info.world;
  record.run.epoch_utime = info.epoch_utime;
  begin_truth(record.run, info.resolved_config);
}

}  // namespace

std::optional<LandRecord> read_land_record(const std::string& path) {
  LandRecord record;
  const std::unique_ptr<bridges::RecordReader> reader = bridges::open_record(path);
  bridges::RecordEvent event;
  LandChannels channels;
  while (reader->next(event)) {
    if (event.channel == "sim.info" && !record.run.team) {
      const auto info = bridges::read_run_info(event.payload);
      const sim::WorldConfig world = world_of_text(info.resolved_config);
      if (!is_on_land(world)) return std::nullopt;
      begin(info, world, record);
      channels = channels_on_land(record.land);
    }
    if (!record.run.team) continue;
    const std::int64_t time_us = event.utime - record.run.epoch_utime;
    record.run.end_us = std::max(record.run.end_us, time_us);
    if (event.channel == "sim.state")
      add_truth(record.run, shoal::decode<shoal::sim_state_t>(event.payload, shoal::Finite::any));
    const auto channel = channels.find(event.channel);
    if (channel == channels.end()) continue;
    try {
      record.items.push_back({time_us, channel->second.vehicle, channel->second.decode(event.payload)});
    } catch (const shoal::MessageError&) {
      continue;
    }
    record.has_radio = record.has_radio || std::holds_alternative<shoal::modem_send_t>(record.items.back().message);
  }
  record.run.problems = reader->problems();
  if (!record.run.team) throw std::invalid_argument("'" + path + "' has no sim.info: it is not the record of a run");
  // Radio carries what it must, unlike sound.
  record.run.frame_bytes = max_frame_bytes;
  return record;
}

}  // namespace navigation
