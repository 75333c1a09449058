// SPDX-License-Identifier: BSD-3-Clause
#include "viewer/server/view_messages.hpp"

#include <charconv>
#include <cmath>

#include "bridges/base/json_text.hpp"
#include "shoal/message_codec.hpp"
#include "shoal/sim_asset_t.hpp"
#include "shoal/sim_bodies_t.hpp"
#include "shoal/sim_current_t.hpp"
#include "shoal/sim_event_t.hpp"
#include "shoal/sim_info_t.hpp"
#include "shoal/sim_scene_t.hpp"
#include "shoal/sim_scores_t.hpp"
#include "shoal/sim_sound_arrival_t.hpp"
#include "shoal/sim_sound_t.hpp"

namespace viewer {

namespace {

using Json = nlohmann::json;

Json number_or_null(double value) {
  return std::isfinite(value) ? Json(value) : Json(nullptr);
}

Json point(const double* p) {
  return {p[0], p[1], p[2]};
}

std::string sound_id(const std::string& source, std::int64_t sequence) {
  return source + "#" + std::to_string(sequence);
}

}  // namespace

std::string estimate_text(const std::string& vehicle, const VehicleEstimate& estimate, std::int64_t time_us) {
  const sim::Vector3d& p = estimate.position_m;
  const sim::Quaterniond& q = estimate.orientation;
  Json item{{"vehicle", vehicle}, {"time_us", time_us}, {"pose", {p.x(), p.y(), p.z(), q.w(), q.x(), q.y(), q.z()}}};
  if (estimate.covariance_m2) {
    Json& covariance = item["covariance_m2"] = Json::array();
    for (int row = 0; row < 3; ++row)
      for (int column = 0; column < 3; ++column)
        covariance.push_back(number_or_null((*estimate.covariance_m2)(row, column)));
  }
  return bridges::json_text(item);
}

std::string path_text(const std::string& channel, const VehiclePath& path, std::int64_t time_us) {
  Json points = Json::array();
  for (const VehiclePath::Point& point : path.points)
    points.push_back({point.x_m, point.y_m, number_or_null(point.depth_m)});
  return bridges::json_text({{"channel", channel},
                             {"vehicle", path_vehicle(channel)},
                             {"time_us", time_us},
                             {"points", std::move(points)},
                             {"loop", path.loop}});
}

void ViewMessages::take(std::string_view channel, std::span<const std::byte> payload) {
  try {
    if (channel.starts_with("sim.")) {
      take_named(channel, payload);
    } else {
      take_path(channel, payload);
      take_estimate(channel, payload);
    }
  } catch (const std::exception&) {
    // A message of any program may be malformed; the view only counts it.
    ++bad_messages_;
  }
}

bool ViewMessages::take_named(std::string_view channel, std::span<const std::byte> payload) {
  // Pages that connect later need these messages too.
  if (channel == "sim.info") {
    epoch_us_ = shoal::decode<shoal::sim_info_t>(payload, shoal::Finite::required).epoch_utime;
  } else if (channel == "sim.scene") {
    take_scene(payload);
  } else if (channel == "sim.asset") {
    take_asset(payload);
  } else if (channel == "sim.scores") {
    take_scores(payload);
  } else if (channel == "sim.current") {
    take_current(payload);
  } else if (channel == "sim.event") {
    take_event(payload);
  } else if (channel == "sim.bodies") {
    if (frames_ == Frames::from_bodies) take_bodies(payload);
  } else if (server_.clients() == 0) {
    return false;
  } else if (channel == "sim.sound") {
    take_sound(payload);
  } else if (channel == "sim.sound.arrival") {
    take_arrival(payload);
  } else {
    return false;
  }
  return true;
}

void ViewMessages::take_scene(std::span<const std::byte> payload) {
  const auto message = shoal::decode<shoal::sim_scene_t>(payload, shoal::Finite::required);
  if (message.scene == scene_) return;
  // A scene of another process: it must be JSON of the right kind.
  const Json json = Json::parse(message.scene);
  if (json.value("op", "") != "scene") throw std::runtime_error("sim.scene: not a scene");
  scene_ = message.scene;
  ++scene_number_;
  server_.retain("scene", scene_);
}

void ViewMessages::take_asset(std::span<const std::byte> payload) {
  const auto message = shoal::decode<shoal::sim_asset_t>(payload, shoal::Finite::required);
  std::uint64_t hash = 0;
  const char* const end = message.hash.data() + message.hash.size();
  const auto [at, error] = std::from_chars(message.hash.data(), end, hash, 16);
  if (error != std::errc{} || at != end) throw std::runtime_error("sim.asset: not a hash");
  server_.set_asset(hash, std::as_bytes(std::span(message.data)));
}

void ViewMessages::take_bodies(std::span<const std::byte> payload) {
  auto message = shoal::decode<shoal::sim_bodies_t>(payload, shoal::Finite::required);
  newest_us_ = time_us(message.utime);
  branch_ = message.branch;
  poses_are_new_ = true;
  poses_ = Poses{time_us(message.utime), message.branch, message.revision, std::move(message.position_m),
                 std::move(message.orientation)};
}

void ViewMessages::take_sound(std::span<const std::byte> payload) {
  const auto sound = shoal::decode<shoal::sim_sound_t>(payload, shoal::Finite::required);
  const Json item{{"id", sound_id(sound.source, sound.sequence)},
                  {"source", sound.source},
                  {"position_m", point(sound.position_m)},
                  {"time_us", time_us(sound.utime)},
                  {"duration_us", sound.duration_us},
                  {"sound_speed_mps", sound.sound_speed_mps},
                  {"source_level_dB", sound.source_level_dB},
                  {"centre_Hz", sound.centre_Hz},
                  {"bandwidth_Hz", sound.bandwidth_Hz},
                  {"bytes", sound.bytes},
                  {"to", sound.to},
                  {"kind", sound.kind}};
  server_.send_text(bridges::json_text({{"op", "sounds"}, {"items", Json::array({item})}}));
}

void ViewMessages::take_arrival(std::span<const std::byte> payload) {
  const auto arrival = shoal::decode<shoal::sim_sound_arrival_t>(payload, shoal::Finite::required);
  const bool received = arrival.outcome == "received";
  const Json item{{"id", sound_id(arrival.source, arrival.sequence)},
                  {"to", arrival.receiver},
                  {"position_m", point(arrival.position_m)},
                  {"time_us", time_us(arrival.utime)},
                  {"duration_us", arrival.duration_us},
                  {"travel_s", arrival.travel_time_s},
                  {"snr_dB", arrival.snr_dB},
                  {"outcome", received ? "none" : arrival.outcome},
                  {"delivered", received && arrival.addressed != 0}};
  server_.send_text(bridges::json_text({{"op", "receptions"}, {"items", Json::array({item})}}));
}

void ViewMessages::take_event(std::span<const std::byte> payload) {
  const auto event = shoal::decode<shoal::sim_event_t>(payload, shoal::Finite::required);
  std::string item = bridges::json_text(
      {{"time_us", time_us(event.utime)}, {"kind", event.kind}, {"who", event.who}, {"text", event.text}});
  if (server_.clients() > 0) server_.send_text("{\"op\":\"events\",\"items\":[" + item + "]}");
  earlier_.add(std::move(item));
}

void ViewMessages::take_current(std::span<const std::byte> payload) {
  const auto current = shoal::decode<shoal::sim_current_t>(payload, shoal::Finite::required);
  server_.retain("current", bridges::json_text({{"op", "current"},
                                                {"time_us", time_us(current.utime)},
                                                {"velocity_mps", point(current.velocity_mps)}}));
}

void ViewMessages::take_scores(std::span<const std::byte> payload) {
  const auto scores = shoal::decode<shoal::sim_scores_t>(payload, shoal::Finite::any);
  // Group the figures by metric.
  Json metrics = Json::array();
  for (std::size_t i = 0; i < scores.figure.size(); ++i) {
    const std::size_t dot = scores.figure[i].rfind('.');
    const std::string metric = scores.figure[i].substr(0, dot);
    const std::string figure = dot == std::string::npos ? "value" : scores.figure[i].substr(dot + 1);
    if (metrics.empty() || metrics.back()["name"] != metric)
      metrics.push_back({{"name", metric}, {"figures", Json::object()}});
    metrics.back()["figures"][figure] = number_or_null(scores.value[i]);
  }
  Json rules = Json::array();
  for (std::size_t i = 0; i < scores.rule.size(); ++i)
    rules.push_back({{"rule", scores.rule[i]},
                     {"holds", scores.holds[i] != 0},
                     {"value", number_or_null(scores.left[i])},
                     {"bound", number_or_null(scores.right[i])}});
  server_.retain("scores", bridges::json_text({{"op", "scores"},
                                               {"time_us", time_us(scores.utime)},
                                               {"metrics", std::move(metrics)},
                                               {"rules", std::move(rules)}}));
}

/// Kept even if no page is connected: paths are rare, and a page that connects later needs them.
void ViewMessages::take_path(std::string_view channel, std::span<const std::byte> payload) {
  auto path = read_path(payload);
  if (!path) return;
  constexpr std::size_t max_channels = 300, max_kept = 100;
  auto known = paths_.find(channel);
  if (known == paths_.end()) {
    if (paths_.size() >= max_channels) return;
    known = paths_.emplace(std::string(channel), std::deque<Path>()).first;
  }
  std::deque<Path>& all = known->second;
  const std::int64_t at_us = time_us(path->utime);
  while (!all.empty() && all.back().time_us > at_us) all.pop_back();  // the run was rewound
  if (!all.empty() && all.back().path.leads_along(*path)) return;
  all.push_back({at_us, std::move(*path)});
  if (all.size() > max_kept) all.pop_front();
  paths_changed_ = true;
}

void ViewMessages::rewind_paths(std::int64_t time_us) {
  for (auto& [channel, all] : paths_)
    for (; !all.empty() && all.back().time_us > time_us; paths_changed_ = true) all.pop_back();
}

void ViewMessages::send_paths() {
  if (!std::exchange(paths_changed_, false)) return;
  std::string items;
  for (const auto& [channel, all] : paths_)
    if (!all.empty()) items += (items.empty() ? "" : ",") + path_text(channel, all.back().path, all.back().time_us);
  server_.retain("paths", "{\"op\":\"paths\",\"items\":[" + items + "]}");
}

void ViewMessages::take_estimate(std::string_view channel, std::span<const std::byte> payload) {
  if (server_.clients() == 0) return;
  const auto estimate = read_estimate(channel, payload);
  if (!estimate) return;
  // The vehicle is the part of the channel before its last dot.  If a vehicle has several estimates, the page shows
  // that on VEHICLE.estimate, else the first.
  const std::string vehicle(channel.substr(0, channel.rfind('.')));
  constexpr std::size_t max_vehicles = 10'000;
  if (estimates_.size() >= max_vehicles && !estimates_.contains(vehicle)) return;
  Estimate& shown = estimates_[vehicle];
  if (shown.channel.empty() || channel == vehicle + ".estimate") shown.channel = channel;
  if (shown.channel != channel) return;
  shown.json = estimate_text(vehicle, *estimate, time_us(estimate->utime));
  shown.is_new = true;
}

void ViewMessages::flush() {
  // Estimates, the newest of each channel.
  std::string items;
  for (auto& [vehicle, estimate] : estimates_) {
    if (!std::exchange(estimate.is_new, false)) continue;
    items += (items.empty() ? "" : ",") + estimate.json;
  }
  send_paths();
  if (auto events = earlier_.text_for(server_.clients())) server_.retain("events", std::move(*events));
  if (!items.empty()) server_.send_text("{\"op\":\"estimates\",\"items\":[" + items + "]}");
  // The newest poses, to a new page again: a run that is paused makes no others.
  const int clients = server_.clients();
  if (clients > std::exchange(clients_, clients)) poses_are_new_ = true;
  if (!poses_ || !poses_are_new_ || clients == 0) return;
  poses_are_new_ = false;
  frame_.begin({poses_->time_us, poses_->branch, static_cast<std::uint32_t>(poses_->revision), speed_, paused_,
                std::exchange(jump_, false)});
  for (std::size_t i = 0; i < poses_->position_m.size(); ++i) {
    const std::vector<double>& p = poses_->position_m[i];
    const std::vector<float>& q = poses_->orientation[i];
    frame_.add({p[0], p[1], p[2]}, {q[0], q[1], q[2], q[3]});
  }
  server_.send_state(frame_.end());
}

}  // namespace viewer
