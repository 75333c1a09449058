// SPDX-License-Identifier: BSD-3-Clause
#include <gmock/gmock.h>

#include <filesystem>

#include "shoal/sim_snapshot_t.hpp"
#include "tests/experiment/replay/replay_fixture.hpp"

// A log of a run that began with a snapshot.

namespace {

using experiment::replay;
using experiment::ReplayOptions;
using experiment::ReplayOutcome;
using test::driven_world;
using test::forward;
using test::RecordedRun;
using test::ReplayTest;
using test::steps;
using testing::AllOf;
using testing::ElementsAre;
using testing::HasSubstr;

/// A run of 100 steps, in which a guest comes; a record that begins there.
class ReplayFromASnapshot : public ReplayTest {
 protected:
  static constexpr std::int64_t first_steps = 100;
  /// Steers too, so that nothing is equal by chance.
  static void drive(RecordedRun& run, std::int64_t step) {
    if (step % 10 == 0) run.send("r1.drive.cmd", forward(0.5 + 0.001 * static_cast<double>(step)));
    if (step == 40) run.request("spawn", "{name: guest, file: rover_small.yaml, position_m: [0, 3, 0]}");
    if (step == 150) run.send("guest.drive.cmd", forward(1));
    if (step == 160) run.request("remove", "guest");
  }
  ReplayFromASnapshot() {
    RecordedRun first(driven_world(padding()), folder.file("first.lcm"));
    first.run(first_steps, [&](std::int64_t step) { drive(first, step); });
    begin = first.snapshot();
    write();
  }
  /// The world in the snapshot takes several pieces.
  static std::string padding() {
    return "events: [{name: never, at: 1000, do: [{log: " + std::string(70'000, 'x') + "}]}]\n";
  }
  void write() {
    std::filesystem::remove(log);
    RecordedRun run(driven_world(padding()), log, &begin);
    run.run(steps, [&](std::int64_t step) { drive(run, step); });
  }
  /// The log without some of the pieces, or with one that was changed.
  void change_pieces(const std::function<bool(shoal::sim_snapshot_t&)>& keep) {
    const std::string whole = log;
    log = folder.file("changed.lcm");
    test::change_log(whole, log, [&](bridges::LogEvent& event) {
      if (event.channel != "sim.snapshot") return true;
      auto piece = shoal::decode<shoal::sim_snapshot_t>(event.payload, shoal::Finite::any);
      if (!keep(piece)) return false;
      event.payload = shoal::encode(piece);
      return true;
    });
  }

  experiment::Snapshot begin;
};

TEST_F(ReplayFromASnapshot, IsEqualFromThereOn) {
  const ReplayOutcome outcome = again();
  EXPECT_EQ(outcome.exit_code(), 0) << outcome.to_text();
  EXPECT_EQ(outcome.begin_step, first_steps);
  EXPECT_EQ(outcome.steps, steps);
  EXPECT_EQ(outcome.hashes, 7u);  // steps 100, 150, ... 400
  EXPECT_EQ(outcome.missing_messages, 0u);
  EXPECT_THAT(outcome.notes, ElementsAre("in the run: remove guest at 1.60 s by client 'pilot'"));
  EXPECT_THAT(outcome.to_text(),
              AllOf(HasSubstr("equal for 300 steps (from step 100; 7 hashes, "), HasSubstr("3.000 s in ")));
}

TEST_F(ReplayFromASnapshot, ADifferenceIsFound) {
  const ReplayOutcome outcome = again({"vehicles.r1.devices.odometry.noise.gaussian_std=0.5"});
  EXPECT_EQ(outcome.exit_code(), 1);
  EXPECT_THAT(outcome.to_text(), AllOf(HasSubstr("r1/odometry (r1.odometry): "), HasSubstr(" of 400:")));
}

TEST_F(ReplayFromASnapshot, APieceThatIsMissingIsTold) {
  change_pieces([](const shoal::sim_snapshot_t& piece) { return piece.piece != 0; });
  EXPECT_THAT(error(), HasSubstr("cannot be replayed: sim.snapshot: piece 1 of "));
}

TEST_F(ReplayFromASnapshot, WithoutItsSnapshotTheLogCannotBeRun) {
  change_pieces([](const shoal::sim_snapshot_t&) { return false; });
  EXPECT_THAT(error(), HasSubstr("cannot be replayed from the start: sim.inputs 0"));
}

TEST_F(ReplayFromASnapshot, PiecesThatComeTwiceDoNoHarm) {
  const std::string whole = log;
  log = folder.file("twice.lcm");
  bridges::EventLogReader reader(whole);
  bridges::RecordingBus out(std::make_unique<sim::InProcessBus>(), log, 0);
  while (const auto event = reader.next())
    for (int i = 0; i < (event->channel == "sim.snapshot" ? 2 : 1); ++i)
      out.publish(event->channel, event->payload, sim::Time(event->utime));
  out.close();
  EXPECT_EQ(again().exit_code(), 0);
}

TEST_F(ReplayFromASnapshot, ADamagedOneIsTold) {
  change_pieces([](shoal::sim_snapshot_t& piece) {
    piece.data[piece.data.size() / 2] ^= 1;
    return true;
  });
  EXPECT_THAT(error(), HasSubstr("cannot be replayed: sim.snapshot: is damaged or cut off: its checksum must be "));
}

TEST_F(ReplayFromASnapshot, OneOfAnotherWorldOrBuildIsTold) {
  begin.seed = 4;
  write();
  EXPECT_THAT(error(), HasSubstr("sim.snapshot: is of another world, seed, epoch or step than sim.info reports"));
  begin.seed = 3;
  begin.version = "0.0.1";
  write();
  EXPECT_THAT(error(), HasSubstr("sim.snapshot: was written by shoal 0.0.1, this is "));
}

TEST_F(ReplayFromASnapshot, ForgedPiecesArePassedOver) {
  change_pieces([](shoal::sim_snapshot_t& piece) {
    piece.pieces = 0;
    return true;
  });
  EXPECT_THAT(error(), HasSubstr("sim.inputs 0"));
}

TEST_F(ReplayFromASnapshot, UntilBeforeItsBeginIsRefused) {
  ReplayOptions options;
  options.log = log;
  options.until_s = 0.5;
  options.quiet = true;
  EXPECT_THROW(replay(options), std::runtime_error);
  options.until_s = 1.5;
  EXPECT_EQ(replay(options).steps, 50);
}

}  // namespace
