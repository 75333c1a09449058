// SPDX-License-Identifier: BSD-3-Clause
#include "sim/world_file/rule_list.hpp"

#include "sim/config/message_text.hpp"

namespace sim {

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
