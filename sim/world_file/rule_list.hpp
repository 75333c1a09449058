// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "sim/config/param_reader.hpp"
#include "sim/world_file/rule_expression.hpp"

namespace sim {

/// Describes `pass:`, a list of rules.
void describe_rules(ParamReader& in, const char* meaning, std::vector<std::string> examples);

/// Reads the value of `pass:`.  `new_form`: converts an entry that is a map, the form of rules in version 0.1, to text.
std::vector<RuleExpression> read_rule_list(const ConfigNode& list, const RuleNames& names,
                                           const std::function<std::optional<std::string>(const ConfigNode&)>& new_form,
                                           Diagnostics& diagnostics);

}  // namespace sim
