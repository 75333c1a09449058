// SPDX-License-Identifier: BSD-3-Clause
#include "experiment/results/verdict_json.hpp"

#include <gtest/gtest.h>

#include <limits>

#include "experiment/score/rule_verdict.hpp"

namespace {

TEST(VerdictJson, HasBothSidesOfTheRule) {
  experiment::RuleVerdict verdict;
  verdict.rule = "e.rms_m < 2";
  verdict.passed = true;
  verdict.left = 1.5;
  verdict.right = 2;
  verdict.margin = 0.5;
  verdict.result = "1.5 < 2";
  EXPECT_EQ(experiment::json_of(verdict).dump(),
            R"({"rule":"e.rms_m < 2","passed":true,"left":1.5,"right":2.0,"margin":0.5,"result":"1.5 < 2"})");
}

TEST(VerdictJson, WhatIsUnknownIsNull) {
  experiment::RuleVerdict verdict;
  verdict.left = std::numeric_limits<double>::quiet_NaN();
  EXPECT_NE(experiment::json_of(verdict).dump().find(R"("left":null)"), std::string::npos);
}

}  // namespace
