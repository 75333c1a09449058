// SPDX-License-Identifier: BSD-3-Clause
#include "experiment/run/branch_log.hpp"

#include <gtest/gtest.h>

#include <fstream>

#include "bridges/base/bus_error.hpp"
#include "tests/experiment/run_parts_fixture.hpp"
#include "tests/scratch_folder.hpp"

namespace {

TEST(BranchLog, ABranchHasAFileBesideThatOfTheRun) {
  test::PartsOfARun run;
  const experiment::BranchLog log(run.parts.buses, run.parts.journal, "logs/coop.lcm", false);
  EXPECT_EQ(log.file_of(2), "logs/coop.branch2.lcm");
}

TEST(BranchLog, RefusesToReplaceAFile) {
  const test_support::ScratchFolder folder;
  test::PartsOfARun run;
  experiment::BranchLog log(run.parts.buses, run.parts.journal, folder.file("coop.lcm"), false);
  EXPECT_NO_THROW(log.prepare(1, 0, true));
  std::ofstream(log.file_of(1)) << "of another run";
  EXPECT_THROW(log.prepare(1, 0, true), bridges::BusError);
  experiment::BranchLog other(run.parts.buses, run.parts.journal, folder.file("coop.lcm"), true);
  EXPECT_NO_THROW(other.prepare(1, 0, true));
}

TEST(BranchLog, ABranchGoesOnWithTheNumbersOfTheStepWhereItStarts) {
  test::PartsOfARun run;
  bridges::RunJournal& journal = run.parts.journal;
  experiment::BranchLog log(run.parts.buses, journal, "", false);
  log.mark(0, 0);
  const std::int64_t at_start = journal.sequence();
  journal.input("", "pilot.note", {});
  journal.after_step();
  log.mark(10, 0);
  ASSERT_GT(journal.sequence(), at_start) << "its inputs were published";
  log.prepare(1, 5, true);
  log.branch(1);
  EXPECT_EQ(journal.branch(), 1);
  EXPECT_EQ(journal.sequence(), at_start);
  // A start from elsewhere leaves a gap in the numbers.
  log.prepare(2, 100, false);
  log.branch(2);
  EXPECT_EQ(journal.sequence(), at_start + 1);
}

}  // namespace
