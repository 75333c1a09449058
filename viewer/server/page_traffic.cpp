// SPDX-License-Identifier: BSD-3-Clause
#include "viewer/server/page_traffic.hpp"

#include <algorithm>
#include <utility>
#include <vector>

#include "bridges/base/json_text.hpp"
#include "shoal/message_schema.hpp"
#include "viewer/page_data/page_request.hpp"

namespace viewer {

namespace {

using Json = nlohmann::json;

constexpr std::chrono::seconds counts_interval{1};

/// Reads the vehicles of a scene: by the channels of their devices, and by their names.
std::map<std::string, std::string, std::less<>> vehicles_of(const std::string& scene) {
  std::map<std::string, std::string, std::less<>> vehicles;
  const Json json = Json::parse(scene, nullptr, false);
  if (!json.is_object()) return vehicles;
  try {
    for (const Json& vehicle : json.value("vehicles", Json::array())) {
      const std::string name = vehicle.value("name", "");
      vehicles[name] = name;
      for (const Json& device : vehicle.value("devices", Json::array()))
        for (const Json& channel : device.value("channels", Json::array())) vehicles[channel.get<std::string>()] = name;
    }
  } catch (const Json::exception&) {  // a scene of another process: what was read up to here
  }
  return vehicles;
}

}  // namespace

void refuse(bridges::WebServer& server, const bridges::ViewRequest& request, const std::string& text) {
  server.reply(request.client,
               bridges::json_text(
                   {{"op", "reply"}, {"id", Json::parse(request_id(request.text))}, {"ok", false}, {"text", text}}));
}

void PageTraffic::count(std::string_view channel, std::span<const std::byte> payload) {
  counts_.take(channel, payload);
  channels_changed_ = true;
}

void PageTraffic::take(std::string_view channel, std::span<const std::byte> payload, std::int64_t time_us) {
  if (keeps_past_) mark_before(time_us);
  count(channel, payload);
  feed_.take(channel, payload, time_us);
}

/// Marks the counts when the first message after a tenth of a second is about to be counted.
void PageTraffic::mark_before(std::int64_t time_us) {
  constexpr std::int64_t shortest_us = 100'000, us_per_channel = 1000;
  const auto channels = static_cast<std::int64_t>(counts_.channels().size());
  const std::int64_t interval_us = std::max(shortest_us, channels * us_per_channel / shortest_us * shortest_us);
  const auto period_of = [&](std::int64_t time) { return (time + interval_us - 1) / interval_us; };
  if (period_of(time_us) > period_of(newest_us_)) history_.mark(newest_us_, 0, counts_);
  newest_us_ = std::max(newest_us_, time_us);
}

void PageTraffic::rewind(std::int64_t time_us) {
  feed_.rewind(time_us);
  if (newest_us_ <= time_us) return;
  history_.rewind(time_us);
  set_counts(history_.last());
  newest_us_ = time_us;
}

bool PageTraffic::handle(const bridges::ViewRequest& request) {
  if (request.op == "left") {
    feed_.remove(request.client);
  } else if (request.op == "subscribe") {
    try {
      feed_.subscribe(request.client, parse_subscribe(request.text));
    } catch (const PageRequestError& error) {
      server_.reply(request.client, bridges::json_text({{"op", "error"}, {"text", error.what()}}));
    }
  } else if (request.op == "series") {
    refuse(server_, request, "series: only a log has the values of the past");
  } else {
    return false;
  }
  return true;
}

void PageTraffic::set_counts(TrafficCounts counts) {
  counts_ = std::move(counts);
  channels_changed_ = links_changed_ = true;
  next_counts_ = {};
}

void PageTraffic::flush(std::int64_t time_us, const std::string& scene, int number) {
  const int clients = server_.clients();
  // A page that has just opened needs the counts now.
  if (clients > std::exchange(clients_, clients)) channels_changed_ = links_changed_ = true, next_counts_ = {};
  if (clients == 0) return;
  feed_.flush();
  const Clock::time_point now = Clock::now();
  if (now < next_counts_) return;
  next_counts_ = now + counts_interval;
  if (std::exchange(scene_number_, number) != number) {
    vehicles_ = vehicles_of(scene);
    channels_changed_ = true;
  }
  if (counts_.link_changes() != links_sent_) links_changed_ = true;
  if (std::exchange(channels_changed_, false)) send_counts(time_us);
  if (std::exchange(links_changed_, false)) {
    send_links(time_us);
    send_modems(time_us);
  }
}

std::string PageTraffic::vehicle_of(const std::string& channel) const {
  auto vehicle = vehicles_.find(channel);
  if (vehicle == vehicles_.end()) vehicle = vehicles_.find(prefix_of(channel));
  return vehicle == vehicles_.end() ? "" : vehicle->second;
}

void PageTraffic::send_counts(std::int64_t time_us) {
  std::vector<const std::pair<const std::string, TrafficCounts::Channel>*> channels;
  for (const auto& channel : counts_.channels()) channels.push_back(&channel);
  // Sorted, so that rows of the table stay in their places.
  std::sort(channels.begin(), channels.end(), [](const auto* a, const auto* b) { return a->first < b->first; });
  Json items = Json::array();
  for (const auto* each : channels) {
    const auto& [name, channel] = *each;
    const shoal::MessageSchema* schema = shoal::embedded_types().find(channel.fingerprint);
    items.push_back({{"name", name},
                     {"type", schema == nullptr ? "" : schema->name},
                     {"vehicle", vehicle_of(name)},
                     {"count", channel.count},
                     {"bytes", channel.bytes}});
  }
  server_.retain("channels",
                 bridges::json_text({{"op", "channels"}, {"time_us", time_us}, {"items", std::move(items)}}));
}

void PageTraffic::send_links(std::int64_t time_us) {
  links_sent_ = counts_.link_changes();
  Json items = Json::array();
  for (const auto& [names, pair] : counts_.pairs()) {
    Json lost = Json::object();
    for (const auto& [outcome, number] : pair.lost) lost[outcome] = number;
    items.push_back({{"from", names.first},
                     {"to", names.second},
                     {"sent", counts_.sent(names)},
                     {"received", pair.received},
                     {"lost", std::move(lost)}});
  }
  server_.retain("links", bridges::json_text({{"op", "links"}, {"time_us", time_us}, {"items", std::move(items)}}));
}

void PageTraffic::send_modems(std::int64_t time_us) {
  Json items = Json::array();
  for (const auto& [name, sender] : counts_.senders())
    items.push_back(
        {{"name", name}, {"count", sender.count}, {"bytes", sender.bytes}, {"sending_us", sender.sending_us}});
  server_.retain("modems", bridges::json_text({{"op", "modems"}, {"time_us", time_us}, {"items", std::move(items)}}));
}

}  // namespace viewer
