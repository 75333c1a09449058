// SPDX-License-Identifier: BSD-3-Clause
#include "sim/config/warnings.hpp"

#include <gmock/gmock.h>

#include "tests/sim/medium/log_capture.hpp"

namespace {

sim::SourcePlace at(int line) {
  return {sim::intern_file_name("w.yaml"), line, 3};
}

TEST(Warnings, SayWhereWhoAndWhat) {
  const test_support::LogCapture log;
  sim::Warnings warnings;
  warnings.warn(at(7), "vehicle 'a'", "it is odd");
  warnings.warn({}, "", "the water is too light");
  EXPECT_THAT(warnings.lines(), testing::ElementsAre("w.yaml:7:3: vehicle 'a': it is odd", "the water is too light"));
  EXPECT_EQ(log.text(), "w.yaml:7:3: vehicle 'a': it is odd\nthe water is too light\n");
}

TEST(Warnings, AreSaidOnceForAllVehiclesOfAFile) {
  const test_support::LogCapture log;
  sim::Warnings warnings;
  for (const char* who : {"vehicle 'a'", "vehicle 'b'", "vehicle 'a'"}) warnings.warn(at(7), who, "it is odd");
  warnings.warn(at(8), "vehicle 'b'", "it is odd");
  EXPECT_THAT(warnings.lines(),
              testing::ElementsAre("w.yaml:7:3: vehicle 'a': it is odd", "w.yaml:8:3: vehicle 'b': it is odd"));
}

TEST(Warnings, EndAfterAHundred) {
  const test_support::LogCapture log;
  sim::Warnings warnings;
  for (int line = 1; line <= 1000; ++line) warnings.warn(at(line), "", "it is odd");
  ASSERT_EQ(warnings.lines().size(), 101u);
  EXPECT_EQ(warnings.lines().back(), "more warnings are not shown");
}

TEST(Warnings, CommandNoTerminal) {
  const test_support::LogCapture log;
  sim::Warnings warnings;
  warnings.warn({}, "vehicle '\x1b[2J'", "it is odd");
  EXPECT_THAT(log.text(), testing::Not(testing::HasSubstr("\x1b")));
}

TEST(Warnings, NotesAreKeptOnceAndAreNoWarnings) {
  const test_support::LogCapture log;
  sim::Warnings warnings;
  for (const char* who : {"vehicle 'a'", "vehicle 'b'"}) warnings.note(at(7), who, "it holds");
  EXPECT_THAT(warnings.notes(), testing::ElementsAre("w.yaml:7:3: vehicle 'a': it holds"));
  EXPECT_TRUE(warnings.lines().empty());
  EXPECT_EQ(log.text(), "");
}

}  // namespace
