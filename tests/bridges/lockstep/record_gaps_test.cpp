// SPDX-License-Identifier: BSD-3-Clause
#include "bridges/lockstep/record_gaps.hpp"

#include <gmock/gmock.h>

namespace {

using testing::ElementsAre;

TEST(RecordGaps, SayWhatIsMissingByClientAndChannel) {
  bridges::RecordGaps gaps;
  gaps.add("pilot", "sim.note", "channels of the simulator");
  gaps.add("pilot", "sim.note", "channels of the simulator");
  gaps.add("crew", "chat", "they did not arrive");
  gaps.add("crew", "", "more than 1000 channels");
  EXPECT_THAT(gaps.phrases(),
              ElementsAre("messages of client 'crew' on channels that nothing reads (more than 1000 channels)",
                          "1 message of client 'crew' on 'chat' (they did not arrive)",
                          "2 messages of client 'pilot' on 'sim.note' (channels of the simulator)"));
}

TEST(RecordGaps, AreCountedBeyondTheLimitOnlyWhereOneIsKnown) {
  bridges::RecordGaps gaps;
  for (std::size_t i = 0; i < bridges::RecordGaps::max_noted; ++i) gaps.add("pilot", std::to_string(i), "lost");
  gaps.add("pilot", "one more", "lost");
  gaps.add("pilot", "0", "lost");
  EXPECT_EQ(gaps.phrases().size(), bridges::RecordGaps::max_noted);
  EXPECT_EQ(gaps.phrases().front(), "2 messages of client 'pilot' on '0' (lost)");
}

}  // namespace
