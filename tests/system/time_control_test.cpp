// SPDX-License-Identifier: BSD-3-Clause
#include <gmock/gmock.h>
#include <signal.h>

#include <filesystem>
#include <regex>

#include "bridges/lcm/lcm_listener.hpp"
#include "experiment/snapshot/snapshot_file.hpp"
#include "shoal/message_codec.hpp"
#include "shoal/sim_control_reply_t.hpp"
#include "shoal/sim_control_request_t.hpp"
#include "shoal/sim_vehicle_t.hpp"
#include "shoal/twist_command_t.hpp"
#include "tests/system/shoal_program.hpp"

// Snapshots, rewind, branches and `until` in the real program, asked for over the bus.

namespace {

using namespace system_test;
using testing::ContainsRegex;
using testing::EndsWith;
using testing::HasSubstr;
using testing::Not;

/// A rover with a lidar and a modem, which an event pushes about, and noise everywhere.
std::string lively_world() {
  return "shoal: 1\nname: lively\nrun: {duration_s: 20, speed: max}\n"
         "objects:\n  - {name: ground, fixed: true, parts: [{shape: plane}]}\n"
         "  - {name: ball, position_m: [2, 0, 1], parts: [{shape: sphere, radius_m: 0.2, mass_kg: 1}]}\n"
         "vehicles:\n  - {name: r1, file: " +
         source("vehicles/rover.yaml") +
         "}\n"
         "events:\n"
         "  - {name: move, every: 1.5, jitter_s: 0.4, do: [{move: {name: ball, position_m: [1, 1, 1]}}]}\n"
         "  - {name: late, at: 7.25, do: [{log: here}]}\n";
}

struct Folder : ScratchFolder {
  Folder() {
    write_file(file("world.yaml"), lively_world());
    // Guests come by the name of a file beside the world.
    for (const char* name : {"rover.yaml", "rover_small.yaml"})
      write_file(file(name), text_of_file(source("vehicles/") + name));
  }
  std::string world() const { return file("world.yaml"); }
};

/// A run that people talk to.
struct Live {
  explicit Live(const Folder& folder, std::vector<std::string> more = {}) : program(arguments(folder, more)) {
    EXPECT_TRUE(await([] { return control({"where", "--timeout", "0.5"}).exit_code == 0; }, timeout));
  }
  static std::vector<std::string> arguments(const Folder& folder, const std::vector<std::string>& more) {
    std::vector<std::string> all{built("shoal"), "run",         folder.world(),       "--paused", "--lcm-url",
                                 own_url(),      "--snapshots", folder.file("snaps"), "--speed",  "max"};
    all.insert(all.end(), more.begin(), more.end());
    if (std::find(all.begin(), all.end(), "--from") != all.end()) all.erase(all.begin() + 2);  // it has its world
    if (std::find(all.begin(), all.end(), "--duration") == all.end()) all.insert(all.end(), {"--duration", "forever"});
    return all;
  }
  static std::string where() {
    const std::string text = control({"where"}).output;
    return text.substr(0, text.find(';'));
  }
  int quit() {
    control({"quit"});
    return program.wait();
  }
  Program program;
};

std::string hash_of_snapshot(const std::string& path) {
  const Ended ended = run_shoal({"snapshot", path});
  std::smatch found;
  if (!std::regex_search(ended.output, found, std::regex("state hash ([0-9a-f]{16})"))) return ended.errors;
  return found[1];
}

TEST(Snapshot, AFreshProcessContinuesBitForBit) {
  const Folder folder;
  const std::vector<std::string> run{"run",           folder.world(), "--bus",       "none",
                                     "--snapshot-at", "10,3.33",      "--snapshots", folder.file("snaps")};
  const Ended whole = run_shoal(run);
  ASSERT_EQ(whole.exit_code, 0) << whole.errors;
  for (const char* name : {"/branch0_step1000.snapshot", "/branch0_step333.snapshot"}) {
    const std::string snapshot = folder.file("snaps") + name;
    const Ended checked = run_shoal({"snapshot", snapshot, "--check"});
    EXPECT_EQ(checked.exit_code, 0) << checked.errors;
    EXPECT_THAT(checked.output, HasSubstr("restores with the same hash"));
    const Ended rest = run_shoal({"run", "--from", snapshot, "--bus", "none"});
    EXPECT_EQ(rest.exit_code, 0) << rest.errors;
    EXPECT_EQ(run_hash_in(rest), run_hash_in(whole));
    EXPECT_THAT(rest.output, HasSubstr("2000 steps, 20.00 s simulated"));
  }
}

TEST(Snapshot, ValuesCanBeSetAndStructureCannot) {
  const Folder folder;
  ASSERT_EQ(run_shoal({"run", folder.world(), "--bus", "none", "--duration", "2", "--snapshot-at", "1", "--snapshots",
                       folder.file("snaps")})
                .exit_code,
            0);
  const std::string snapshot = folder.file("snaps") + "/branch0_step100.snapshot";
  const auto from = [&](const std::string& set) {
    return run_shoal({"run", "--from", snapshot, "--bus", "none", "--duration", "3", "--set", set});
  };
  const Ended same = run_shoal({"run", "--from", snapshot, "--bus", "none", "--duration", "3"});
  const std::string hash = state_hash_in(same);
  EXPECT_EQ(state_hash_in(from("vehicles.r1.devices.lidar.rate_hz=10")), hash) << "as it was";
  // Each changes what happens from the snapshot on.
  for (const char* set : {"physics.gravity_mps2=5", "vehicles.r1.devices.lidar.rate_hz=5",
                          "vehicles.r1.devices.lidar.range_max_m=0.8", "vehicles.r1.devices.lidar.noise.bias=0.1"}) {
    const Ended ended = from(set);
    EXPECT_EQ(ended.exit_code, 0) << set << ended.errors;
    EXPECT_NE(state_hash_in(ended), hash) << set;
  }
  const Ended other = from("objects.ball.present=false");
  EXPECT_EQ(other.exit_code, 2) << other.output;
  EXPECT_THAT(other.errors, HasSubstr("snapshot"));
  const Ended step = from("physics.step_s=0.005");
  EXPECT_EQ(step.exit_code, 2);
  EXPECT_THAT(step.errors, HasSubstr("a step of 10000 us"));
}

TEST(Snapshot, WhatTheCommandLineRequestsHasNoLimit) {
  const ScratchFolder folder;
  write_file(folder.file("world.yaml"), "shoal: 1\nname: empty\nphysics: {step_s: 0.01}\n");
  const Ended ended = run_shoal({"run", folder.file("world.yaml"), "--bus", "none", "--duration", "10.1",
                                 "--snapshot-every", "0.01", "--snapshots", folder.file("snaps")});
  EXPECT_EQ(ended.exit_code, 0) << ended.errors.substr(ended.errors.size() -
                                                       std::min<std::size_t>(400, ended.errors.size()));
  int files = 0;
  for ([[maybe_unused]] const auto& file : std::filesystem::directory_iterator(folder.file("snaps"))) ++files;
  EXPECT_EQ(files, 1010);  // the requests of others are limited to 1000
}

TEST(Snapshot, IsTakenAtTheStepNearestToTheTimeThatWasAskedFor) {
  const Folder folder;
  const auto run = [&](const std::string& times, const std::vector<std::string>& more = {}) {
    std::vector<std::string> arguments{"run",         folder.world(),       "--bus",
                                       "none",        "--snapshot-at",      times,
                                       "--snapshots", folder.file("snaps"), "--overwrite"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return run_shoal(arguments);
  };
  const Ended between = run("0.005,0.024,0", {"--duration", "1"});
  EXPECT_EQ(between.exit_code, 0) << between.errors;
  for (const char* step : {"0", "1", "2"})
    EXPECT_TRUE(std::filesystem::exists(folder.file("snaps") + "/branch0_step" + step + ".snapshot")) << step;
  const Ended late = run("1,5", {"--duration", "3"});
  EXPECT_EQ(late.exit_code, 2);
  EXPECT_THAT(late.errors, HasSubstr("--snapshot-at: 5 s is after the end of the run at 3 s"));
  const Ended early = run_shoal({"run", "--from", folder.file("snaps") + "/branch0_step2.snapshot", "--bus", "none",
                                 "--duration", "1", "--snapshot-at", "0.01", "--snapshots", folder.file("snaps")});
  EXPECT_EQ(early.exit_code, 2);
  EXPECT_THAT(early.errors, HasSubstr("--snapshot-at: 0.01 s is before the start of the run at 0.02 s"));
  // A run that ends before its time.
  write_file(folder.world(), lively_world() + "  - {name: stop, at: 2, do: [{end: {reason: enough, passed: true}}]}\n");
  const Ended short_run = run("1,5");
  EXPECT_EQ(short_run.exit_code, 0);
  EXPECT_THAT(short_run.errors, HasSubstr("--snapshot-at: no snapshot of 5 s was written: the run ended before it"));
  EXPECT_THAT(short_run.errors, Not(HasSubstr("no snapshot of 1 s")));
}

TEST(Snapshot, NoticesThatAFileOfItsWorldIsAnotherOne) {
  const Folder folder;
  const std::string mesh = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 3 2\nf 1 2 4\nf 2 3 4\nf 1 4 3\n";
  const std::string flow = "x_m,y_m,east_mps,north_mps\n0,0,0.5,0\n10,0,0.5,0\n0,10,0.5,0\n10,10,0.5,0\n";
  write_file(folder.file("stone.obj"), mesh);
  write_file(folder.file("flow.csv"), flow);
  std::string world = lively_world();
  world.insert(world.find("objects:\n") + 9,
               "  - {name: stone, fixed: true, position_m: [3, 3, 2], parts: [{shape: mesh, mesh: stone.obj}]}\n");
  write_file(folder.world(), world + "medium: {water: {}, current: [{type: grid, file: flow.csv}]}\n");
  const std::string snaps = folder.file("snaps"), snapshot = snaps + "/branch0_step100.snapshot";
  const Ended whole = run_shoal(
      {"run", folder.world(), "--bus", "none", "--duration", "2", "--snapshot-at", "1", "--snapshots", snaps});
  ASSERT_EQ(whole.exit_code, 0) << whole.errors;
  const auto from = [&] { return run_shoal({"run", "--from", snapshot, "--bus", "none", "--duration", "2"}); };
  EXPECT_EQ(run_hash_in(from()), run_hash_in(whole)) << "from another folder than its world's";
  for (const auto& [file, text] : {std::pair("stone.obj", mesh), {"flow.csv", flow}}) {
    write_file(folder.file(file), text + (text == mesh ? "v 2 2 2\n" : "20,0,0.5,0\n20,10,0.5,0\n"));
    for (const Ended& refused : {from(), run_shoal({"snapshot", snapshot, "--check"})}) {
      EXPECT_EQ(refused.exit_code, 4) << refused.output;
      EXPECT_THAT(refused.errors, HasSubstr("these input files of its world changed since it was written"));
      EXPECT_THAT(refused.errors, HasSubstr(std::string(file) + ": is another file than in the run"));
    }
    if (text == mesh) {
      Live live(folder, {"--overwrite"});
      const Ended refused = control({"restore", "branch0_step100"});
      EXPECT_EQ(refused.exit_code, 1) << refused.output;
      EXPECT_THAT(refused.errors, HasSubstr("its world used other files than this run"));
      EXPECT_EQ(live.quit(), 0) << live.program.errors();
    }
    write_file(folder.file(file), text);
    EXPECT_EQ(from().exit_code, 0);
  }
}

TEST(Snapshot, RefusesWhatIsNone) {
  const Folder folder;
  write_file(folder.file("foreign"), "not a snapshot at all");
  const Ended foreign = run_shoal({"snapshot", folder.file("foreign")});
  EXPECT_EQ(foreign.exit_code, 4);
  EXPECT_THAT(foreign.errors, HasSubstr("foreign: is not a Shoal snapshot"));
  EXPECT_EQ(run_shoal({"run", "--from", folder.file("foreign"), "--bus", "none"}).exit_code, 4);
  EXPECT_EQ(run_shoal({"run", "--from", folder.file("missing"), "--bus", "none"}).exit_code, 4);
  EXPECT_EQ(run_shoal({"run", folder.world(), "--from", folder.file("foreign")}).exit_code, 2);
  EXPECT_EQ(run_shoal({"run"}).exit_code, 2);
  for (const char* times : {"x", "1,nan", "-1", "1,,2"})
    EXPECT_EQ(run_shoal({"run", folder.world(), "--snapshots", folder.file("s"), "--snapshot-at", times}).exit_code, 2)
        << times;
  EXPECT_EQ(run_shoal({"run", folder.world(), "--snapshot-at", "1"}).exit_code, 2);
}

TEST(Rewind, RunAgainIsEqualToARunThatNeverWentBack) {
  const Folder folder;
  const Ended straight = run_shoal({"run", folder.world(), "--bus", "none"});
  Live live(folder, {"--duration", "20", "--record", folder.file("log.lcm")});
  run_until("9.37");
  const Ended back = control({"rewind", "--value", "4.2"});
  EXPECT_EQ(back.exit_code, 0) << back.errors;
  EXPECT_EQ(back.output, "step 517, 5.17 s, branch 1, paused\n");
  EXPECT_EQ(back.errors, "paused; continue with `shoal control resume --lcm-url '" + own_url() + "'`\n");
  run_until("12");
  const Ended goes_on = control({"rewind", "run", "--value", "11"});
  EXPECT_EQ(goes_on.exit_code, 0);
  EXPECT_EQ(goes_on.errors, "");
  ASSERT_EQ(live.program.wait(), 0) << live.program.errors();
  Ended ended;
  ended.output = live.program.output();
  EXPECT_EQ(run_hash_in(ended), run_hash_in(straight));
  EXPECT_THAT(ended.output, HasSubstr("branch 2"));
  for (const char* log : {"log.lcm", "log.branch1.lcm", "log.branch2.lcm"}) {
    const Ended replayed = run_shoal({"replay", folder.file(log)});
    EXPECT_EQ(replayed.exit_code, 0) << log << replayed.output << replayed.errors;
  }
}

TEST(Rewind, InputsAndRequestsComeInAgainAtTheSameSteps) {
  const Folder folder;
  Live live(folder);
  bridges::LcmListener listener(own_url());
  run_until("2");
  EXPECT_EQ(control({"spawn", "{name: guest, file: rover.yaml, position_m: [0, 3, 0]}"}).exit_code, 0);
  shoal::twist_command_t forward{};
  forward.forward_mps = 1;
  for (const char* channel : {"r1.drive.cmd", "guest.drive.cmd"}) listener.publish(channel, shoal::encode(forward));
  run_until("4.5");
  EXPECT_EQ(control({"do", "{move: {name: ball, position_m: [3, 3, 3]}}"}).exit_code, 0);
  run_until("4.9");
  EXPECT_EQ(control({"snapshot", "first"}).exit_code, 0);
  run_until("8");
  const Ended back = control({"rewind", "--value", "3.1"});
  EXPECT_EQ(back.output, "step 490, 4.9 s, branch 1, paused\n") << back.errors;
  EXPECT_EQ(control({"snapshot", "again"}).exit_code, 0);
  EXPECT_EQ(hash_of_snapshot(folder.file("snaps/again.snapshot")),
            hash_of_snapshot(folder.file("snaps/first.snapshot")));
  EXPECT_EQ(live.quit(), 0) << live.program.errors();
}

TEST(Rewind, ReportsVehiclesThatAreGone) {
  const Folder folder;
  Live live(folder);
  bridges::LcmListener listener(own_url());
  listener.listen("sim.vehicle");
  run_until("2");
  EXPECT_EQ(
      control({"spawn", "{name: guest, file: rover.yaml, position_m: [0, 3, 0]}", "--client", "visitor"}).exit_code, 0);
  run_until("4");
  EXPECT_EQ(control({"rewind", "--value", "3"}).exit_code, 0);
  EXPECT_TRUE(await([&] {
    const auto message = listener.next(100ms);
    if (!message) return false;
    const auto vehicle = shoal::decode<shoal::sim_vehicle_t>(message->payload, shoal::Finite::any);
    return vehicle.vehicle == "guest" && !vehicle.present && vehicle.client == "visitor";
  }));
  EXPECT_EQ(live.quit(), 0) << live.program.errors();
}

TEST(Rewind, RefusesWhatCannotBeAndSaysSo) {
  const Folder folder;
  Live live(folder, {"--rewind-s", "3"});
  run_until("50");
  // What is kept begins here: a run that is slow keeps fewer snapshots, and may be able to go further back.
  EXPECT_EQ(control({"snapshot", "fifty"}).exit_code, 0);
  EXPECT_EQ(control({"restore", "fifty"}).output, "step 5000, 50 s, branch 1, paused\n");
  const auto refused = [](std::vector<std::string> arguments) {
    const Ended ended = control(std::move(arguments));
    EXPECT_EQ(ended.exit_code, 1) << ended.output;
    return ended.errors;
  };
  EXPECT_THAT(refused({"rewind", "--value", "0.001"}),
              HasSubstr("'rewind' by 0.001 s is less than half a step of 0.01"));
  EXPECT_THAT(refused({"step", "--value", "1.7"}),
              HasSubstr("'step' needs a whole number of steps from 1 to 1e9, got 1.7"));
  EXPECT_THAT(refused({"speed", "--value", "1e-4"}),
              HasSubstr("'speed' must be 0 (as fast as possible) or from 0.001"));
  EXPECT_THAT(refused({"rewind", "--value", "49"}),
              HasSubstr("cannot rewind 49 s from 50 s: the history starts at 50 s"));
  EXPECT_THAT(refused({"rewind", "--value", "-1"}), HasSubstr("'rewind' needs a value above 0, in seconds, got -1"));
  EXPECT_THAT(refused({"rewind"}), HasSubstr("'rewind' needs a value above 0"));
  for (const char* value : {"nan", "inf"}) {
    const Ended ended = control({"rewind", "--value", value});
    EXPECT_EQ(ended.exit_code, 2);
    EXPECT_THAT(ended.errors,
                HasSubstr("--value: must be from -1e12 to 1e12, or max, got '" + std::string(value) + "'"));
  }
  EXPECT_THAT(refused({"rewind", "fast", "--value", "1"}), HasSubstr("takes the text 'run' or none, got 'fast'"));
  EXPECT_THAT(refused({"until", "--value", "50"}), HasSubstr("'until' needs a time after now (50 s)"));
  EXPECT_THAT(refused({"until", "nothing"}), HasSubstr("the name of an event of the world, got 'nothing'"));
  EXPECT_THAT(refused({"snapshot", "../escape"}), HasSubstr("a snapshot has a file name of"));
  EXPECT_THAT(refused({"restore", "missing"}), HasSubstr("missing.snapshot: cannot be read"));
  EXPECT_EQ(control({"snapshot", "once"}).exit_code, 0);
  EXPECT_THAT(refused({"snapshot", "once"}), HasSubstr("already exists"));
  write_file(folder.file("snaps/bad.snapshot"), "SHOALSNP");
  EXPECT_THAT(refused({"restore", "bad"}), HasSubstr("bad.snapshot: is cut off after 8 bytes"));
  EXPECT_EQ(Live::where(), "step 5000, 50 s, branch 1, paused");
  EXPECT_EQ(live.quit(), 0) << live.program.errors();
}

TEST(Rewind, FurtherThanTheRunHasComeGoesToItsBegin) {
  const Folder folder;
  Live live(folder);
  EXPECT_THAT(control({"rewind", "--value", "1"}).errors,
              HasSubstr("already at the start of the run: nothing to rewind"));
  run_until("4.7");
  EXPECT_EQ(control({"rewind", "--value", "10"}).output, "step 0, 0 s, branch 1, paused\n");
  EXPECT_EQ(live.quit(), 0) << live.program.errors();
}

TEST(Time, EveryRequestIsAnsweredWithThePlace) {
  const Folder folder;
  Live live(folder);
  run_until("1");
  EXPECT_EQ(control({"pause"}).output, "step 100, 1 s, branch 0, paused\n");
  EXPECT_EQ(control({"speed", "--value", "0.001"}).output, "step 100, 1 s, branch 0, paused, 0.001 x real time\n");
  EXPECT_EQ(control({"resume"}).output, "step 100, 1 s, branch 0\n");
  EXPECT_THAT(control({"pause"}).output, EndsWith(" s, branch 0, paused\n"));
  EXPECT_THAT(control({"step", "--value", "2"}).output, EndsWith(" s, branch 0, paused, takes 2 steps\n"));
  EXPECT_THAT(control({"speed", "--value", "max"}).output, HasSubstr("as fast as possible"));
  EXPECT_EQ(live.quit(), 0) << live.program.errors();
}

TEST(Time, TheReplyToARewindHasTheTimeThereIs) {
  const Folder folder;
  Live live(folder);
  run_until("3");
  bridges::LcmListener listener(own_url());
  listener.listen("sim.control.reply");
  shoal::sim_control_request_t request{};
  request.id = 77;
  request.client = "tester";
  request.command = "rewind";
  request.value = 1.5;
  listener.publish("sim.control", shoal::encode(request));
  EXPECT_TRUE(await(
      [&] {
        const auto message = listener.next(100ms);
        if (!message) return false;
        const auto reply = shoal::decode<shoal::sim_control_reply_t>(message->payload, shoal::Finite::any);
        if (reply.id != 77) return false;
        EXPECT_EQ(reply.utime, 1'767'225'600'000'000 + 1'500'000) << reply.text;  // the usual epoch
        return true;
      },
      timeout));
  EXPECT_EQ(live.quit(), 0) << live.program.errors();
}

TEST(Time, ZeroIsAsFastAsPossibleOnTheCommandLineToo) {
  const Folder folder;
  EXPECT_EQ(run_shoal({"run", folder.world(), "--bus", "none", "--duration", "1", "--speed", "max"}).exit_code, 0);
  EXPECT_EQ(run_shoal({"run", folder.world(), "--bus", "none", "--duration", "1", "--speed", "0.0001"}).exit_code, 2);
  EXPECT_EQ(
      run_shoal({"run", folder.world(), "--bus", "none", "--duration", "1", "--set", "run.speed=0.0001"}).exit_code, 2);
}

TEST(Rewind, ABranchWhoseRecordCannotBeMadeLeavesTheRunAsItWas) {
  const Folder folder;
  Live live(folder, {"--overwrite", "--record", folder.file("log.lcm")});
  run_until("5");
  EXPECT_EQ(control({"snapshot", "five"}).exit_code, 0);
  run_until("6");
  const std::string before = Live::where();
  std::filesystem::create_directory(folder.file("log.branch1.lcm"));
  for (const std::vector<std::string>& move :
       {std::vector<std::string>{"rewind", "--value", "2"}, std::vector<std::string>{"restore", "five"}}) {
    const Ended refused = control(move);
    EXPECT_EQ(refused.exit_code, 1) << refused.output;
    EXPECT_THAT(refused.errors, HasSubstr("log.branch1.lcm: Is a directory"));
    EXPECT_EQ(Live::where(), before);
  }
  std::filesystem::remove(folder.file("log.branch1.lcm"));
  EXPECT_EQ(control({"rewind", "--value", "2"}).output, "step 400, 4 s, branch 1, paused\n");
  run_until("5");
  EXPECT_EQ(control({"snapshot", "again"}).exit_code, 0);
  EXPECT_EQ(hash_of_snapshot(folder.file("snaps/five.snapshot")),
            hash_of_snapshot(folder.file("snaps/again.snapshot")));
  EXPECT_EQ(live.quit(), 0) << live.program.errors();
  for (const char* log : {"log.lcm", "log.branch1.lcm"}) {
    const Ended replayed = run_shoal({"replay", folder.file(log)});
    EXPECT_EQ(replayed.exit_code, 0) << log << replayed.output << replayed.errors;
  }
}

TEST(Restore, ItsRecordsAreRunAgainFromTheFileOn) {
  const Folder folder;
  Live live(folder, {"--record", folder.file("log.lcm")});
  bridges::LcmListener listener(own_url());
  run_until("1");
  shoal::twist_command_t forward{};
  forward.forward_mps = 1;
  listener.publish("r1.drive.cmd", shoal::encode(forward));
  EXPECT_EQ(control({"spawn", "{name: guest, file: rover.yaml, position_m: [0, 3, 0]}"}).exit_code, 0);
  run_until("3");
  EXPECT_EQ(control({"snapshot", "a"}).exit_code, 0);
  EXPECT_EQ(control({"remove", "guest"}).exit_code, 0);
  run_until("3.5");
  EXPECT_EQ(control({"restore", "a"}).exit_code, 0);
  listener.publish("guest.drive.cmd", shoal::encode(forward));
  run_until("4");
  EXPECT_EQ(control({"rewind", "--value", "0.5"}).output, "step 350, 3.5 s, branch 2, paused\n");
  run_until("5");
  EXPECT_EQ(live.quit(), 0) << live.program.errors();
  for (const auto& [log, text] : {std::pair("log.lcm", "equal for 350 steps ("),
                                  {"log.branch1.lcm", "equal for 100 steps (from step 300; "},
                                  {"log.branch2.lcm", "equal for 200 steps (from step 300; "}}) {
    const Ended replayed = run_shoal({"replay", folder.file(log)});
    EXPECT_EQ(replayed.exit_code, 0) << log << replayed.output << replayed.errors;
    EXPECT_THAT(replayed.output, HasSubstr(text)) << log;
    EXPECT_THAT(replayed.output, Not(ContainsRegex("note: [^i]"))) << log;  // "in the run: ..." is one that may be
  }
}

/// A client that goes back with its world, and receives and commands its vehicle on a bus of the vehicle's own.
TEST(Restore, InTheMiddleOfALockstepMissionOnABusOfItsOwnItsRecordIsRunAgain) {
  const Folder folder;
  write_file(folder.file("world.yaml"), "shoal: 1\nname: lively\nbuses: [{name: own, lcm_url: \"" + own_url(1) +
                                            "\"}]\nobjects:\n  - {name: ground, fixed: true, parts: [{shape: plane}]}\n"
                                            "vehicles:\n  - {name: r1, bus: own, file: " +
                                            source("vehicles/rover.yaml") + "}\n");
  Program pilot({built("lockstep_pilot"), "--name", "pilot", "--vehicle", "r1", "--period", "0.1", "--receive",
                 "r1.odometry", "--go-back", "--lcm-url", own_url(1)});
  Live live(folder, {"--record", folder.file("log.lcm"), "--await", "pilot"});
  run_until("3");
  EXPECT_EQ(control({"snapshot", "a"}).exit_code, 0);
  run_until("4");
  EXPECT_EQ(control({"restore", "a"}).output, "step 300, 3 s, branch 1, paused\n");
  run_until("6");
  EXPECT_EQ(live.quit(), 0) << live.program.errors();
  EXPECT_EQ(pilot.wait(), 0) << pilot.output() << pilot.errors();
  for (const auto& [log, text] :
       {std::pair("log.lcm", "equal for 400 steps ("), {"log.branch1.lcm", "equal for 600 steps ("}}) {
    const Ended replayed = run_shoal({"replay", folder.file(log)});
    EXPECT_EQ(replayed.exit_code, 0) << log << replayed.output << replayed.errors;
    EXPECT_THAT(replayed.output, HasSubstr(text)) << log;
  }
}

/// A file has nothing of a program's memory.
TEST(Restore, WithLockstepClientsGoesOnlyWhereTheRunHasBeenAndRemembers) {
  const Folder folder;
  ASSERT_EQ(run_shoal({"run", folder.world(), "--bus", "none", "--duration", "2", "--snapshot-at", "1", "--snapshots",
                       folder.file("snaps")})
                .exit_code,
            0);
  Program pilot({built("lockstep_pilot"), "--name", "pilot", "--vehicle", "r1", "--period", "0.1", "--receive",
                 "r1.odometry", "--go-back", "--lcm-url", own_url()});
  Live live(folder, {"--await", "pilot", "--rewind-s", "3"});
  const auto refusal = [](const std::string& name) {
    const Ended ended = control({"restore", name});
    EXPECT_EQ(ended.exit_code, 1) << ended.output;
    EXPECT_EQ(std::count(ended.errors.begin(), ended.errors.end(), '\n'), 1) << ended.errors;
    EXPECT_THAT(ended.errors,
                HasSubstr("the lockstep clients (pilot) cannot be restored to a state that they never had"));
    return ended.errors;
  };
  run_until("2");
  EXPECT_EQ(control({"snapshot", "early"}).exit_code, 0);
  EXPECT_THAT(refusal("branch0_step100"), HasSubstr("was not written by this run before step 200, 2 s"));
  run_until("4");
  EXPECT_EQ(control({"snapshot", "later"}).exit_code, 0);
  EXPECT_EQ(control({"rewind", "--value", "1"}).exit_code, 0);
  EXPECT_THAT(refusal("later"), HasSubstr("was not written by this run before step 300, 3 s"));
  EXPECT_EQ(Live::where(), "step 300, 3 s, branch 1, paused");
  EXPECT_EQ(control({"restore", "early"}).output, "step 200, 2 s, branch 2, paused\n");
  run_until("12");
  EXPECT_THAT(refusal("early"), HasSubstr("t = 2 s precedes this run's history"));
  EXPECT_EQ(live.quit(), 0) << live.program.errors();
  EXPECT_EQ(pilot.wait(), 0) << pilot.output() << pilot.errors();
}

TEST(Restore, OneThatDoesNotFitLeavesNoBranchBehind) {
  const Folder folder;
  const std::string results = folder.file("results");
  Live live(folder, {"--results", results, "--no-plots"});
  run_until("2");
  EXPECT_EQ(control({"snapshot", "good"}).exit_code, 0);
  // Of the same world, with a state that has bytes too many.
  experiment::Snapshot bad = experiment::read_snapshot(folder.file("snaps/good.snapshot"));
  bad.state.push_back(std::byte{1});
  experiment::write_snapshot(folder.file("snaps/bad.snapshot"), bad);
  const std::string before = Live::where();
  const Ended refused = control({"restore", "bad"});
  EXPECT_EQ(refused.exit_code, 1) << refused.output;
  EXPECT_THAT(refused.errors, HasSubstr("bytes are left over in the snapshot"));
  EXPECT_EQ(Live::where(), before);
  EXPECT_FALSE(std::filesystem::exists(results + "/branch0"));
  EXPECT_EQ(control({"restore", "good"}).exit_code, 0);
  EXPECT_EQ(summary_value(results + "/branch0", "steps"), "200");
  EXPECT_EQ(live.quit(), 0) << live.program.errors();
}

TEST(Restore, OfALaterTimeBeginsTheTracksAnew) {
  const Folder folder;
  const std::string results = folder.file("results");
  Live live(folder, {"--results", results, "--no-plots"});
  run_until("6");
  EXPECT_EQ(control({"snapshot", "six"}).exit_code, 0);
  EXPECT_EQ(control({"rewind", "--value", "4"}).exit_code, 0);
  EXPECT_EQ(control({"do", "{move: {name: r1, position_m: [5, 5, 0.2]}}"}).exit_code, 0);
  run_until("3");
  EXPECT_EQ(control({"restore", "six"}).exit_code, 0);
  EXPECT_THAT(control({"rewind", "--value", "1"}).errors, HasSubstr("the history starts at 6 s"));
  run_until("8");
  EXPECT_EQ(live.quit(), 0) << live.program.errors();
  const auto first_time = [](const std::string& directory) {
    const std::string text = text_of_file(directory + "/tracks.csv");
    return std::stod(text.substr(text.find('\n') + 1));
  };
  EXPECT_GT(first_time(results), 6) << "of branch 2, which began at 6 s; what branch 1 did is in branch1";
  EXPECT_LT(first_time(results + "/branch1"), 1);
}

TEST(Restore, ContinuesFromAFileAndRefusesAnotherWorldsOne) {
  const Folder folder;
  Live live(folder);
  run_until("3");
  EXPECT_EQ(control({"snapshot", "a"}).exit_code, 0);
  run_until("5");
  EXPECT_EQ(control({"snapshot", "b"}).exit_code, 0);
  const Ended restored = control({"restore", "a"});
  EXPECT_EQ(restored.output, "step 300, 3 s, branch 1, paused\n") << restored.errors;
  run_until("5");
  EXPECT_EQ(control({"snapshot", "c"}).exit_code, 0);
  EXPECT_EQ(hash_of_snapshot(folder.file("snaps/b.snapshot")), hash_of_snapshot(folder.file("snaps/c.snapshot")));
  ASSERT_EQ(run_shoal({"run", folder.world(), "--bus", "none", "--seed", "99", "--duration", "2", "--snapshot-at", "1",
                       "--snapshots", folder.file("snaps")})
                .exit_code,
            0);
  const Ended other = control({"restore", "branch0_step100"});
  EXPECT_EQ(other.exit_code, 1);
  EXPECT_THAT(other.errors, HasSubstr("is of another world or other values: line "));
  EXPECT_EQ(live.quit(), 0) << live.program.errors();
}

TEST(Restore, OfAnEarlierFileThanTheRunBeganWithLetsItGoBackThere) {
  const Folder folder;
  ASSERT_EQ(run_shoal({"run", folder.world(), "--bus", "none", "--duration", "5", "--snapshot-at", "1,5", "--snapshots",
                       folder.file("snaps")})
                .exit_code,
            0);
  Live live(folder, {"--from", folder.file("snaps") + "/branch0_step500.snapshot"});
  EXPECT_EQ(control({"restore", "branch0_step100"}).output, "step 100, 1 s, branch 1, paused\n");
  run_until("3");
  EXPECT_EQ(control({"rewind", "--value", "0.5"}).output, "step 250, 2.5 s, branch 2, paused\n");
  EXPECT_EQ(control({"rewind", "--value", "9"}).output, "step 100, 1 s, branch 3, paused\n");
  EXPECT_EQ(live.quit(), 0) << live.program.errors();
}

TEST(Until, PausesAtATimeAndWhenAnEventFires) {
  const Folder folder;
  Live live(folder);
  run_until("1.005");
  EXPECT_EQ(Live::where(), "step 101, 1.01 s, branch 0, paused");
  EXPECT_EQ(control({"until", "late"}).exit_code, 0);
  await_pause();
  // The event fires in the step that begins at 7.25 s.
  EXPECT_EQ(Live::where(), "step 726, 7.26 s, branch 0, paused");
  EXPECT_EQ(control({"step", "--value", "3"}).exit_code, 0);
  EXPECT_TRUE(await([] { return Live::where().starts_with("step 729,"); }, timeout));
  EXPECT_EQ(live.quit(), 0) << live.program.errors();
}

TEST(Branch, KeepsTheResultsOfTheOneThatIsLeft) {
  const Folder folder;
  const std::string results = folder.file("results");
  Live live(folder, {"--results", results, "--no-plots"});
  run_until("6");
  EXPECT_EQ(control({"rewind", "--value", "4"}).exit_code, 0);
  EXPECT_EQ(control({"do", "{move: {name: r1, position_m: [5, 5, 0.2]}}"}).exit_code, 0);
  run_until("6");
  EXPECT_EQ(live.quit(), 0) << live.program.errors();
  EXPECT_EQ(summary_value(results, "steps"), "600");
  EXPECT_EQ(summary_value(results, "branch"), "1");
  EXPECT_EQ(summary_value(results + "/branch0", "steps"), "600");
  EXPECT_EQ(summary_value(results + "/branch0", "ended"), "\"rewound\"");
  for (const char* hash : {"state_hash", "run_hash"})
    EXPECT_NE(summary_value(results, hash), summary_value(results + "/branch0", hash));
  const auto lines = [](const std::string& path) {
    const std::string text = text_of_file(path);
    return std::count(text.begin(), text.end(), '\n');
  };
  // Cut off at 2 s and written again to 6 s: as many lines, each time once.
  EXPECT_EQ(lines(results + "/tracks.csv"), lines(results + "/branch0/tracks.csv"));
}

}  // namespace
