// SPDX-License-Identifier: BSD-3-Clause
#include "experiment/study/study_until.hpp"

#include <gmock/gmock.h>

#include "experiment/study/study_design.hpp"
#include "experiment/study/study_results.hpp"

namespace {

using testing::HasSubstr;

std::string problem_of(const std::string& until, const std::vector<std::string>& figures = {"passed", "e.rms_m"}) {
  try {
    experiment::parse_until(until, figures);
    return {};
  } catch (const std::invalid_argument& error) {
    return error.what();
  }
}

TEST(StudyUntil, IsABoundOfHalfTheInterval) {
  const experiment::StudyUntil relative = experiment::parse_until("ci < 5 %", {"passed", "e.rms_m"});
  EXPECT_EQ(relative.figure, "e.rms_m");
  EXPECT_TRUE(relative.relative);
  EXPECT_DOUBLE_EQ(relative.bound, 0.05);
  const experiment::StudyUntil absolute = experiment::parse_until("ci( passed )<0.1", {});
  EXPECT_EQ(absolute.figure, "passed");
  EXPECT_FALSE(absolute.relative);
  EXPECT_EQ(problem_of("mean < 5 %"), "'until' must have the form 'ci(METRIC.FIGURE) < 5 %', got 'mean < 5 %'");
  for (const char* wrong : {"ci", "ci <", "ci < x", "ci() < 1", "ci(e.rms_m < 1", "ci < 5 % 3", ""})
    EXPECT_THAT(problem_of(wrong), HasSubstr("must have the form")) << wrong;
  EXPECT_THAT(problem_of("ci < 0"), HasSubstr("must have a bound > 0"));
  EXPECT_THAT(problem_of("ci < 5 %", {"passed"}), HasSubstr("needs a figure"));
  EXPECT_THAT(problem_of("ci(passed) < 5 %"), HasSubstr("must have a bound without %"));
}

TEST(StudyUntil, IsCertainWhenTheIntervalIsNarrowEnough) {
  // Values 9 and 11: mean 10, std sqrt(2), half of the interval 12.7062 * sqrt(2) / sqrt(2) = 12.7062.
  EXPECT_FALSE(experiment::is_certain(experiment::parse_until("ci(e.rms_m) < 127 %", {}), {9, 11}));
  EXPECT_TRUE(experiment::is_certain(experiment::parse_until("ci(e.rms_m) < 128 %", {}), {9, 11}));
  EXPECT_FALSE(experiment::is_certain(experiment::parse_until("ci(e.rms_m) < 12.7", {}), {9, 11}));
  EXPECT_TRUE(experiment::is_certain(experiment::parse_until("ci(e.rms_m) < 12.71", {}), {9, 11}));
  EXPECT_FALSE(experiment::is_certain(experiment::parse_until("ci(e.rms_m) < 100", {}), {9}));
  EXPECT_FALSE(experiment::is_certain(experiment::parse_until("ci(e.rms_m) < 100", {}), {9, 11, std::nan("")}));
}

}  // namespace
