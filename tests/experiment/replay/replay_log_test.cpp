// SPDX-License-Identifier: BSD-3-Clause
#include "experiment/replay/replay_log.hpp"

#include <gmock/gmock.h>

#include <set>

#include "bridges/log/recording_bus.hpp"
#include "experiment/replay/replay_messages.hpp"
#include "experiment/snapshot/snapshot_pieces.hpp"
#include "shoal/message_codec.hpp"
#include "shoal/sim_hash_t.hpp"
#include "shoal/sim_inputs_t.hpp"
#include "shoal/sim_state_t.hpp"
#include "sim/bus/in_process_bus.hpp"
#include "tests/scratch_folder.hpp"

// What a log reports its run, from logs made by hand.

namespace {

using testing::ElementsAre;
using testing::IsEmpty;

constexpr std::int64_t step_us = 10'000;

/// A log of a run with steps of 0.01 s from epoch 0.
class HandMade {
 public:
  void info(std::int32_t branch, std::int64_t step, std::int64_t input_sequence) {
    shoal::sim_info_t info{};
    info.world = "w";
    info.step_us = step_us;
    info.utime = step * step_us;
    info.step = step;
    info.branch = branch;
    info.input_sequence = input_sequence;
    publish("sim.info", info, step);
  }
  void input_record(std::int32_t branch, std::int64_t step, std::int64_t sequence) {
    shoal::sim_inputs_t input_record{};
    input_record.utime = step * step_us;
    input_record.step = step;
    input_record.branch = branch;
    input_record.sequence = sequence;
    input_record.count = 1;
    input_record.input.resize(1);
    input_record.input[0].step = step - 1;
    input_record.input[0].channel = "a.cmd";
    publish("sim.inputs", input_record, step);
  }
  void state(std::int64_t step) {
    shoal::sim_state_t state{};
    state.utime = step * step_us;
    state.step = step;
    publish("sim.state", state, step);
  }
  void hash(std::int32_t branch, std::int64_t step, std::int64_t input_sequence) {
    shoal::sim_hash_t hash{};
    hash.utime = step * step_us;
    hash.step = step;
    hash.branch = branch;
    hash.input_sequence = input_sequence;
    publish("sim.hash", hash, step);
  }
  /// All pieces but those of the numbers in `lost`.
  void snapshot(std::int32_t branch, std::int64_t step, std::int64_t input_sequence,
                const std::set<std::int32_t>& lost = {}) {
    experiment::Snapshot snapshot;
    snapshot.step = step;
    snapshot.step_us = step_us;
    snapshot.state = sim::Bytes(150'000, std::byte{1});
    for (const auto& piece : experiment::in_pieces(snapshot, branch, input_sequence))
      if (!lost.contains(piece.piece)) publish("sim.snapshot", piece, step);
  }
  template <typename Message>
  void publish(const std::string& channel, const Message& message, std::int64_t step) {
    bus_.publish(channel, shoal::encode(message), sim::Time(step * step_us));
  }
  void raw(const std::string& channel, const sim::Bytes& payload, std::int64_t step) {
    bus_.publish(channel, payload, sim::Time(step * step_us));
  }
  experiment::ReplayLog read() {
    bus_.close();
    return experiment::read_replay_log(path_);
  }

 private:
  test_support::ScratchFolder folder_;
  std::string path_ = folder_.file("log.lcm");
  sim::InProcessBus network_;
  bridges::RecordingBus bus_{network_, path_, 0};
};

TEST(ReplayLog, WhatIsMissingOfAPartThatWasLeftIsNotMissed) {
  HandMade log;
  log.info(0, 0, 0);
  log.input_record(0, 5, 0);
  log.input_record(0, 30, 2);  // 1 is missing, and came after step 10: the branch there begins with 1
  log.info(1, 10, 1);
  log.input_record(1, 20, 1);
  const experiment::ReplayLog read = log.read();
  EXPECT_THAT(read.holes, IsEmpty());
  EXPECT_EQ(read.usable_step(), 20);
  EXPECT_EQ(read.inputs.size(), 2u);
}

TEST(ReplayLog, WhatIsMissingOfThePartThatIsKeptEndsTheProof) {
  HandMade log;
  log.info(0, 0, 0);
  log.input_record(0, 5, 0);
  log.input_record(0, 30, 3);  // 1 and 2 are missing: 1 came up to step 10
  log.info(1, 10, 2);
  log.input_record(1, 20, 2);
  const experiment::ReplayLog read = log.read();
  EXPECT_THAT(read.holes, ElementsAre("sim.inputs 1 (of a step from 5 to 30) is missing"));
  EXPECT_EQ(read.usable_step(), 5);
}

TEST(ReplayLog, InputsThatWereLostJustBeforeABranchEndTheProof) {
  HandMade log;
  log.info(0, 0, 0);
  log.input_record(0, 5, 0);
  log.info(1, 10, 2);
  log.input_record(1, 20, 2);
  const experiment::ReplayLog read = log.read();
  EXPECT_THAT(read.holes, ElementsAre("sim.inputs 1 (of a step from 5 to 10) is missing"));
  EXPECT_EQ(read.usable_step(), 5);
}

TEST(ReplayLog, BeginsWithTheSnapshotOfARun) {
  HandMade log;
  log.info(0, 100, 1);
  log.snapshot(0, 100, 1);
  log.state(100);
  log.input_record(0, 110, 1);
  log.hash(0, 120, 2);
  const experiment::ReplayLog read = log.read();
  EXPECT_EQ(read.begin_step(), 100);
  EXPECT_EQ(read.usable_step(), 120);
  EXPECT_EQ(read.inputs.size(), 1u);
  EXPECT_FALSE(read.is_rewound);
  EXPECT_THAT(read.holes, IsEmpty());
  EXPECT_THAT(read.problems, IsEmpty());
}

/// The first branch is not needed any more, also where it has holes.  `to`: earlier and later than where it was left.
TEST(ReplayLog, BeginsWithTheLastSnapshotOfALogOverARestore) {
  for (const std::int64_t to : {20, 300}) {
    HandMade log;
    log.info(0, 0, 0);
    log.state(0);
    log.input_record(0, 30, 2);
    log.state(40);
    log.info(1, to, 5);
    log.snapshot(1, to, 5);
    log.state(to);
    log.input_record(1, to + 10, 5);
    log.hash(1, to + 20, 6);
    const experiment::ReplayLog read = log.read();
    EXPECT_EQ(read.begin_step(), to);
    EXPECT_EQ(read.usable_step(), to + 20);
    EXPECT_EQ(read.inputs.size(), 1u);
    EXPECT_TRUE(read.is_rewound);
    EXPECT_THAT(read.holes, IsEmpty());
    EXPECT_EQ(read.bad_snapshot, "");
  }
}

TEST(ReplayLog, ASnapshotThatLacksAPieceEndsTheProof) {
  HandMade log;
  log.info(0, 0, 0);
  log.state(0);
  log.input_record(0, 30, 0);
  log.state(40);
  log.info(1, 300, 2);  // number 1 was skipped
  log.snapshot(1, 300, 2, {1});
  log.input_record(1, 310, 2);
  const experiment::ReplayLog read = log.read();
  EXPECT_EQ(read.begin_step(), 0);
  EXPECT_EQ(read.usable_step(), 30);
  EXPECT_EQ(read.bad_snapshot, "sim.snapshot: piece 2 of 3 of the snapshot of step 300 is missing");
}

TEST(ReplayLog, GoesBackBehindItsSnapshotOnlyWithAnother) {
  HandMade log;
  log.info(0, 100, 1);
  log.snapshot(0, 100, 1);
  log.state(120);
  log.info(1, 50, 1);
  log.input_record(1, 60, 1);
  const experiment::ReplayLog read = log.read();
  EXPECT_FALSE(read.snapshot);
  EXPECT_EQ(read.bad_snapshot, "sim.snapshot: the log is rewound to step 50, before its snapshot");
  EXPECT_EQ(read.usable_step(), 0);  // no one knows what came before
}

/// Inputs of a step come behind its messages.
TEST(ReplayLog, EndsWithTheLastStepOfWhichAllIsThere) {
  HandMade record;
  record.info(0, 0, 0);
  record.input_record(0, 5, 0);
  record.raw("r1.odometry", sim::Bytes(8), 40);
  record.state(41);
  const experiment::ReplayLog read = record.read();
  EXPECT_EQ(read.usable_step(), 40) << "in a record all of a step stands before anything of the next";
  EXPECT_EQ(read.cut, "the log ends in the middle of step 41: everything after step 40 is left out");
  // As lcm-logger stamps: the sim.inputs of any step behind the last one may have been lost.
  HandMade logged;
  logged.info(0, 0, 0);
  logged.raw("sim.state", shoal::encode([] {
               shoal::sim_state_t state{};
               state.utime = step_us;
               state.step = 1;
               return state;
             }()),
             2);
  logged.input_record(0, 5, 0);
  logged.state(40);
  logged.info(0, 60, 1);
  logged.state(61);
  const experiment::ReplayLog other = logged.read();
  EXPECT_FALSE(other.own_stamps);
  EXPECT_EQ(other.usable_step(), 59) << "the inputs of step 60 come behind its sim.info";
  EXPECT_EQ(other.cut, "the log ends in the middle of step 61: everything after step 59 is left out");
}

TEST(ReplayLog, ADamagedStampAtItsEndProvesNothing) {
  HandMade log;
  log.info(0, 0, 0);
  log.input_record(0, 5, 0);
  log.raw("r1.odometry", sim::Bytes(8), 1'000'000'000);
  EXPECT_EQ(log.read().usable_step(), 5);
}

TEST(ReplayMessages, ARecordIsNotReadAheadOfTheStep) {
  HandMade log;
  log.info(0, 0, 0);
  const sim::Bytes early(8, std::byte{1}), late(8, std::byte{2});
  for (std::int64_t step = 1; step <= 100; ++step) log.raw("often", late, step);
  log.raw("rare", late, 100);
  log.info(0, 101, 0);
  const experiment::ReplayLog read = log.read();
  experiment::ReplayMessages messages(read);
  messages.published("rare", early, 1);  // which is 100 steps before the log's
  ASSERT_NE(messages.first(), nullptr);
  EXPECT_EQ(messages.first()->what, "was published here and is not in the log");
  for (std::int64_t step = 1; step <= 100; ++step) messages.published("often", late, step);
  messages.published("rare", late, 100);
  EXPECT_EQ(messages.equal(), 101u);
  EXPECT_EQ(messages.different(), 1u);
}

}  // namespace
