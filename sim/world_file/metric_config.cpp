// SPDX-License-Identifier: BSD-3-Clause
#include "sim/world_file/metric_config.hpp"

#include <algorithm>
#include <set>

#include "sim/config/message_text.hpp"
#include "sim/config/param_info.hpp"
#include "sim/world_file/world_config.hpp"

namespace sim {
namespace {

/// Type of a metric without `type`, as before version 0.2.

/// Names in the rules of a world: figures of its metrics.
class WorldRuleNames final : public RuleNames {
 public:
  explicit WorldRuleNames(const std::vector<MetricConfig>& metrics) : metrics_(metrics) {}

  std::string function_problem(const std::string& function) const override {
    return "'" + shortened(function) + "(...)' has no meaning in a world: its rules name figures as they are";
  }
  std::optional<RuleProblem> name_problem(const std::string& /*function*/, const std::string& name) const override {
    return figure_problem(metrics_, name);
  }

 private:
  const std::vector<MetricConfig>& metrics_;
};

}  // namespace

void MetricConfig::read(ParamReader& in) {
  const MetricRegistry& registry = MetricRegistry::instance();
  if (in.node() != nullptr) place = in.node()->place;
  in.require("name");
  in.read_name("name", name,
               "name of the metric; gives NAME.FIGURE for each figure of its type, see docs/guides/scoring.md");
  if (!in.describing() && !in.has("type")) {
    in.error("missing key 'type'; types: " + list_text(registry.words()));
    // Further errors, of keys and of rules that name its figures, would obscure this one.
    for (const ConfigNode::Entry& entry : in.node()->entries) in.child(entry.key.c_str());
    return;
  }
  std::string type;
  in.require("type");
  in.read_one_of("type", type, registry.words(), "type of the metric");
  if (in.describing()) {
    std::vector<std::pair<std::string, std::vector<ParamInfo>>> types;
    for (const MetricKind* each : registry.all()) types.emplace_back(each->word, each->keys());
    for (ParamInfo& info : merged_keys(types)) in.describe(std::move(info));
    return;
  }
  // Read the keys of the type.
  kind = registry.find(type);
  if (kind == nullptr) {
    for (const ConfigNode::Entry& entry : in.node()->entries) in.child(entry.key.c_str());
    return;
  }
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

std::optional<RuleProblem> figure_problem(const std::vector<MetricConfig>& metrics, const std::string& name) {
  // Find the metric.
  const std::size_t dot = std::min(name.find('.'), name.size());
  const std::string metric_name = name.substr(0, dot);
  const auto metric =
      std::find_if(metrics.begin(), metrics.end(), [&](const MetricConfig& each) { return each.name == metric_name; });
  if (metric == metrics.end()) {
    std::vector<std::string> known;
    for (const MetricConfig& each : metrics) known.push_back(each.name);
    const std::string shown_name = "'" + shortened(metric_name) + "'";
    const std::string what = dot < name.size() ? "unknown metric " + shown_name
                                               : shown_name + " is neither a number nor a figure, METRIC.FIGURE";
    return RuleProblem{0, what + "; known metrics: " + list_text(known) + did_you_mean(metric_name, known)};
  }
  if (metric->kind == nullptr) return std::nullopt;  // its type is invalid, which has been reported
  // Find its figure.
  std::vector<std::string> figures;
  for (const FigureKind& figure : metric->kind->figures) figures.push_back(figure.name);
  if (dot == name.size())
    return RuleProblem{0, "'" + metric_name + "' is a metric; a rule names one of its figures, such as " + metric_name +
                              "." + figures.front() + "; figures: " + list_text(figures)};
  const std::string figure = name.substr(dot + 1);
  if (metric->kind->find(figure) != nullptr) return std::nullopt;
  return RuleProblem{dot + 1, "metric '" + metric_name + "' has no figure '" + shortened(figure) +
                                  "'; figures: " + list_text(figures) + did_you_mean(figure, figures)};
}

void read_rules(ParamReader& in, std::vector<RuleExpression>& rules, const std::vector<MetricConfig>& metrics) {
  if (in.describing())
    return describe_rules(in, "the run passes when every rule holds; else exit code 1; see docs/guides/scoring.md",
                          {"bumps.count == 0", "cooperative.rms_m < 0.4 * alone.rms_m"});
  if (const ConfigNode* list = in.child("pass"))
    rules = read_rule_list(*list, WorldRuleNames(metrics), in.diagnostics());
}

void declare_metrics(ParamReader& in) {
  const ConfigNode* metrics = in.describing() ? nullptr : in.child("metrics");
  if (metrics == nullptr) return;
  // Metrics may refer to each other in any order, so their names are known before they are read.
  std::set<std::pair<std::string, std::string>> names;
  for (const ConfigNode& metric : metrics->items) {
    const ConfigNode* type = metric.find("type");
    const ConfigNode* name = metric.find("name");
    if (name != nullptr && type != nullptr) names.emplace(type->scalar, name->scalar);
  }
  for (const auto& [type, name] : names)
    if (MetricRegistry::instance().find(type) != nullptr) in.declare(type.c_str(), name);
}

void check_metrics(const WorldConfig& world, Diagnostics& diagnostics) {
  for (const MetricConfig& metric : world.metrics)
    if (metric.params) metric.params->check(metric, world, diagnostics);
}

void describe_rules(ParamReader& in, const char* meaning, std::vector<std::string> examples) {
  ParamInfo info;
  info.key = "pass";
  info.type = type_text(ParamKind::texts);
  info.rule = "one comparison each";
  info.initial = "[]";
  info.meaning = meaning;
  info.kind = ParamKind::texts;
  info.may_be_null = true;
  info.pattern = R"(^[A-Za-z0-9_.+*/()\s-]+(<|<=|>|>=|==|!=)[A-Za-z0-9_.+*/()\s-]+$)";
  info.examples = std::move(examples);
  in.describe(std::move(info));
}

std::vector<RuleExpression> read_rule_list(const ConfigNode& list, const RuleNames& names, Diagnostics& diagnostics) {
  std::vector<RuleExpression> rules;
  if (list.kind != ConfigNode::Kind::list && list.kind != ConfigNode::Kind::null)
    diagnostics.error(list.place, "", "'pass' must be a list of rules, got " + shown(list));
  for (std::size_t i = 0; i < list.items.size(); ++i) {
    const ConfigNode& item = list.items[i];
    const std::string who = "rule " + std::to_string(i + 1);
    RuleProblem problem;
    if (item.kind != ConfigNode::Kind::scalar)
      diagnostics.error(item.place, who,
                        "a rule is text, a comparison such as 'METRIC.FIGURE < 5', got " + shown(item));
    else if (auto rule = RuleExpression::parse(item.scalar, names, problem))
      rules.push_back(std::move(*rule));
    else
      diagnostics.error(place_in(item, problem.at), who, problem.text);
  }
  return rules;
}

}  // namespace sim
