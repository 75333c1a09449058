// SPDX-License-Identifier: BSD-3-Clause
#include "motion/record/take.hpp"

#include <gmock/gmock.h>

#include "motion/record/take_journal.hpp"

namespace {

using testing::ElementsAre;
using testing::HasSubstr;

const std::string head = "shoal recording 1\n{joints: [hip, knee], frame_s: 0.01}\n";

std::string error_of(const std::string& text) {
  try {
    motion::parse_take(text, "wave.journal");
  } catch (const sim::ConfigError& error) {
    return error.what();
  }
  return "";
}

TEST(Take, AFrameNamesOnlyWhatHasChanged) {
  const motion::Take take = motion::parse_take(head + "f 0=0.5 1=-1\nf\nf 1=2\n", "wave.journal");
  EXPECT_THAT(take.frames[0], ElementsAre(0.5, 0.5, 0.5));
  EXPECT_THAT(take.frames[1], ElementsAre(-1, -1, 2));
  EXPECT_EQ(take.settings.frame_s, 0.01);
}

TEST(Take, ALineThatWasCutIsIgnored) {
  const motion::Take take = motion::parse_take(head + "f 0=0 1=0\nf 0=1\nf 0=12.3", "wave.journal");
  EXPECT_THAT(take.frames[0], ElementsAre(0, 1));
}

TEST(Take, ToGoBackDropsLaterFramesAndChanges) {
  const motion::Take take = motion::parse_take(
      head + "f 0=0 1=0\nf 0=1\nc 0.01 {remove: a}\nf 0=2\nc 0.02 {remove: b}\nb 1\nf 0=5 1=0\n", "wave.journal");
  EXPECT_THAT(take.frames[0], ElementsAre(0, 1, 5));
  ASSERT_EQ(take.changes.size(), 1u);
  EXPECT_EQ(take.changes[0].at_s, 0.01);
}

TEST(Take, SaysTheLineOfAMistake) {
  EXPECT_THAT(error_of("hello\n"), HasSubstr("wave.journal:1: must start with the line 'shoal recording 1'"));
  EXPECT_THAT(error_of("shoal recording 1\n{joints: []}\n"), HasSubstr("'joints' must name a joint"));
  EXPECT_THAT(error_of(head + "f 0=0\n"), HasSubstr("wave.journal:3: the first frame needs a value of each joint"));
  EXPECT_THAT(error_of(head + "f 0=0 1=0\nf 2=1\n"), HasSubstr(":4: the number of a joint must be a whole number from "
                                                               "0 to 1, got '2'"));
  EXPECT_THAT(error_of(head + "f 0=0 1=nan\n"), HasSubstr(":3: a value must be a number"));
  EXPECT_THAT(error_of(head + "f 0=0 1=0\nb 1\n"), HasSubstr(":4: the frame must be a whole number from 0 to 0"));
  EXPECT_THAT(error_of(head + "f 0=0 1=0\nc x {}\n"), HasSubstr(":4: the time of a change must be a number"));
  EXPECT_THAT(error_of(head + "x\n"), HasSubstr(":3: must be a frame, a change or a return"));
  EXPECT_THAT(error_of(head), HasSubstr("has no frame"));
}

TEST(Take, WhatStandsBeforeABadLineIsKept) {
  const auto kept = [](const std::string& lines) {
    std::optional<motion::TakeDamage> damage;
    const motion::Take take = motion::parse_take(head + "f 0=0 1=0\nf 0=1\n" + lines, "wave.journal", &damage);
    for (const std::vector<double>& values : take.frames) EXPECT_EQ(values.size(), 2u) << lines;
    EXPECT_THAT(take.frames[0], ElementsAre(0, 1)) << lines;
    EXPECT_TRUE(take.changes.empty()) << lines;
    return damage.value_or(motion::TakeDamage{"none", 0});
  };
  EXPECT_EQ(kept("").error, "none");
  EXPECT_EQ(kept("f 0=12.").error, "none");  // cut
  const motion::TakeDamage bad = kept("f 0=5 1=x\nf 0=2\nf 0=3\n");
  EXPECT_EQ(bad.error, "wave.journal:5: a value must be a number from -1000000 to 1000000, got 'x'");
  EXPECT_EQ(bad.lines, 3u);
  for (const std::string line :
       {"f 0=nan", "f 0=inf", "f 0=1e7", "f 7=1", "f 0", "b 2", "b -1", "b 99999999999999999999", "c nan {remove: a}",
        "c 1e9 {remove: a}", "c 0.01 [", "hello", "", "\xff\xfe"})
    EXPECT_EQ(kept(line + "\nf 0=1\n").lines, 2u) << line;
}

TEST(Take, ItsFirstLinesMustBeGood) {
  std::optional<motion::TakeDamage> damage;
  for (const std::string& text : {std::string("mine\n"), head, head + "f 0=0\nf 0=0 1=0\n", head + "b 0\n"})
    EXPECT_THROW(motion::parse_take(text, "wave.journal", &damage), sim::ConfigError) << text;
  EXPECT_FALSE(damage);
  EXPECT_THAT(error_of(head + "b 0\n"), HasSubstr(":3: a return must come after a frame"));
  EXPECT_THAT(error_of("shoal recording 1\n{joints: [a, a]}\n"), HasSubstr("'joints' names joint 'a' twice"));
  EXPECT_THAT(error_of("shoal recording 1\n{joints: [\"a\\0\"]}\n"), HasSubstr("must have no control characters"));
}

TEST(Take, HasNoMoreValuesThanCanBeWritten) {
  std::string text = "shoal recording 1\n{joints: [";
  for (int i = 0; i < 200; ++i) text += "j" + std::to_string(i) + ", ";
  text += "]}\nf";
  for (int i = 0; i < 200; ++i) text += " " + std::to_string(i) + "=0";
  text += "\n";
  for (int i = 0; i < 100'001; ++i) text += "f\n";
  EXPECT_EQ(motion::max_take_frames(200), 100'000u);
  EXPECT_EQ(motion::max_take_frames(1), 1'000'000u);
  EXPECT_THAT(error_of(text), HasSubstr(":100003: must have at most 100000 frames"));
}

}  // namespace
