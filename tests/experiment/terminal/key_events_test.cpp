// SPDX-License-Identifier: BSD-3-Clause
#include "experiment/terminal/key_events.hpp"

#include <gmock/gmock.h>

#include <string>

#include "tests/experiment/terminal/key_events_fixture.hpp"

namespace {

using namespace key_events_fixture;

using testing::ElementsAre;

TEST(KeyEvents, NamesArrowsOfBothModesOfATerminal) {
  EXPECT_THAT(events_of("\x1b[A\x1bOD w\x1b[5~\x1b[1;5Cq\t\r\x7f\x04"),
              ElementsAre("up", "left", "space", "w", "^right", "q", "tab", "enter", "backspace", "^d"));
}

TEST(KeyEvents, KeysOfTheLinuxConsoleDoNotBecomeLetters) {
  EXPECT_THAT(events_of("a\x1b[[Ab"), ElementsAre("a", "b"));  // F1
}

TEST(KeyEvents, AReportOfTheKittyProtocolHasTheReleaseOfAKey) {
  EXPECT_THAT(events_of("\x1b[97;1:1u\x1b[97;1:3u\x1b[99;5u"), ElementsAre("a", "a-", "^c"));
  experiment::KeyEvents keys;
  for (const char byte : std::string("\x1b[?0u")) EXPECT_FALSE(keys.next(byte));
  EXPECT_TRUE(keys.has_reports());
}

}  // namespace
