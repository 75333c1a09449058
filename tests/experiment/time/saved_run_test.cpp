// SPDX-License-Identifier: BSD-3-Clause
#include "experiment/time/saved_run.hpp"

#include <gtest/gtest.h>

namespace {

TEST(SavedRun, IsSplitIntoWhatWasJoined) {
  const experiment::SavedRun saved{sim::Bytes(5, std::byte{1}), {}, sim::Bytes(300, std::byte{3})};
  const experiment::SavedRun again = experiment::split(experiment::joined(saved));
  EXPECT_EQ(again.state, saved.state);
  EXPECT_EQ(again.scores, saved.scores);
  EXPECT_EQ(again.owners, saved.owners);
}

}  // namespace
