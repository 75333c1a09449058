// SPDX-License-Identifier: BSD-3-Clause
#include "sim/world_file/metric_registry.hpp"

#include <algorithm>
#include <stdexcept>

#include "sim/bus/bus.hpp"

namespace sim {

void MetricParams::read_known_name(ParamReader& in, const char* key, std::string& value, const char* kind,
                                   const char* meaning) {
  in.read_reference(key, value, kind, meaning);
  if (!in.describing() && in.has(key) && value.empty() && in.child(key)->kind != ConfigNode::Kind::list)
    in.error(key, "'" + std::string(key) + "' must not be empty");
}

void MetricParams::read_vehicle(ParamReader& in) {
  read_known_name(in, "vehicle", vehicle, "vehicle", "vehicle whose truth is used; where it is optional: unset: all");
}

void MetricParams::read_channel(ParamReader& in) {
  in.read("channel", channel,
          "channel of the estimate, shoal.pose_t or shoal.estimate_t; messages: whose messages are counted");
  if (in.has("channel") && (channel.empty() || channel.size() > Bus::max_channel_length))
    in.error("channel", "'channel' must have 1 to 63 characters, got " + std::to_string(channel.size()));
}

void MetricParams::read_from_s(ParamReader& in) {
  in.read("from_s", from_s, at_least(0), "start of the scoring, simulated time");
}

const FigureKind* MetricKind::find(const std::string& figure) const {
  const auto found =
      std::find_if(figures.begin(), figures.end(), [&](const FigureKind& kind) { return kind.name == figure; });
  return found == figures.end() ? nullptr : &*found;
}

std::vector<ParamInfo> MetricKind::keys() const {
  std::vector<ParamInfo> table;
  ParamReader in(table);
  make_params()->read(in);
  return table;
}

MetricRegistry& MetricRegistry::instance() {
  static MetricRegistry registry;
  return registry;
}

void MetricRegistry::add(MetricKind kind) {
  if (find(kind.word) != nullptr) throw std::logic_error("metric type '" + kind.word + "' exists twice");
  const auto at = std::lower_bound(kinds_.begin(), kinds_.end(), kind.word,
                                   [](const auto& other, const std::string& word) { return other->word < word; });
  kinds_.insert(at, std::make_unique<MetricKind>(std::move(kind)));
}

const MetricKind* MetricRegistry::find(const std::string& word) const {
  for (const auto& kind : kinds_)
    if (kind->word == word) return kind.get();
  return nullptr;
}

std::vector<const MetricKind*> MetricRegistry::all() const {
  std::vector<const MetricKind*> all;
  for (const auto& kind : kinds_) all.push_back(kind.get());
  return all;
}

std::vector<std::string> MetricRegistry::words() const {
  std::vector<std::string> words;
  for (const auto& kind : kinds_) words.push_back(kind->word);
  return words;
}

const MetricKind* MetricRegistry::of_figures(const std::set<std::string>& figures) const {
  for (const auto& kind : kinds_) {
    std::set<std::string> names;
    for (const FigureKind& figure : kind->figures) names.insert(figure.name);
    if (names == figures) return kind.get();
  }
  return nullptr;
}

}  // namespace sim
