// SPDX-License-Identifier: BSD-3-Clause
#include "experiment/run/run_keys.hpp"

#include <gmock/gmock.h>

#include "tests/experiment/run/time_control_fixture.hpp"

namespace {

using testing::EndsWith;
using testing::HasSubstr;

class RunKeysTest : public testing::Test {
 protected:
  /// Returns the last line that the keys gave.
  std::string press(const std::string& typed) {
    for (const char key : typed) keys.press(key);
    return reported;
  }

  test::ControlledRun run;
  std::string reported, asked;
  experiment::RunKeys keys{run.time, run.control, [this](const std::string& text) { reported = text; },
                           [this](const std::string& text) { asked = text; }};
};

TEST_F(RunKeysTest, SpacePausesAndContinues) {
  EXPECT_EQ(press(" "), "step 0, 0 s, branch 0, paused; continues as fast as possible");
  EXPECT_TRUE(run.control.paused);
  EXPECT_EQ(press(" "), "step 0, 0 s, branch 0; goes as fast as possible");
  EXPECT_FALSE(run.control.paused);
}

TEST_F(RunKeysTest, StepsAddUpAndPause) {
  press("nN.");
  EXPECT_TRUE(run.control.paused);
  EXPECT_EQ(run.control.single_steps, 1 + 10 + 1);
}

TEST_F(RunKeysTest, TheSpeedIsDoubledAndHalvedWithinItsLimits) {
  EXPECT_THAT(press("+"), EndsWith("goes as fast as possible")) << "nothing is faster";
  EXPECT_THAT(press("-"), EndsWith("goes 32 x real time"));
  EXPECT_THAT(press("+"), EndsWith("goes 64 x real time"));
  EXPECT_THAT(press("1-"), EndsWith("goes 0.5 x real time"));
  press("1" + std::string(10, '-'));
  EXPECT_EQ(run.control.speed, 1e-3) << "not 2^-10";
  press("m");
  EXPECT_EQ(run.control.speed, 0);
}

TEST_F(RunKeysTest, AsksForATimeOrAnEventAndTakesCorrections) {
  press(
      "u0.7\x7f"
      "5");
  EXPECT_THAT(asked, EndsWith(": 0.5"));
  EXPECT_THAT(press("\n"), EndsWith("runs until 0.5 s"));
  EXPECT_EQ(run.control.until, sim::from_seconds(0.5));
  EXPECT_THAT(press("ubell\n"), HasSubstr("'bell'")) << "the world has no such event";
  EXPECT_EQ(press("u9\x1b"), "not");
  EXPECT_EQ(run.control.until, sim::from_seconds(0.5)) << "Esc changes nothing";
  press("q");
  EXPECT_TRUE(run.control.quit) << "keys have their effects again";
}

TEST_F(RunKeysTest, ARefusalIsReported) {
  EXPECT_THAT(press("r"), HasSubstr("already at the start of the run"));
}

}  // namespace
