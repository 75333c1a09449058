// SPDX-License-Identifier: BSD-3-Clause
#include "experiment/run/step_watch.hpp"

#include <gmock/gmock.h>

#include "tests/experiment/run_parts_fixture.hpp"

namespace {

std::optional<std::string> limit_of_a_step(const std::string& limits) {
  test::PartsOfARun run({}, limits);
  experiment::StepWatch watch(run.parts.world);
  watch.begin();
  run.step(1);
  watch.end();
  EXPECT_FALSE(watch.take_warning()) << "a crate alone is not slow";
  return watch.beyond_limit();
}

TEST(StepWatch, EndsARunWhoseStepTakesLongerThanTheWorldAllows) {
  // No step of a world takes less than a nanosecond, nor this one more than 1000 s.
  EXPECT_THAT(limit_of_a_step("limits: {step_cpu_s: 1e-9}\n").value_or("no limit"), testing::HasSubstr("step 1 took"));
  EXPECT_FALSE(limit_of_a_step("limits: {step_cpu_s: 1000}\n"));
  EXPECT_FALSE(limit_of_a_step("")) << "there is no limit by default";
}

}  // namespace
