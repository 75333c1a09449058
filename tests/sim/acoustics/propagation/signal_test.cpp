// SPDX-License-Identifier: BSD-3-Clause
#include "sim/acoustics/propagation/signal.hpp"

#include <gtest/gtest.h>

#include <set>
#include <string>

#include "sim/state/state_archive.hpp"

namespace {

using sim::SignalLoss;

TEST(Signal, EachCauseOfALossHasItsOwnWord) {
  std::set<std::string> words;
  for (int i = 0; i < sim::signal_losses; ++i) words.insert(sim::signal_loss_word(static_cast<SignalLoss>(i)));
  EXPECT_EQ(words.size(), static_cast<std::size_t>(sim::signal_losses));
  EXPECT_STREQ(sim::signal_loss_word(SignalLoss::half_duplex), "half_duplex");
  EXPECT_STREQ(sim::signal_loss_word(SignalLoss::shadow), "shadow");
}

TEST(Signal, AnUnknownCauseInASnapshotIsRefused) {
  const sim::StateArchive archive = sim::StateArchive::saver();
  EXPECT_NO_THROW(sim::check_loss(SignalLoss::shadow, archive));
  EXPECT_THROW(sim::check_loss(static_cast<SignalLoss>(sim::signal_losses), archive), sim::SnapshotError);
  EXPECT_THROW(sim::check_loss(static_cast<SignalLoss>(-1), archive), sim::SnapshotError);
}

}  // namespace
