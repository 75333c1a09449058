// SPDX-License-Identifier: BSD-3-Clause
#include "experiment/replay/replay.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <spdlog/fmt/fmt.h>

#include <filesystem>
#include <fstream>
#include <map>
#include <utility>
#include <vector>

#include "shoal/sim_inputs_t.hpp"
#include "shoal/twist_command_t.hpp"
#include "tests/experiment/replay/replay_fixture.hpp"
#include "tests/project_paths.hpp"
#include "tests/scratch_folder.hpp"

// A log of a run is enough to run it again, and to find where it differs.

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
using testing::HasSubstr;
using testing::IsEmpty;

TEST_F(ReplayTest, ARunWithAClientIsEqualWithoutIt) {
  record(driven_world());
  const ReplayOutcome outcome = again();
  EXPECT_EQ(outcome.exit_code(), 0);
  EXPECT_EQ(outcome.steps, steps);
  EXPECT_EQ(outcome.hashes, 7u);           // steps 0, 50, ... 300
  EXPECT_GT(outcome.messages, 60u + 30u);  // 20 Hz of odometry, 10 Hz of lidar and more
  EXPECT_EQ(outcome.missing_messages, 0u);
  EXPECT_THAT(outcome.notes, IsEmpty());
  EXPECT_THAT(outcome.to_text(), HasSubstr("equal for 300 steps (7 hashes, "));
}

TEST_F(ReplayTest, OfARecordWithinABudgetIsEqualInWhatTheRecordHas) {
  record(driven_world(), [](RecordedRun& run, std::int64_t step) {
    // As at its start.
    if (step == 0) run.recorder.set_budget({60'000, 3'000'000});
  });
  const ReplayOutcome outcome = again();
  EXPECT_EQ(outcome.exit_code(), 0) << outcome.to_text();
  EXPECT_EQ(outcome.steps, steps);
  EXPECT_GT(outcome.missing_messages, 0u);
  EXPECT_THAT(outcome.to_text(), HasSubstr("messages that were published here are not in the log"));
}

TEST_F(ReplayTest, TheInputsAreNeeded) {
  record(driven_world());
  const std::string whole = log;
  log = folder.file("without.lcm");
  test::copy_log(whole, log, [](const auto& event) { return event.channel == "sim.inputs"; });
  EXPECT_THAT(error(), HasSubstr("cannot be replayed from the start: sim.inputs 0"));
}

TEST_F(ReplayTest, InputsThatAreDiscardedAreNoDifference) {
  // As a rewind does, a second copy of a datagram, a gate that is full, or a run that ends before its next step.
  record(driven_world(), [](RecordedRun& run, std::int64_t step) {
    if (step != steps - 5) return;
    run.gate.collect();
    run.gate.waiting().clear();
    run.send("r1.drive.cmd", forward(0.123));
    run.gate.collect();
    run.gate.waiting().clear();
  });
  const ReplayOutcome outcome = again();
  EXPECT_EQ(outcome.exit_code(), 0) << outcome.to_text();
}

TEST_F(ReplayTest, RequestsThatChangeTheWorldAreObeyedAtTheSameSteps) {
  record(driven_world(), [](RecordedRun& run, std::int64_t step) {
    if (step == 40) run.request("spawn", "{name: guest, file: rover_small.yaml, position_m: [0, 3, 0]}");
    if (step == 60) run.request("do", "{fault: {device: r1/lidar, kind: silent}}");
    if (step == 60) run.request("spawn", "{name: guest, file: rover_small.yaml}");  // is refused
    if (step == 70) run.send("guest.drive.cmd", forward(1));
    if (step == 80) run.request("describe", "guest");
    if (step == 201) run.request("remove", "guest");
    if (step == 202) run.request("remove", "crate");
  });
  const ReplayOutcome outcome = again();
  EXPECT_EQ(outcome.exit_code(), 0) << outcome.to_text();
  EXPECT_EQ(outcome.steps, steps);
}

TEST_F(ReplayTest, VehicleFilesAreInTheLog) {
  RecordedRun run(driven_world(), log);
  run.request("spawn", "{name: guest, file: rover_small.yaml, position_m: [0, 3, 0]}");
  run.run(100);
  const std::filesystem::path before = std::filesystem::current_path();
  std::filesystem::current_path(folder.file(""));
  const ReplayOutcome outcome = again();
  std::filesystem::current_path(before);
  EXPECT_EQ(outcome.exit_code(), 0) << outcome.to_text();
}

TEST_F(ReplayTest, BytesOfSerialPortsAreReadAgain) {
  const std::string box =
      ", model: {shoal: 1, vehicle: box, bodies: [{name: b, position_m: [0, 0, 0.2], parts: [{shape: box, "
      "mass_kg: 5}]}], devices: [{name: modem, type: modem, network: n, range_m: 100, serial: {path: "
      "\"/nowhere/{vehicle}\"}}]}}\n";
  RecordedRun run(
      driven_world("  - {name: a, position_m: [0, 5, 0]" + box + "  - {name: b, position_m: [0, 9, 0]" + box), log);
  run.run(200, [&](std::int64_t step) {
    if (step == 20) run.ends["/nowhere/a"]->to_world = "hello\npart ";
    if (step == 50) run.ends["/nowhere/a"]->to_world = "of a line\n";
  });
  EXPECT_EQ(run.ends["/nowhere/b"]->from_world, "hello\npart of a line\n");
  const ReplayOutcome outcome = again();
  EXPECT_EQ(outcome.exit_code(), 0) << outcome.to_text();
  test::copy_log(log, folder.file("quiet.lcm"), [](const auto& event) { return event.channel == "sim.inputs"; });
  log = folder.file("quiet.lcm");
  EXPECT_THAT(error(), HasSubstr("sim.inputs 0"));
}

TEST_F(ReplayTest, APlantedDifferenceIsFoundWithStepVehicleAndQuantity) {
  record(driven_world());
  const ReplayOutcome seed = again({"run.seed=4"});
  EXPECT_EQ(seed.exit_code(), 1);
  ASSERT_TRUE(seed.first);
  EXPECT_LE(seed.first->step, 50);
  EXPECT_THAT(seed.to_text(), AllOf(HasSubstr("differs first at step "), HasSubstr("in the log and")));
  EXPECT_THAT(seed.world, testing::Contains(HasSubstr("seed: 4")));

  const ReplayOutcome mass = again({"objects.crate.parts.1.mass_kg=6"});
  EXPECT_EQ(mass.exit_code(), 1);
  EXPECT_THAT(mass.world, testing::Contains(HasSubstr("mass_kg: 6")));
}

TEST_F(ReplayTest, OneNoisierSensorIsFoundByItsName) {
  record(driven_world());
  const ReplayOutcome outcome = again({"vehicles.r1.devices.odometry.noise.gaussian_std=0.5"});
  EXPECT_EQ(outcome.exit_code(), 1);
  ASSERT_TRUE(outcome.first);
  EXPECT_THAT(outcome.to_text(), HasSubstr("r1/odometry (r1.odometry): "));
}

TEST_F(ReplayTest, AnotherWorldIsComparedByItsNamesAndByItsMotion) {
  record(driven_world());
  std::string other =
      driven_world("events:\n  - {name: kick, at: 2, do: [{move: {name: r1, position_m: [5, 5, 0.2]}}]}\n");
  const std::string objects = "objects:\n", file = "file: rover.yaml";
  other.insert(other.find(objects) + objects.size(),
               "  - {name: box, position_m: [9, 9, 0.5], parts: [{shape: box, mass_kg: 5}]}\n");
  other.replace(other.find(file), file.size(), "file: " + test_support::source_path("vehicles/rover.yaml"));
  ReplayOptions options;
  options.log = log;
  options.world = folder.file("other.yaml");
  options.quiet = true;
  std::ofstream(options.world) << other;
  const ReplayOutcome outcome = replay(options);
  EXPECT_EQ(outcome.exit_code(), 1);
  ASSERT_TRUE(outcome.first);
  EXPECT_EQ(outcome.first->step, 0) << "the state of another world";
  EXPECT_THAT(outcome.world, testing::Contains("only here: object 'box'"));
  EXPECT_THAT(outcome.world, testing::Contains("only here: event 'kick'"));
  EXPECT_THAT(outcome.world, testing::Not(testing::Contains(HasSubstr("seed")))) << "it is the same";
  // The event acts in the step that begins at 2 s; sim.state comes every 10 steps.
  EXPECT_THAT(outcome.motion, testing::StartsWith("step 210 (2.100 s), by sim.state: vehicle 'r1': position_m[0] is"));
  EXPECT_THAT(outcome.to_text(), testing::StartsWith("World (- in the log, + here):\n  only here: object 'box'\n"));
}

TEST_F(ReplayTest, AnInputThatIsMissingEndsTheProof) {
  record(driven_world());
  const std::string whole = log;
  log = folder.file("hole.lcm");
  test::copy_log(whole, log, [](const bridges::LogEvent& event) {
    if (event.channel != "sim.inputs") return false;
    const auto input_record = shoal::decode<shoal::sim_inputs_t>(event.payload, shoal::Finite::any);
    return input_record.sequence == 12 || input_record.sequence == 13;
  });
  const ReplayOutcome outcome = again();
  EXPECT_EQ(outcome.exit_code(), 4);
  EXPECT_FALSE(outcome.first) << outcome.to_text();
  // The client speaks every 10 steps, from step 0 on, and the record has its messages beside sim.inputs.
  EXPECT_EQ(outcome.steps, 120);
  EXPECT_THAT(outcome.to_text(),
              AllOf(HasSubstr("equal for 120 steps"), HasSubstr("sim.inputs 12 to 13 (of steps from 120 to 130)"),
                    HasSubstr("nothing after step 120 can be verified")));
}

TEST_F(ReplayTest, MessagesThatALoggerLostAreCountedOnly) {
  record(driven_world());
  const std::string whole = log;
  log = folder.file("lossy.lcm");
  int odometry = 0;
  test::copy_log(whole, log,
                 [&](const bridges::LogEvent& event) { return event.channel == "r1.odometry" && ++odometry % 5 == 2; });
  // lcm-logger stamps by the wall clock: in our own record nothing can be lost.
  EXPECT_EQ(again().exit_code(), 1);
  std::string bytes;
  {
    std::ifstream in(log, std::ios::binary);
    bytes.assign(std::istreambuf_iterator<char>(in), {});
  }
  bytes[4 + 8 + 7] ^= 1;  // the stamp of the first event
  std::ofstream(log, std::ios::binary) << bytes;
  const ReplayOutcome outcome = again();
  EXPECT_EQ(outcome.exit_code(), 0) << outcome.to_text();
  EXPECT_GT(outcome.missing_messages, 5u);
  EXPECT_THAT(outcome.to_text(), HasSubstr("messages that were published here are not in the log"));
}

TEST_F(ReplayTest, ALogThatIsCutOffIsEqualAsFarAsItGoes) {
  record(driven_world());
  std::filesystem::resize_file(log, std::filesystem::file_size(log) * 2 / 3);
  const ReplayOutcome outcome = again();
  EXPECT_EQ(outcome.exit_code(), 0) << outcome.to_text();
  EXPECT_LT(outcome.steps, steps);
  EXPECT_GT(outcome.steps, steps / 3);
}

TEST_F(ReplayTest, ARunThatAFaultEndedIsEqualUpToIt) {
  // Free fall: 5 m/s are reached after 0.51 s.
  RecordedRun run(
      "shoal: 1\nphysics: {max_speed_mps: 5, step_s: 0.01}\nvehicles:\n  - name: stone\n    position_m: [0, 0, 100]\n"
      "    model: {shoal: 1, bodies: [{name: body, parts: [{shape: sphere, mass_kg: 1}]}]}\n",
      log);
  EXPECT_THROW(run.run(steps), sim::PhysicsFault);
  run.journal.finish(false);
  run.recorder.close();
  const ReplayOutcome outcome = again();
  EXPECT_EQ(outcome.exit_code(), 0) << outcome.to_text();
  EXPECT_THAT(outcome.steps, AllOf(testing::Ge(40), testing::Le(51)));
}

TEST_F(ReplayTest, UntilEndsEarlier) {
  record(driven_world());
  ReplayOptions options;
  options.log = log;
  options.until_s = 1.2;
  options.quiet = true;
  const ReplayOutcome outcome = replay(options);
  EXPECT_EQ(outcome.steps, 120);
  EXPECT_EQ(outcome.exit_code(), 0);
}

TEST_F(ReplayTest, RefusesWhatIsNoLogOfARun) {
  EXPECT_THAT(error(), HasSubstr("No such file"));
  std::ofstream(log) << "this is text";
  EXPECT_THAT(error(), HasSubstr("is not an LCM log: it contains no readable event"));
  std::filesystem::remove(log);
  record(driven_world());
  const std::string whole = log;
  log = folder.file("other.lcm");
  test::copy_log(whole, log, [](const auto& event) { return event.channel.starts_with("sim."); });
  EXPECT_THAT(error(), HasSubstr("contains no sim.info"));
}

TEST_F(ReplayTest, RefusesTwoRunsInOneLog) {
  record(driven_world());
  std::ifstream in(log, std::ios::binary);
  const std::string bytes{std::istreambuf_iterator<char>(in), {}};
  std::ofstream(log, std::ios::binary | std::ios::app) << bytes;
  EXPECT_THAT(error(), HasSubstr("holds two runs"));
}

TEST_F(ReplayTest, HostileMessagesAreReportedAndSkipped) {
  record(driven_world());
  const std::string whole = log;
  log = folder.file("hostile.lcm");
  bridges::EventLogReader reader(whole);
  bridges::RecordingBus out(std::make_unique<sim::InProcessBus>(), log, 0);
  for (int i = 0; const auto event = reader.next(); ++i) {
    out.publish(event->channel, event->payload, sim::Time(event->utime));
    if (i == 20) out.publish("sim.inputs", shoal::encode(forward(1)), sim::Time(event->utime));
    if (i == 21) out.publish("sim.hash", sim::Bytes(3), sim::Time(event->utime));
  }
  out.close();
  const ReplayOutcome outcome = again();
  EXPECT_EQ(outcome.exit_code(), 0) << outcome.to_text();
  EXPECT_THAT(outcome.to_text(), AllOf(HasSubstr("sim.inputs: "), HasSubstr("sim.hash: ")));
}

TEST_F(ReplayTest, AWorldWithAnotherStepCannotBeCompared) {
  record(driven_world());
  try {
    again({"physics.step_s=0.005"});
    FAIL() << "was compared";
  } catch (const std::runtime_error& error) {
    EXPECT_THAT(error.what(), HasSubstr("steps of 10000 us"));
  }
}

TEST_F(ReplayTest, AMeshThatIsAnotherOneIsTold) {
  const std::string mesh = folder.file("plate.obj");
  std::ofstream(mesh) << "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 3 2\nf 1 2 4\nf 2 3 4\nf 1 4 3\n";
  const std::string world = driven_world(
      "  - {name: stone, position_m: [9, 9, 1], model: {shoal: 1, bodies: [{name: b, parts: [{shape: mesh, "
      "mesh: \"" +
      mesh + "\", mass_kg: 4}]}]}}\n");
  record(world);
  EXPECT_EQ(again().exit_code(), 0);
  std::ofstream(mesh, std::ios::app) << "# changed\n";
  EXPECT_THAT(error(), HasSubstr("plate.obj: is another file than in the run"));
  std::filesystem::remove(mesh);
  EXPECT_THAT(error(), HasSubstr("plate.obj: is missing"));
}

/// At the end of events, in the middle of them, and in a log of few states: what a step left in the log before its
/// inputs came is left out.
TEST_F(ReplayTest, ARecordIsUsedAsFarAsItGoesWhereverItIsCut) {
  int cuts = 0, used = 0;
  for (const char* more : {"", "state_rate_hz: 2\n", "run: {seed: 3, hash_every_steps: never}\n"}) {
    log = folder.file("whole" + std::to_string(cuts) + ".lcm");
    std::string world = driven_world(more);
    if (std::string(more).starts_with("run:"))
      world.erase(world.find("run:"), world.find("physics:") - world.find("run:"));
    record(world, [](RecordedRun& run, std::int64_t step) {
      if (step == 120) run.request("spawn", "{name: guest, file: rover_small.yaml, position_m: [0, 3, 0]}");
      if (step == 200) run.request("remove", "guest");
    });
    const std::string whole = log;
    EXPECT_EQ(again().exit_code(), 0) << again().to_text();
    EXPECT_EQ(again().steps, steps) << more;
    std::vector<std::uintmax_t> ends;
    bridges::EventLogReader reader(whole);
    while (const auto event = reader.next()) ends.push_back(event->offset);
    // Every other one in the middle of an event.
    for (std::size_t i = 3; i < ends.size(); i += 3) {
      const std::uintmax_t bytes = ends[i] + (i % 2 == 0 ? 17 : 0);
      cut(whole, bytes);
      ++cuts;
      try {
        const ReplayOutcome outcome = again();
        EXPECT_EQ(outcome.exit_code(), 0) << more << "cut at byte " << bytes << ": " << outcome.to_text();
        EXPECT_LE(outcome.steps, steps);
        ++used;
      } catch (const std::runtime_error& error) {
        EXPECT_THAT(error.what(), HasSubstr("ends before the first step")) << more << "cut at byte " << bytes;
      }
    }
  }
  EXPECT_GE(cuts, 180);
  EXPECT_GE(used, cuts * 9 / 10);
}

TEST_F(ReplayTest, WhatIsCutOffIsTold) {
  record(driven_world());
  const std::string whole = log;
  bridges::EventLogReader reader(whole);
  std::uintmax_t end = 0;
  // The messages of step 121 report an input that does not exist any more; the last stamp is that of the input itself.
  while (const auto event = reader.next())
    if (event->channel == "sim.inputs" && event->utime == 121 * 10'000 + 1'767'225'600'000'000) end = event->offset;
  ASSERT_GT(end, 0u);
  cut(whole, end);
  const ReplayOutcome outcome = again();
  EXPECT_EQ(outcome.exit_code(), 0);
  EXPECT_EQ(outcome.steps, 119);
  EXPECT_THAT(outcome.to_text(),
              HasSubstr("note: the log ends in the middle of step 120: everything after step 119 is left out"));
}

TEST_F(ReplayTest, OneLostMessageNamesItsStep) {
  record(driven_world());
  const std::string whole = log;
  const std::int64_t epoch = 1'767'225'600'000'000;
  std::map<std::string, std::vector<std::int64_t>> stamps;
  bridges::EventLogReader reader(whole);
  while (const auto event = reader.next()) stamps[event->channel].push_back((event->utime - epoch) / 10'000);
  log = folder.file("lossy.lcm");
  for (const auto& entry : stamps) {
    const std::string& channel = entry.first;  // clang 14 captures no structured binding
    const std::vector<std::int64_t>& steps_of = entry.second;
    if (channel == "sim.info") continue;
    for (const std::size_t number : {std::size_t{0}, steps_of.size() / 2, steps_of.size() - 1}) {
      SCOPED_TRACE(channel + ", number " + std::to_string(number));
      std::size_t count = 0;
      test::copy_log(whole, log, [&](const auto& event) { return event.channel == channel && count++ == number; });
      if (channel == "sim.inputs" && number == 0) {
        EXPECT_THAT(error(), HasSubstr("cannot be replayed from the start: sim.inputs 0 (of step 0) is missing"));
        continue;
      }
      const ReplayOutcome outcome = again();
      if (channel == "sim.inputs") {
        EXPECT_EQ(outcome.exit_code(), 4);
        // Published at the end of the step that began with the input.
        EXPECT_THAT(outcome.to_text(),
                    HasSubstr(fmt::format("sim.inputs {} (of step {}) is missing", number, steps_of[number] - 1)));
      } else if (channel == "sim.hash" || channel == "r1.drive.cmd") {  // nothing is lost with it: inputs have it
        EXPECT_EQ(outcome.exit_code(), 0) << outcome.to_text();
      } else {
        EXPECT_EQ(outcome.exit_code(), 1) << outcome.to_text();
        ASSERT_TRUE(outcome.first) << outcome.to_text();
        EXPECT_EQ(outcome.first->step, steps_of[number]);
        EXPECT_THAT(outcome.to_text(),
                    AllOf(HasSubstr(channel), HasSubstr(": was published here and is not in the log")));
      }
    }
  }
}

/// The state does not tell on which channel a device spoke, and what a logger lost cannot be compared.
TEST_F(ReplayTest, TheRunHashReportsMessagesThatTheLogLost) {
  record(driven_world());
  const std::string whole = log;
  log = folder.file("lossy.lcm");
  bool first = true;
  test::change_log(whole, log, [&](bridges::LogEvent& event) {
    if (std::exchange(first, false)) event.utime += 1;  // as lcm-logger stamps
    return event.channel != "r1.odometry";
  });
  EXPECT_EQ(again().exit_code(), 0) << again().to_text();
  const ReplayOutcome outcome = again({"vehicles.r1.devices.odometry.channel=r1.elsewhere"});
  EXPECT_EQ(outcome.exit_code(), 1);
  EXPECT_THAT(outcome.to_text(), HasSubstr("its run hash differs and its state hash does not"));
}

TEST_F(ReplayTest, WhatIsAskedForAfterTheLastStepIsDoneAgain) {
  for (const int last : {steps, steps + 7}) {  // with its own hash before, and without
    log = folder.file(std::to_string(last) + ".lcm");
    RecordedRun run(driven_world(), log);
    run.run(last, {}, [&] {
      run.request("do", "{move: {name: crate, position_m: [5, 5, 5]}}");
      run.request("do", "{publish: {channel: shore.hail, type: shoal.twist_command_t, value: {forward_mps: 1}}}");
    });
    const ReplayOutcome outcome = again();
    EXPECT_EQ(outcome.exit_code(), 0) << outcome.to_text();
    EXPECT_EQ(outcome.steps, last);
  }
}

TEST_F(ReplayTest, ALogOfAnotherVersionIsRefusedByItsName) {
  record(driven_world());
  const std::string whole = log;
  log = folder.file("old.lcm");
  test::change_log(whole, log, [](bridges::LogEvent& event) {
    if (event.channel != "sim.info") return true;
    auto info = shoal::decode<shoal::sim_info_t>(event.payload, shoal::Finite::any);
    info.versions = "shoal 0.3.0 (abc)\nODE: old\n";
    event.payload = shoal::encode(info);
    event.payload[0] ^= std::byte{1};  // another fingerprint: another type
    event.payload.resize(event.payload.size() - 20);
    return true;
  });
  EXPECT_THAT(error(), HasSubstr("was written by shoal 0.3.0 (abc); this is shoal "));
}

TEST_F(ReplayTest, ARecordOfVersion010IsRefusedByItsName) {
  log = test_support::source_path("tests/golden/records/version_0_1_0.log");
  EXPECT_THAT(error(), HasSubstr("version_0_1_0.log: was written by shoal 0.1.0 ("));
}

}  // namespace
