// SPDX-License-Identifier: BSD-3-Clause
#include "sim/world_file/metric_config.hpp"

#include <algorithm>
#include <set>

#include "sim/acoustics/signal.hpp"
#include "sim/bus/bus.hpp"
#include "sim/config/message_text.hpp"
#include "sim/device/device_registry.hpp"
#include "sim/script/action.hpp"
#include "sim/world_file/metric_kind.hpp"
#include "sim/world_file/metric_types.hpp"
#include "sim/world_file/world_config.hpp"

namespace sim {

namespace {

constexpr const char* position_error_kind = "position_error";

bool contains(const std::vector<std::string>& keys, const std::string& key) {
  return std::find(keys.begin(), keys.end(), key) != keys.end();
}

constexpr const char* rule_forms[] = {"above", "above_metric", "below", "below_metric", "equals"};

}  // namespace

const std::vector<std::string>& loss_causes() {
  static const std::vector<std::string> causes = [] {
    std::vector<std::string> words;
    for (int loss = 1; loss < signal_losses; ++loss)  // 0: none
      words.emplace_back(signal_loss_word(static_cast<SignalLoss>(loss)));
    return words;
  }();
  return causes;
}

namespace {

/// An empty reference names nothing, which is a mistake where the key is written.
void refuse_empty(ParamReader& in, const char* key, const std::string& value) {
  if (!in.describing() && in.has(key) && value.empty() && in.child(key)->kind != ConfigNode::Kind::list)
    in.error(key, "'" + std::string(key) + "' must not be empty");
}

}  // namespace

void MetricConfig::read(ParamReader& in) {
  if (in.node() != nullptr) place = in.node()->place;
  in.require("name");
  in.read_name("name", name, "name of the metric; gives NAME.FIGURE for each figure of its type, see docs/scores.md");
  std::vector<std::pair<std::string, MetricType>> types;
  for (const MetricKind& kind : metric_kinds()) types.emplace_back(kind.word, kind.type);
  in.read_choice("type", type, types, "what it looks at");
  if (!in.describing())
    for (const std::string& key : metric_kind(type).required) in.require(key.c_str());
  in.read_reference("vehicle", vehicle, "vehicle", "whose truth counts; where it is not needed: unset: all");
  in.read("channel", channel,
          "of the estimate, shoal.pose_t or shoal.estimate_t; messages: whose messages are counted");
  if (in.has("channel") && (channel.empty() || channel.size() > Bus::max_channel_length))
    in.error("channel", "'channel' must have 1 to 63 characters, got " + std::to_string(channel.size()));
  in.read("from_s", from_s, at_least(0), "what comes before this simulated time does not count");
  in.read("dimensions", dimensions, between(2, 3), "of the error; 2: horizontal");
  in.read("device", device, "delivery, bytes_per_metre: one modem of the vehicle; unset: all its modems");
  in.read_reference("metric", metric, position_error_kind, "bytes_per_metre: the error with messages");
  in.read_reference("against", against, position_error_kind, "bytes_per_metre: the error without messages");
  when = parse_condition(in, "when");
  in.read("position_m", position_m, any_place(), "mission_time: the vehicle's place to reach, instead of `when`");
  in.read("radius_m", radius_m, above(0), "mission_time: so near to `position_m`");
  in.read_reference("with", with, movable_kind, "collisions: with this one alone; unset: with all, but planes");
  refuse_empty(in, "vehicle", vehicle);
  refuse_empty(in, "metric", metric);
  refuse_empty(in, "against", against);
  refuse_empty(in, "with", with);
  if (!in.describing()) check_keys(in);
}

void MetricConfig::check_keys(ParamReader& in) const {
  const MetricKind& kind = metric_kind(type);
  std::vector<std::string> keys{"name", "type"};
  keys.insert(keys.end(), kind.required.begin(), kind.required.end());
  keys.insert(keys.end(), kind.optional.begin(), kind.optional.end());
  std::sort(keys.begin(), keys.end());
  for (const char* key : {"vehicle", "channel", "from_s", "dimensions", "device", "metric", "against", "when",
                          "position_m", "radius_m", "with"})
    if (in.has(key) && !contains(kind.required, key) && !contains(kind.optional, key))
      in.error(key,
               "'" + std::string(key) + "' does not belong to type '" + kind.word + "'; its keys: " + list_text(keys));
  if (contains(kind.optional, "device") && in.has("device") && vehicle.empty())
    in.error("device", "'device' needs 'vehicle'");
  if (type == MetricType::bytes_per_metre && !metric.empty() && metric == against)
    in.error("against", "'against' must be another metric than 'metric'");
  if (type != MetricType::mission_time) return;
  if (when.kind == Condition::Kind::fires) in.error("when", "a metric cannot wait for an event to fire");
  const bool all_of_place = in.has("vehicle") && in.has("position_m") && in.has("radius_m");
  const bool any_of_place = in.has("vehicle") || in.has("position_m") || in.has("radius_m");
  if (in.has("when") ? any_of_place : !all_of_place)
    in.error("needs either 'when', or 'vehicle', 'position_m' and 'radius_m'");
}

std::vector<std::string> metric_type_words() {
  std::vector<std::string> words;
  for (const MetricKind& kind : metric_kinds()) words.emplace_back(kind.word);
  return words;
}

std::vector<std::string> MetricConfig::figures() const {
  std::vector<std::string> names;
  for (const FigureKind& figure : metric_kind(type).figures) names.push_back(name + "." + figure.name);
  return names;
}

void PassRule::read(ParamReader& in) {
  in.require("metric");
  in.read_reference("metric", metric, "figure", "such as NAME.rms_m");
  in.read("below", below, any_number(), "the figure must be below this");
  in.read("above", above, any_number(), "the figure must be above this");
  in.read("equals", equals, any_number(), "the figure must be this, as a count can be");
  in.read_reference("below_metric", below_metric, "figure", "the figure must be below this other one times factor");
  in.read_reference("above_metric", above_metric, "figure", "the figure must be above this other one times factor");
  in.read("factor", factor, sim::above(0), "see below_metric and above_metric");
  if (in.describing()) return;
  refuse_empty(in, "metric", metric);
  refuse_empty(in, "below_metric", below_metric);
  refuse_empty(in, "above_metric", above_metric);
  const auto count = std::count_if(std::begin(rule_forms), std::end(rule_forms), [&](auto key) {
    return in.has(key) && in.child(key)->kind != ConfigNode::Kind::null;
  });
  if (count != 1) {
    const std::string forms = "'above', 'above_metric', 'below', 'below_metric' and 'equals'";
    in.error("needs one of " + forms + (count > 1 ? ", not several" : ""));
  }
  if (in.has("factor") && !in.has("below_metric") && !in.has("above_metric"))
    in.error("factor", "'factor' belongs to 'below_metric' and 'above_metric'");
}

void declare_position_errors(ParamReader& in) {
  const ConfigNode* metrics = in.describing() ? nullptr : in.child("metrics");
  if (metrics == nullptr) return;
  std::set<std::string> names;
  for (const ConfigNode& metric : metrics->items) {
    const ConfigNode* type = metric.find("type");
    const ConfigNode* name = metric.find("name");
    if (name != nullptr && (type == nullptr || type->scalar == position_error_kind)) names.insert(name->scalar);
  }
  for (const std::string& name : names) in.declare(position_error_kind, name);
}

void declare_figures(ParamReader& in, const std::vector<MetricConfig>& metrics) {
  std::set<std::string> names;  // a metric that is there twice has been reported
  for (const MetricConfig& metric : metrics)
    if (names.insert(metric.name).second)
      for (const std::string& figure : metric.figures()) in.declare("figure", figure);
}

namespace {

/// By what it takes: messages to send, or sentences of a host.
bool is_modem(const DeviceConfig& device) {
  const DeviceType* type = DeviceRegistry::instance().find(device.type);
  if (type == nullptr) return true;  // that is told elsewhere
  return type->command_messages == "shoal.modem_send_t" || type->command_messages == "shoal.nmea_sentence_t";
}

}  // namespace

void check_metrics(const WorldConfig& world, Diagnostics& diagnostics) {
  for (const MetricConfig& metric : world.metrics) {
    if (metric.device.empty()) continue;
    for (const VehicleInstance& vehicle : world.vehicles) {
      if (vehicle.name != metric.vehicle || !vehicle.config) continue;
      std::vector<std::string> names;
      const DeviceConfig* meant = nullptr;
      for (const DeviceConfig& device : vehicle.config->devices) {
        if (device.name == metric.device) meant = &device;
        if (is_modem(device)) names.push_back(device.name);
      }
      const std::string which = "device '" + shortened(printable(metric.device)) + "'";
      const std::string rest = names.empty() ? "; it has no modem" : "; its modems: " + list_text(names);
      if (meant == nullptr)
        diagnostics.error(metric.place, "metric '" + metric.name + "'",
                          "vehicle '" + metric.vehicle + "' has no " + which + rest);
      else if (!is_modem(*meant))
        diagnostics.error(
            metric.place, "metric '" + metric.name + "'",
            which + " of vehicle '" + metric.vehicle + "' is no modem but of type '" + meant->type + "'" + rest);
    }
  }
}

}  // namespace sim
