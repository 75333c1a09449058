// SPDX-License-Identifier: BSD-3-Clause
#include "bridges/log/run_journal.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "shoal/sim_hash_t.hpp"
#include "sim/world/world_state.hpp"
#include "tests/bytes_of.hpp"
#include "tests/devices/comms/port_fixture.hpp"

namespace {

using bridges::RunJournal;
using testing::ElementsAre;
using testing::IsEmpty;

using test_support::bytes_of;

/// A world with a ball, and a journal that publishes on its bus.
struct Journalled {
  explicit Journalled(const std::string& hash_every_steps = "10")
      : test("shoal: 1\nrun: {hash_every_steps: " + hash_every_steps +
             "}\nphysics: {step_s: 0.01}\nobjects: [{name: ball, position_m: [0, 0, 5], parts: [{shape: sphere, "
             "radius_m: 0.1, mass_kg: 1}]}]\n") {}

  void step() {
    test.world.step();
    journal.after_step();
  }
  /// `step:bus:channel:text` of every input that was published.
  std::vector<std::string> inputs() {
    std::vector<std::string> all;
    for (const shoal::sim_inputs_t& message : input_record.take_all()) {
      sequences.push_back(message.sequence);
      for (const shoal::sim_input_t& input : message.input)
        all.push_back(std::to_string(input.step) + ":" + input.bus + ":" + input.channel + ":" +
                      std::string(input.data.begin(), input.data.end()));
    }
    return all;
  }

  test::TestWorld test;
  bridges::JournalPorts ports;
  RunJournal journal{test.bus, test.world, ports};
  test::Listener<shoal::sim_inputs_t> input_record{test, "sim.inputs"};
  test::Listener<shoal::sim_hash_t> hashes{test, "sim.hash"};
  std::vector<std::int64_t> sequences;
};

TEST(RunJournal, InputsKnowTheStepThatBeginsWhenTheyAreHandedOver) {
  Journalled run;
  run.journal.input("", "a", bytes_of("early"));
  run.journal.start();
  run.journal.after_step();
  EXPECT_THAT(run.inputs(), ElementsAre("-1::a:early"));
  run.journal.input("", "a", bytes_of("one"));
  const std::vector<sim::MessageGate::Delivery> input_record{{"b", bytes_of("two")}, {"c", bytes_of("")}};
  run.journal.admitted("reef", input_record);
  EXPECT_THAT(run.inputs(), IsEmpty());
  run.step();
  EXPECT_THAT(run.inputs(), ElementsAre("0::a:one", "0:reef:b:two", "0:reef:c:"));
  run.step();
  EXPECT_THAT(run.inputs(), IsEmpty());
  run.journal.input("", "a", bytes_of("last"));
  run.journal.finish();
  EXPECT_THAT(run.inputs(), ElementsAre("2::a:last"));
  EXPECT_THAT(run.sequences, ElementsAre(0, 1, 2));
}

TEST(RunJournal, ManyInputsAreSpreadOverSeveralMessages) {
  Journalled run;
  run.journal.start();
  const sim::Bytes large(600'000);
  for (int i = 0; i < 3; ++i) run.journal.input("", "image", large);
  run.step();
  EXPECT_EQ(run.inputs().size(), 3u);
  EXPECT_THAT(run.sequences, ElementsAre(0, 1, 2));
}

TEST(RunJournal, HashesAreThoseOfTheWorldAtEveryNthStepAndAtTheEnd) {
  Journalled run("10");
  run.journal.start();
  run.journal.after_step();
  std::vector<std::int64_t> expected{static_cast<std::int64_t>(run.test.world.state().hash())};
  for (int i = 0; i < 25; ++i) {
    run.step();
    if (i == 9 || i == 19 || i == 24) expected.push_back(static_cast<std::int64_t>(run.test.world.state().hash()));
  }
  run.journal.finish();
  run.journal.finish();
  std::vector<std::int64_t> steps, hashes;
  for (const shoal::sim_hash_t& message : run.hashes.take_all()) {
    steps.push_back(message.step);
    hashes.push_back(message.hash);
    EXPECT_FALSE(message.part.empty());
  }
  EXPECT_THAT(steps, ElementsAre(0, 10, 20, 25));
  EXPECT_EQ(hashes, expected);
}

TEST(RunJournal, TheHashOfTheRunIsTheLastOfTheParts) {
  Journalled run("10");
  run.journal.start();
  std::int64_t expected = 0;
  for (int i = 0; i < 10; ++i) run.step();
  expected = static_cast<std::int64_t>(run.test.world.state().run_hash());
  const auto messages = run.hashes.take_all();
  ASSERT_EQ(messages.size(), 1u);
  ASSERT_EQ(messages[0].part.size(), messages[0].part_hash.size());
  EXPECT_EQ(messages[0].part.back(), "run hash");
  EXPECT_EQ(messages[0].part_hash.back(), expected);
}

TEST(RunJournal, NoneAreAskedFor) {
  Journalled run("never");
  run.journal.start();
  for (int i = 0; i < 20; ++i) run.step();
  run.journal.finish();
  EXPECT_THAT(run.hashes.take_all(), IsEmpty());
}

TEST(RunJournal, AListenerReceivesEveryInput) {
  Journalled run;
  std::vector<std::string> received;
  run.journal.set_listener([&](std::int64_t step, const RunJournal::Input& input) {
    received.push_back(std::to_string(step) + ":" + input.bus + ":" + input.channel);
  });
  run.journal.start();
  run.step();
  run.journal.input("reef", "a", bytes_of("x"));
  shoal::sim_control_request_t request{};
  request.command = "remove";
  run.journal.request(request);
  EXPECT_THAT(received, ElementsAre("1:reef:a", "1::sim.control"));
}

TEST(RunJournal, MutedItWritesNothingAndItsPortsReadWhatTheyReadBefore) {
  const auto end = std::make_shared<test::PortEnd>();
  Journalled run("1");
  const sim::PortOpener open =
      run.ports.wrap([&](sim::PortKind, const std::string&) { return std::make_unique<test::FakePort>(end); });
  const auto port = open(sim::PortKind::pty, "/nowhere/a");
  run.journal.start();
  end->to_world = "hello";
  EXPECT_EQ(port->read(), bytes_of("hello"));
  run.step();
  EXPECT_THAT(run.inputs(), ElementsAre("0:serial:/nowhere/a:hello"));
  run.hashes.take_all();

  run.journal.mute(true);
  run.journal.serial_inputs().add(1, "/nowhere/a", bytes_of("again"));
  end->to_world = "later";
  EXPECT_EQ(port->read(), bytes_of("again"));
  port->write(bytes_of("unreceived"));
  run.journal.input("", "a", bytes_of("x"));
  run.step();
  EXPECT_THAT(run.inputs(), IsEmpty());
  EXPECT_THAT(run.hashes.take_all(), IsEmpty());
  EXPECT_EQ(end->from_world, "");

  run.journal.mute(false);
  EXPECT_EQ(port->read(), bytes_of("later"));
  run.step();
  EXPECT_THAT(run.inputs(), ElementsAre("2:serial:/nowhere/a:later"));
}

TEST(RunJournal, ABranchCountsOnFromWhereItBegan) {
  Journalled run;
  run.journal.start();
  for (int i = 0; i < 3; ++i) {
    run.journal.input("", "a", bytes_of("x"));
    run.step();
  }
  run.inputs();
  run.journal.start_branch(1, 2);
  run.journal.input("", "a", bytes_of("x"));
  run.step();
  const auto messages = run.input_record.take_all();
  ASSERT_EQ(messages.size(), 1u);
  EXPECT_EQ(messages[0].sequence, 2);
  EXPECT_EQ(messages[0].branch, 1);
}

TEST(SerialInputs, IsReadAtItsStepOnly) {
  bridges::SerialInputs input_record;
  input_record.add(3, "a", bytes_of("three"));
  input_record.add(5, "a", bytes_of("five"));
  input_record.add(5, "a", bytes_of("more"));
  input_record.add(7, "a", bytes_of("seven"));
  EXPECT_EQ(input_record.read("b", 3), bytes_of(""));
  EXPECT_EQ(input_record.read("a", 2), bytes_of(""));
  EXPECT_EQ(input_record.read("a", 3), bytes_of("three"));
  EXPECT_EQ(input_record.read("a", 3), bytes_of(""));
  EXPECT_EQ(input_record.read("a", 5), bytes_of("five"));
  EXPECT_EQ(input_record.read("a", 5), bytes_of("more"));
  EXPECT_EQ(input_record.read("a", 8), bytes_of(""));
}

}  // namespace
