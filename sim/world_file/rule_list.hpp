// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include "sim/config/param_reader.hpp"
#include "sim/world_file/rule_expression.hpp"

namespace sim {

/// Describes `pass:`, a list of rules.
void describe_rules(ParamReader& in, const char* meaning, std::vector<std::string> examples);

/// Reads the value of `pass:`.
std::vector<RuleExpression> read_rule_list(const ConfigNode& list, const RuleNames& names, Diagnostics& diagnostics);

}  // namespace sim
