// SPDX-License-Identifier: BSD-3-Clause
#include "experiment/score/map/published_map.hpp"

#include <spdlog/fmt/fmt.h>

#include <cmath>
#include <stdexcept>

#include "shoal/message_codec.hpp"
#include "shoal/occupancy_grid_t.hpp"
#include "shoal/sim_info_t.hpp"

namespace experiment {

PublishedMap decode_map(std::span<const std::byte> payload) {
  const auto message = shoal::decode<shoal::occupancy_grid_t>(payload, shoal::Finite::required);
  const std::int64_t cells = std::int64_t{message.width} * message.height;
  if (message.width < 1 || message.height < 1 || cells > max_map_cells || cells != message.ncells)
    throw shoal::MessageError(fmt::format("'ncells' must be width * height, above 0 and at most {}, got {} of {} x {}",
                                          max_map_cells, message.ncells, message.width, message.height));
  if (!(message.cell_m >= 0.001 && message.cell_m <= 1000))
    throw shoal::MessageError(fmt::format("'cell_m' must be from 0.001 to 1000 m, got {:g}", message.cell_m));
  for (const double origin_m : message.origin_m)
    if (std::abs(origin_m) > 1e7)
      throw shoal::MessageError(fmt::format("'origin_m' must be within 1e7 m, got {:g}", origin_m));
  PublishedMap published;
  published.utime = message.utime;
  published.map.frame = {message.origin_m[0], message.origin_m[1], message.cell_m, message.width, message.height};
  published.map.cells.reserve(message.cells.size());
  // About the thresholds of ROS map_server, 0.65 and 0.196.
  for (const std::int8_t percent : message.cells)
    published.map.cells.push_back(percent >= 65                   ? Cell::occupied
                                  : percent >= 0 && percent <= 20 ? Cell::free
                                                                  : Cell::unknown);
  return published;
}

PublishedMaps::PublishedMaps(const std::string& log, std::string channel)
    : log_(log), channel_(std::move(channel)), reader_(log) {
  if (!read_next()) throw std::runtime_error(log_ + ": no event on channel '" + channel_ + "'; see shoal log info");
}

void PublishedMaps::learn_epoch(std::span<const std::byte> payload) {
  try {
    epoch_utime_ = shoal::decode<shoal::sim_info_t>(payload, shoal::Finite::any).epoch_utime;
    knows_epoch_ = true;
  } catch (const shoal::MessageError&) {
    // The channel belongs to another program that uses the name.
  }
}

bool PublishedMaps::read_next() {
  next_.reset();
  bridges::LogEventView event;
  while (reader_.next(event)) {
    if (event.channel == "sim.info" && !knows_epoch_) learn_epoch(event.payload);
    // Without sim.info, as in logs of other programs, time counts from the first event.
    if (!epoch_utime_) epoch_utime_ = event.utime;
    last_event_s_ = static_cast<double>(event.utime - *epoch_utime_) * 1e-6;
    if (event.channel != channel_) continue;
    next_s_ = last_event_s_;
    next_ = bridges::LogEvent{event.number, event.utime, std::string(event.channel),
                              sim::Bytes(event.payload.begin(), event.payload.end()), event.offset};
    return true;
  }
  return false;
}

std::optional<GridMap> PublishedMaps::at(double at_s) {
  while (next_ && next_s_ <= at_s + 1e-9) {
    last_ = std::move(next_->payload);
    read_next();
  }
  if (!last_)
    throw std::runtime_error(fmt::format("{}: the first map on channel '{}' is at {:.6g} s", log_, channel_, next_s_));
  // The last map is only known to be the last up to the last event of the log.
  if (!next_ && at_s > last_event_s_ + 1e-9) return std::nullopt;
  try {
    return decode_map(*last_).map;
  } catch (const shoal::MessageError& error) {
    throw std::runtime_error(fmt::format("{}: channel '{}': {}", log_, channel_, error.what()));
  }
}

}  // namespace experiment
