// SPDX-License-Identifier: BSD-3-Clause
#include "motion/record/take_journal.hpp"

#include <gmock/gmock.h>

#include "motion/record/take.hpp"
#include "tests/scratch_folder.hpp"

namespace {

using testing::ElementsAre;

TEST(TakeJournal, HoldsEachFrameAtOnceAndExactly) {
  const test_support::ScratchFolder folder;
  const std::string path = folder.file("wave.yaml.journal");
  motion::TakeSettings settings;
  settings.joints = {"hip", "knee"};
  settings.world = "it's \"x\"";
  settings.set = {"run.seed=2"};
  settings.from_s = 0.1;
  {
    motion::TakeJournal journal(path, settings);
    const double exact = 1.0 / 3;
    journal.frame(std::vector<double>{exact, 0});
    // Another reader sees it before the journal is closed.
    motion::Take take = motion::read_take(path);
    EXPECT_EQ(take.frames[0][0], exact);
    EXPECT_EQ(take.settings.world, settings.world);
    EXPECT_EQ(take.settings.set, settings.set);
    EXPECT_EQ(take.settings.from_s, 0.1);
    EXPECT_TRUE(motion::is_recording(path));
    journal.frame(std::vector<double>{exact, 1e-300});
    journal.back(0);
    journal.frame(std::vector<double>{exact, 0});
    take = motion::read_take(path);
    EXPECT_THAT(take.frames[1], ElementsAre(0, 0));
    EXPECT_THROW(motion::TakeJournal(path, settings), std::runtime_error);
  }
  EXPECT_FALSE(motion::is_recording(path));
}

}  // namespace
