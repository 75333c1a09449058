// SPDX-License-Identifier: BSD-3-Clause
#include "experiment/run/run_inputs.hpp"

#include <gmock/gmock.h>

#include "tests/experiment/run_parts_fixture.hpp"

namespace {

const sim::Bytes note(3, std::byte{1});

class RunInputsTest : public testing::Test {
 protected:
  RunInputsTest() { run.parts.journal.start(); }
  /// A note from outside in the present step, then the step.
  void note_and_step() {
    run.parts.journal.input("", "pilot.note", note);
    run.step(1);
  }
  std::size_t waiting() {
    std::size_t count = 0;
    while (mailbox->take()) ++count;
    return count;
  }

  test::PartsOfARun run;
  experiment::RunInputs inputs{run.parts.buses, run.parts.journal, run.parts.service, run.parts.lockstep};
  std::unique_ptr<sim::Mailbox> mailbox = run.parts.buses.outer().open_mailbox("pilot.note");
};

TEST_F(RunInputsTest, ForgetsThoseBeforeAndAfterAStep) {
  inputs.keep(1'000'000, [] {});
  note_and_step();
  const std::size_t of_one = inputs.bytes();
  EXPECT_GT(of_one, note.size());
  note_and_step();
  note_and_step();
  EXPECT_EQ(inputs.bytes(), 3 * of_one);
  inputs.discard_before(1);
  EXPECT_EQ(inputs.bytes(), 2 * of_one);
  inputs.discard_from(2);
  EXPECT_EQ(inputs.bytes(), of_one);
  inputs.discard_from(-1);
  EXPECT_EQ(inputs.bytes(), 0u);
}

TEST_F(RunInputsTest, SaysWhenTheyAreTooMany) {
  int times = 0;
  inputs.keep(1, [&] { ++times; });
  note_and_step();
  EXPECT_EQ(times, 1);
}

TEST_F(RunInputsTest, AReplayDeliversThemInTheirStepsAndNothingElse) {
  inputs.keep(1'000'000, [] {});
  note_and_step();  // step 0
  run.step(1);
  note_and_step();  // step 2
  inputs.restart_replay(1);
  run.parts.buses.network().publish("pilot.note", note, sim::Time{0});  // now
  inputs.deliver(1);
  EXPECT_EQ(waiting(), 0u) << "neither that of step 0 nor that of now";
  inputs.deliver(2);
  EXPECT_EQ(waiting(), 1u);
  inputs.end_replay();
  run.parts.buses.network().publish("pilot.note", note, sim::Time{0});
  run.parts.buses.admit([](const std::string&, std::span<const sim::MessageGate::Delivery>) {});
  EXPECT_EQ(waiting(), 1u);
}

}  // namespace
