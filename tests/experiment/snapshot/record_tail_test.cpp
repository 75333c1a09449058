// SPDX-License-Identifier: BSD-3-Clause
#include "experiment/snapshot/record_tail.hpp"

#include <gmock/gmock.h>

#include <filesystem>
#include <fstream>

#include "tests/experiment/replay/replay_fixture.hpp"

namespace {

namespace fs = std::filesystem;

using experiment::RecordTail;
using experiment::TailOptions;
using test::forward;
using test::RecordedRun;
using test::ReplayTest;
using testing::HasSubstr;
using testing::IsEmpty;

/// A record of 3 s, whose rover is commanded ten times a second.
class RecordTailTest : public ReplayTest {
 protected:
  /// Snapshot files of these steps are left in a folder.
  void record_with_snapshots(const std::vector<std::int64_t>& steps) {
    fs::create_directory(snapshots());
    record(test::driven_world(), [&](RecordedRun& run, std::int64_t step) {
      if (std::count(steps.begin(), steps.end(), step) > 0)
        experiment::write_snapshot(snapshots() + "/" + std::to_string(step) + ".snapshot", run.snapshot());
    });
  }
  std::string snapshots() const { return folder.file("snapshots"); }
  /// Cuts the end off; from then on the fixture replays that.
  RecordTail cut(double last_s, std::uint64_t max_bytes = std::uint64_t{1} << 30) {
    const std::string whole = log;
    log = folder.file("tail.lcm");
    return experiment::write_record_tail(whole, log, {last_s, max_bytes, snapshots()});
  }
  std::string error_of(const std::string& file) {
    try {
      experiment::write_record_tail(file, folder.file("tail.lcm"), {});
    } catch (const std::runtime_error& error) {
      return error.what();
    }
    return "";
  }
};

TEST_F(RecordTailTest, BeginsWithTheLastSnapshotBeforeItAndRunsAgain) {
  record_with_snapshots({50, 150, 250});
  const RecordTail tail = cut(1);  // from 2 s on
  EXPECT_EQ(tail.snapshot, "a snapshot file of the run, of 1.500 s");
  EXPECT_TRUE(tail.replayable());
  EXPECT_DOUBLE_EQ(tail.end_s, 3);
  const experiment::ReplayOutcome outcome = again();
  EXPECT_EQ(outcome.exit_code(), 0) << outcome.to_text();
  EXPECT_EQ(outcome.begin_step, 150);
  EXPECT_EQ(outcome.steps, 150);
  EXPECT_EQ(outcome.missing_messages, 0u);
  EXPECT_THAT(outcome.notes, IsEmpty());
}

TEST_F(RecordTailTest, WithoutASnapshotHoldsTheWorldAndTheLastSeconds) {
  record(test::driven_world());
  const RecordTail tail = cut(1);
  EXPECT_FALSE(tail.replayable());
  bridges::EventLogReader in(log);
  const auto first = in.next();
  ASSERT_TRUE(first);
  EXPECT_EQ(first->channel, "sim.info");
  std::uint64_t events = 0;
  while (const auto event = in.next()) {
    ++events;
    EXPECT_GT(event->utime, tail.info.epoch_utime + 2'000'000);
    EXPECT_LE(event->utime, tail.info.epoch_utime + 3'000'000);
  }
  EXPECT_EQ(events, tail.events);
  EXPECT_THAT(in.problems(), IsEmpty());
  EXPECT_THAT(error(), HasSubstr("cannot be replayed"));
}

TEST_F(RecordTailTest, OfAShortRecordIsAllOfIt) {
  record(test::driven_world());
  const RecordTail tail = cut(10);
  EXPECT_TRUE(tail.whole);
  EXPECT_EQ(again().exit_code(), 0);
  EXPECT_EQ(again().steps, test::steps);
}

TEST_F(RecordTailTest, BeginsWithASnapshotOfTheRecordItself) {
  RecordedRun first(test::driven_world(), folder.file("first.lcm"));
  const auto drive = [](RecordedRun& run, std::int64_t step) {
    if (step % 10 == 0) run.send("r1.drive.cmd", forward(0.5));
  };
  first.run(100, [&](std::int64_t step) { drive(first, step); });
  const experiment::Snapshot begin = first.snapshot();
  RecordedRun second(test::driven_world(), log, &begin);
  second.run(300, [&](std::int64_t step) { drive(second, step); });
  const RecordTail tail = cut(2.5);  // from 1.5 s of 1 to 4 s
  EXPECT_EQ(tail.snapshot, "the snapshot in the record, of 1.000 s");
  const experiment::ReplayOutcome outcome = again();
  EXPECT_EQ(outcome.exit_code(), 0) << outcome.to_text();
  EXPECT_EQ(outcome.begin_step, 100);
}

TEST_F(RecordTailTest, IsBoundedInSize) {
  record_with_snapshots({150});
  const std::uintmax_t all = fs::file_size(log);
  const RecordTail tail = cut(1, all / 10);
  // The world comes on top.
  EXPECT_LT(fs::file_size(log), all / 10 + tail.info.resolved_config.size() + 4000);
  EXPECT_FALSE(tail.replayable());
  EXPECT_GT(tail.start_s, 2);
  EXPECT_GT(tail.events, 0u);
  EXPECT_NE(tail.short_of, "");
}

TEST_F(RecordTailTest, SnapshotsOfAnotherRunAreNotUsed) {
  record_with_snapshots({150});
  std::string other = test::driven_world();
  other.replace(other.find("seed: 3"), 7, "seed: 4");
  log = folder.file("other.lcm");
  record(other);
  EXPECT_EQ(cut(1).snapshot, "");
}

TEST_F(RecordTailTest, ReportsWhatIsNotARecord) {
  std::ofstream(folder.file("text")) << "no log at all";
  EXPECT_THAT(error_of(folder.file("text")), HasSubstr("is not a log of a run: it has no sim.info"));
  EXPECT_THAT(error_of(folder.file("nowhere.lcm")), HasSubstr("nowhere.lcm"));
  EXPECT_NE(error_of("/tmp"), "");
}

}  // namespace
