// SPDX-License-Identifier: BSD-3-Clause
#include "experiment/results/verdict_json.hpp"

namespace experiment {

nlohmann::ordered_json json_of(const RuleVerdict& verdict) {
  nlohmann::ordered_json json{{"rule", verdict.rule}, {"passed", verdict.passed}};
  json["left"] = verdict.left;  // NaN becomes null
  json["right"] = verdict.right;
  json["margin"] = verdict.margin;
  json["result"] = verdict.result;
  return json;
}

}  // namespace experiment
