// SPDX-License-Identifier: BSD-3-Clause
#include "bridges/lockstep/own_pause.hpp"

#include <gtest/gtest.h>

namespace {

TEST(OwnPause, EndsWithTheWait) {
  sim::RunControl control;
  bridges::OwnPause pause(control);
  EXPECT_FALSE(pause.end()) << "none has started";
  pause.start();
  EXPECT_TRUE(pause.holds());
  EXPECT_TRUE(control.paused);
  EXPECT_TRUE(pause.end());
  EXPECT_FALSE(control.paused);
  EXPECT_EQ(control.changes, 2) << "the pace starts again each time";
}

TEST(OwnPause, IsLeftToAUserWhoPausesMeanwhile) {
  sim::RunControl control;
  bridges::OwnPause pause(control);
  pause.start();
  control.set_paused(true);
  EXPECT_FALSE(pause.end());
  EXPECT_TRUE(control.paused);
}

TEST(OwnPause, DoesNotStartInAPauseOfAUser) {
  sim::RunControl control;
  control.set_paused(true);
  bridges::OwnPause pause(control);
  pause.start();
  EXPECT_FALSE(pause.holds());
  EXPECT_FALSE(pause.end());
  EXPECT_TRUE(control.paused);
}

}  // namespace
