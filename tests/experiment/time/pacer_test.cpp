// SPDX-License-Identifier: BSD-3-Clause
#include "experiment/time/pacer.hpp"

#include <gtest/gtest.h>

namespace {

using std::chrono::microseconds;

TEST(Pacer, WaitsForTheWallClockAndNotAtAllAsFastAsPossible) {
  experiment::Pacer pacer;
  sim::RunControl control;
  EXPECT_EQ(pacer.until(sim::Time{10'000}, control).count(), 0) << "speed 0";
  control.set_speed(0.001);
  EXPECT_EQ(pacer.until(sim::Time{10'000}, control).count(), 0) << "the clock starts with this step";
  // At a thousandth of real time 10 ms take 10 s, less what has passed since.
  const microseconds wait = pacer.until(sim::Time{20'000}, control);
  EXPECT_LE(wait, std::chrono::seconds(10));
  EXPECT_GT(wait, std::chrono::seconds(1));
  control.set_speed(1e6);
  EXPECT_EQ(pacer.until(sim::Time{30'000}, control).count(), 0) << "another speed starts the clock again";
}

TEST(SetPace, CarriesOutWhatUsersAskForAndRefusesWhatIsNotPossible) {
  sim::RunControl control;
  EXPECT_TRUE(experiment::set_pace(control, "pause", 0));
  EXPECT_TRUE(control.paused);
  EXPECT_TRUE(experiment::set_pace(control, "step", 3));
  EXPECT_EQ(control.single_steps, 3);
  EXPECT_TRUE(experiment::set_pace(control, "resume", 0));
  EXPECT_FALSE(control.paused);
  EXPECT_EQ(control.single_steps, 0) << "what was left of the steps";
  EXPECT_TRUE(experiment::set_pace(control, "speed", 2.5));
  EXPECT_EQ(control.speed, 2.5);
  EXPECT_FALSE(experiment::set_pace(control, "rewind", 1));
  for (const double steps : {0.0, 1.5, 2e9})
    EXPECT_THROW(experiment::set_pace(control, "step", steps), std::runtime_error);
  for (const double speed : {-1.0, 1e-4, 1e7})
    EXPECT_THROW(experiment::set_pace(control, "speed", speed), std::runtime_error);
}

}  // namespace
