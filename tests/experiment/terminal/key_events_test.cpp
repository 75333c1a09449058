// SPDX-License-Identifier: BSD-3-Clause
#include "experiment/terminal/key_events.hpp"

#include <gmock/gmock.h>

#include <string>
#include <vector>

namespace {

using experiment::KeyEvent;
using testing::ElementsAre;

/// Events of bytes: names, with `^` before those with Ctrl and `-` after a release.
std::vector<std::string> events_of(const std::string& bytes) {
  experiment::KeyEvents keys;
  std::vector<std::string> events;
  for (const char byte : bytes)
    if (const auto event = keys.next(byte))
      events.push_back((event->ctrl ? "^" : "") + event->key + (event->action == KeyEvent::Action::release ? "-" : ""));
  return events;
}

TEST(KeyEvents, NamesArrowsOfBothModesOfATerminal) {
  EXPECT_THAT(events_of("\x1b[A\x1bOD w\x1b[5~\x1b[1;5Cq\t\r\x7f\x04"),
              ElementsAre("up", "left", "space", "w", "^right", "q", "tab", "enter", "backspace", "^d"));
}

TEST(KeyEvents, KeysOfTheLinuxConsoleDoNotBecomeLetters) {
  EXPECT_THAT(events_of("a\x1b[[Ab"), ElementsAre("a", "b"));  // F1
}

TEST(KeyEvents, ALongSequenceIsDiscardedWhole) {
  EXPECT_THAT(events_of("\x1b[" + std::string(200, '1') + "Zx"), ElementsAre("x"));
}

TEST(KeyEvents, ASequenceThatIsBrokenOffDoesNotHideWhatFollows) {
  EXPECT_THAT(events_of("\x1b[1\x1b[Ar"), ElementsAre("up", "r"));
  EXPECT_THAT(events_of("\x1b\x1b[Br"), ElementsAre("down", "r"));
}

TEST(KeyEvents, AReportOfTheKittyProtocolHasTheReleaseOfAKey) {
  EXPECT_THAT(events_of("\x1b[97;1:1u\x1b[97;1:3u\x1b[99;5u"), ElementsAre("a", "a-", "^c"));
  experiment::KeyEvents keys;
  for (const char byte : std::string("\x1b[?0u")) EXPECT_FALSE(keys.next(byte));
  EXPECT_TRUE(keys.has_reports());
}

}  // namespace
