// SPDX-License-Identifier: BSD-3-Clause
#include "sim/world_file/metric_config.hpp"

#include <algorithm>
#include <set>

#include "sim/config/merged_keys.hpp"
#include "sim/world_file/world_config.hpp"

namespace sim {

namespace {

constexpr const char* rule_forms[] = {"above", "above_metric", "below", "below_metric", "equals"};

/// An empty reference names nothing, which is a mistake where the key is written.
void refuse_empty(ParamReader& in, const char* key, const std::string& value) {
  if (!in.describing() && in.has(key) && value.empty() && in.child(key)->kind != ConfigNode::Kind::list)
    in.error(key, "'" + std::string(key) + "' must not be empty");
}

}  // namespace

void MetricConfig::read(ParamReader& in) {
  const MetricRegistry& registry = MetricRegistry::instance();
  if (in.node() != nullptr) place = in.node()->place;
  in.require("name");
  in.read_name("name", name,
               "name of the metric; gives NAME.FIGURE for each figure of its type, see docs/guides/scoring.md");
  std::string type = registry.default_word();
  in.read_choice("type", type, registry.words(), "what it looks at");
  if (in.describing()) {
    std::vector<std::pair<std::string, std::vector<ParamInfo>>> types;
    for (const MetricKind* each : registry.all()) types.emplace_back(each->word, each->keys());
    for (ParamInfo& info : merged_keys(types)) in.describe(std::move(info));
    return;
  }
  kind = registry.find(type);
  if (kind == nullptr) return;
  const std::shared_ptr<MetricParams> own = kind->make_params();
  own->read(in);
  params = own;
}

std::vector<std::string> MetricConfig::figures() const {
  std::vector<std::string> names;
  if (kind == nullptr) return names;
  for (const FigureKind& figure : kind->figures) names.push_back(name + "." + figure.name);
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

void declare_metrics(ParamReader& in) {
  const ConfigNode* metrics = in.describing() ? nullptr : in.child("metrics");
  if (metrics == nullptr) return;
  const std::string default_word = MetricRegistry::instance().default_word();
  std::set<std::pair<std::string, std::string>> names;
  for (const ConfigNode& metric : metrics->items) {
    const ConfigNode* type = metric.find("type");
    const ConfigNode* name = metric.find("name");
    if (name != nullptr) names.emplace(type == nullptr ? default_word : type->scalar, name->scalar);
  }
  for (const auto& [type, name] : names)
    if (MetricRegistry::instance().find(type) != nullptr) in.declare(type.c_str(), name);
}

void declare_figures(ParamReader& in, const std::vector<MetricConfig>& metrics) {
  std::set<std::string> names;  // a metric that is there twice has been reported
  for (const MetricConfig& metric : metrics)
    if (names.insert(metric.name).second)
      for (const std::string& figure : metric.figures()) in.declare("figure", figure);
}

void check_metrics(const WorldConfig& world, Diagnostics& diagnostics) {
  for (const MetricConfig& metric : world.metrics)
    if (metric.params) metric.params->check(metric, world, diagnostics);
}

}  // namespace sim
