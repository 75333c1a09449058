// SPDX-License-Identifier: BSD-3-Clause
#include "experiment/terminal/terminal_parser.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

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

using experiment::KeySequences;

/// The keys that come of bytes which arrive at once.
std::string keys_of(const std::string& bytes) {
  KeySequences sequences;
  const KeySequences::Clock::time_point now{};
  std::string keys;
  for (const char byte : bytes) keys += sequences.next(byte, now);
  return keys + sequences.alone(now + KeySequences::timeout);
}

TEST(KeySequences, ArrowsAndFunctionKeysAreSwallowedWhole) {
  EXPECT_EQ(keys_of("a\033OR1"), "a1");          // F3
  EXPECT_EQ(keys_of("a\033[Ab"), "ab");          // up
  EXPECT_EQ(keys_of("a\033[15~b"), "ab");        // F5
  EXPECT_EQ(keys_of("a\033[1~b"), "ab");         // Home
  EXPECT_EQ(keys_of("a\033[1;5Rb"), "ab");       // Ctrl-F3
  EXPECT_EQ(keys_of("a\033[[Rb"), "ab");         // the Linux console's F-keys
  EXPECT_EQ(keys_of("a\033[A\033[Bnb"), "anb");  // two of them
}

TEST(KeySequences, EscapeAloneIsAKey) {
  EXPECT_EQ(keys_of("u99\033"), "u99\033");
  KeySequences sequences;
  const KeySequences::Clock::time_point now{};
  EXPECT_EQ(sequences.next('\033', now), "");
  EXPECT_EQ(sequences.alone(now), "");  // more may come
  EXPECT_EQ(sequences.alone(now + KeySequences::timeout), "\033");
  EXPECT_EQ(sequences.alone(now + KeySequences::timeout), "");
  EXPECT_EQ(sequences.next('O', now), "O");
  EXPECT_EQ(keys_of("\033?"), "\033?");  // one quickly after the other
  EXPECT_EQ(keys_of("\033\033OA"), "\033");
}

TEST(KeySequences, ASequenceThatIsBrokenOffDoesNotSwallowWhatFollows) {
  EXPECT_EQ(keys_of("\033[1\033[Ar"), "r");
  EXPECT_EQ(keys_of("\033[1\nr"), "r");
}

}  // namespace
