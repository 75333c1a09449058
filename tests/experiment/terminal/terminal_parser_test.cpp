// SPDX-License-Identifier: BSD-3-Clause
#include <gmock/gmock.h>

#include <string>

#include "experiment/terminal/key_events.hpp"
#include "tests/experiment/terminal/key_events_fixture.hpp"

namespace {

using namespace key_events_fixture;

using testing::ElementsAre;

TEST(KeyEvents, ALongSequenceIsDiscardedWhole) {
  EXPECT_THAT(events_of("\x1b[" + std::string(200, '1') + "Zx"), ElementsAre("x"));
}

TEST(KeyEvents, ASequenceThatIsBrokenOffDoesNotHideWhatFollows) {
  EXPECT_THAT(events_of("\x1b[1\x1b[Ar"), ElementsAre("up", "r"));
  EXPECT_THAT(events_of("\x1b\x1b[Br"), ElementsAre("down", "r"));
}

}  // namespace
