// SPDX-License-Identifier: BSD-3-Clause
#include "sim/world_file/rule_list.hpp"

#include "sim/config/message_text.hpp"

namespace sim {

namespace {

std::string no_text(const ConfigNode& entry, const std::optional<std::string>& new_form) {
  if (new_form) return "a rule is text; write '" + *new_form + "' ('shoal upgrade' rewrites it)";
  return "a rule is text, a comparison such as 'METRIC.FIGURE < 5', got " + shown(entry);
}

}  // namespace

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

std::vector<RuleExpression> read_rule_list(const ConfigNode& list, const RuleNames& names,
                                           const std::function<std::optional<std::string>(const ConfigNode&)>& new_form,
                                           Diagnostics& diagnostics) {
  std::vector<RuleExpression> rules;
  if (list.kind != ConfigNode::Kind::list && list.kind != ConfigNode::Kind::null)
    diagnostics.error(list.place, "", "'pass' must be a list of rules, got " + shown(list));
  for (std::size_t i = 0; i < list.items.size(); ++i) {
    const ConfigNode& item = list.items[i];
    const std::string who = "rule " + std::to_string(i + 1);
    RuleProblem problem;
    if (item.kind != ConfigNode::Kind::scalar)
      diagnostics.error(item.place, who, no_text(item, new_form(item)));
    else if (auto rule = RuleExpression::parse(item.scalar, names, problem))
      rules.push_back(std::move(*rule));
    else
      diagnostics.error(place_in(item, problem.at), who, problem.text);
  }
  return rules;
}

}  // namespace sim
