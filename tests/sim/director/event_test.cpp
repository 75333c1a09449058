// SPDX-License-Identifier: BSD-3-Clause
#include <gmock/gmock.h>

#include "shoal/gps_data_t.hpp"
#include "shoal/modem_received_t.hpp"
#include "shoal/modem_send_t.hpp"
#include "shoal/planar_lidar_t.hpp"
#include "shoal/twist_command_t.hpp"
#include "sim/director/script.hpp"
#include "sim/world/world_editor.hpp"
#include "sim/world/world_state.hpp"
#include "tests/devices/world_fixture.hpp"

namespace {

using testing::ElementsAre;

/// A ball that falls forever beside what the events say.
std::string event_world(const std::string& events, const std::string& more = "") {
  return "shoal: 1\nphysics: {step_s: 0.01, gravity_mps2: 0}\n"
         "objects:\n"
         "  - {name: ball, position_m: [0, 0, 5], parts: [{shape: sphere, radius_m: 0.1, mass_kg: 1}]}\n"
         "  - {name: crate, present: false, position_m: [9, 0, 5], parts: [{shape: box, mass_kg: 1}]}\n" +
         more + "events:\n" + events;
}

/// The steps at whose start something was published on `tick`.
std::vector<std::int64_t> ticks(test::TestWorld& test, double time_s) {
  const auto mailbox = test.bus.open_mailbox("tick", 1000);
  std::vector<std::int64_t> steps;
  while (sim::to_seconds(test.world.now()) < time_s - 1e-9) {
    test.world.step();
    while (mailbox->take()) steps.push_back(test.world.step_number() - 1);
  }
  return steps;
}

const std::string tick = "do: [{publish: {channel: tick, type: shoal.utime_t}}]}\n";

TEST(Events, FireInTheFirstStepThatStartsAtTheirTimeOrLater) {
  test::TestWorld test(event_world("  - {name: a, at: [0, 0.1, 0.305], " + tick));
  EXPECT_THAT(ticks(test, 1), ElementsAre(0, 10, 31));
}

TEST(Events, FireEverySoOftenWithinTheirTime) {
  test::TestWorld test(event_world("  - {name: a, every: 0.2, from_s: 0.1, until_s: 0.7, " + tick));
  EXPECT_THAT(ticks(test, 2), ElementsAre(10, 30, 50, 70));
  test::TestWorld plain(event_world("  - {name: a, every: 0.2, times: 3, " + tick));
  EXPECT_THAT(ticks(plain, 2), ElementsAre(20, 40, 60));
}

TEST(Events, ComeLaterByTheirDelay) {
  test::TestWorld test(event_world("  - {name: a, at: 0.1, delay_s: 0.25, " + tick));
  EXPECT_THAT(ticks(test, 1), ElementsAre(35));
}

TEST(Events, WithJitterAreTheSameForTheSameSeedOnly) {
  const auto steps = [](int seed) {
    test::TestWorld test(event_world("  - {name: a, every: 1, jitter_s: 0.5, " + tick) +
                         "run: {seed: " + std::to_string(seed) + "}\n");
    return ticks(test, 20);
  };
  const auto first = steps(1);
  EXPECT_EQ(first, steps(1));
  EXPECT_NE(first, steps(2));
  for (std::size_t i = 0; i < first.size(); ++i) {
    EXPECT_GE(first[i], static_cast<std::int64_t>(100 * (i + 1)));
    EXPECT_LE(first[i], static_cast<std::int64_t>(100 * (i + 1) + 50));
  }
}

TEST(Events, OfAProbabilityFireAboutSoOften) {
  test::TestWorld test(event_world("  - {name: a, every: 0.01, probability: 0.3, " + tick));
  // 1000 chances of 0.3: 300 with a standard deviation of 14.5; four of them.
  EXPECT_NEAR(static_cast<double>(ticks(test, 10.005).size()), 300, 58);
}

TEST(Events, ChooseAtRandomByTheirOwnNameWhateverElseHappens) {
  const std::string a =
      "  - {name: a, every: 0.1, do: [{move: {name: ball, places: [[1, 0, 5], [2, 0, 5], [3, 0, 5]], random_yaw: "
      "true}}]}\n";
  const auto places = [&](const std::string& others) {
    test::TestWorld test(event_world(a + others));
    std::vector<double> xs;
    for (int i = 0; i < 30; ++i) {
      test.run_for(0.1);
      xs.push_back(test.world.find_object("ball")->base().X_WB().translation().x());
    }
    return xs;
  };
  const auto alone = places("");
  EXPECT_EQ(alone, places("  - {name: b, every: 0.01, do: [{log: b}], probability: 0.5}\n"));
  EXPECT_THAT(alone, testing::Contains(1));
  EXPECT_THAT(alone, testing::Contains(2));
  EXPECT_THAT(alone, testing::Contains(3));
}

TEST(Events, OfWeightZeroAreNeverChosen) {
  test::TestWorld test(event_world(
      "  - name: a\n    every: 0.01\n    do:\n      - one_of:\n          choices: [[{publish: {channel: tick, type: "
      "shoal.utime_t}}], [{end: no}]]\n          weights: [1, 0]\n"));
  EXPECT_EQ(ticks(test, 1.005).size(), 100u);
  EXPECT_FALSE(test.world.ended());
}

TEST(Events, TriggerEachOtherInTheSameStep) {
  test::TestWorld test(
      event_world("  - {name: a, at: 0.1, do: [{trigger: b}]}\n  - {name: b, do: [{log: b}]}\n"
                  "  - {name: c, when: event b fires, " +
                  tick));
  EXPECT_THAT(ticks(test, 1), ElementsAre(10));
}

TEST(Events, ThatTriggerEachOtherForEverAreCutAndTheRunContinues) {
  test::TestWorld test(
      event_world("  - {name: a, at: 0.1, do: [{trigger: b}]}\n"
                  "  - {name: b, do: [{trigger: a}, {trigger: b}, {trigger: b}]}\n"
                  "  - {name: late, at: 0.2, " +
                  tick));
  // `a` has fired its one time; `b` fires itself twice: 100 deep, and no more than 1000 in all.
  EXPECT_THAT(ticks(test, 1), ElementsAre(20));
  EXPECT_EQ(test.world.counts().bad_messages, 1);
}

TEST(Events, AddMoveAndRemoveObjects) {
  test::TestWorld test(
      event_world("  - {name: a, at: 0.1, do: [{add: crate}, {add: {object: {name: barrel, position_m: [1, 1, 1], "
                  "parts: [{shape: sphere, mass_kg: 2}]}}}]}\n"
                  "  - {name: b, at: 0.2, do: [{move: {name: crate, position_m: [4, 4, 4]}}, {remove: barrel}, "
                  "{remove: barrel}, {add: crate}]}\n"));
  EXPECT_EQ(test.world.find_object("crate"), nullptr);
  test.run_for(0.15);
  ASSERT_NE(test.world.find_object("crate"), nullptr);
  EXPECT_EQ(test.world.find_object("crate")->base().X_WB().translation().x(), 9);
  EXPECT_NE(test.world.find_object("barrel"), nullptr);
  test.run_for(0.15);
  EXPECT_EQ(test.world.find_object("crate")->base().X_WB().translation(), sim::Vector3d(4, 4, 4));
  EXPECT_EQ(test.world.find_object("barrel"), nullptr);
  // The second removal and the second crate fail, are reported and change nothing.
  EXPECT_EQ(test.world.counts().bad_messages, 2);
}

TEST(Events, ChangeGravity) {
  test::TestWorld test(event_world("  - {name: a, at: 1, do: [{gravity_mps2: 2}]}\n"));
  test.run_for(1);
  EXPECT_EQ(test.world.find_object("ball")->base().v_WB_W().z(), 0);
  test.run_for(1);
  EXPECT_NEAR(test.world.find_object("ball")->base().v_WB_W().z(), -2, 1e-9);
}

TEST(Events, ReceiveMessagesAndSeeTouches) {
  test::TestWorld received(event_world("  - {name: a, when: message on bell, " + tick));
  const auto mailbox = received.bus.open_mailbox("tick", 10);
  received.run_for(0.1);
  EXPECT_FALSE(mailbox->take());
  received.bus.publish("bell", {}, received.world.now());
  received.world.step();
  EXPECT_TRUE(mailbox->take());

  // The ball is 0.1 m above the table and falls: sqrt(2 * 0.1 / 9.80665) = 0.1428 s.
  test::TestWorld touch(
      event_world("  - {name: g, at: 0, do: [{gravity_mps2: 9.80665}]}\n  - {name: a, when: ball touches any, " + tick,
                  "  - {name: table, fixed: true, position_m: [0, 0, 4.3], parts: [{shape: box}]}\n"));
  const auto steps = ticks(touch, 1);
  ASSERT_FALSE(steps.empty());
  EXPECT_NEAR(static_cast<double>(steps.front()), 15, 1.5);
}

TEST(Events, EndTheRun) {
  test::TestWorld test(event_world("  - {name: a, at: 0.5, do: [{end: {reason: 'too late', passed: false}}]}\n"));
  test.run_for(1);
  ASSERT_TRUE(test.world.ended());
  EXPECT_EQ(test.world.ended()->text, "too late");
  EXPECT_FALSE(test.world.ended()->passed);
}

// With a vehicle

const std::string drive =
    "        - {name: drive, type: differential_drive, left_joint: left, right_joint: right,\n"
    "           wheel_radius_m: 0.1, track_m: 0.5, max_torque_Nm: 20}\n";

const std::string go =
    "  - {name: go, at: 0, do: [{publish: {channel: r1.drive.cmd, type: shoal.twist_command_t, "
    "value: {forward_mps: 1}}}]}\n";

TEST(Events, DriveARoverThroughAZoneWithARecord) {
  test::TestWorld test(test::rover_world(drive) +
                       "zones:\n  - {name: slow, shape: box, position_m: [2, 0, 0], size_m: [2, 2, 2], "
                       "speed_limit_mps: 0.5}\n  - {name: goal, shape: sphere, position_m: [4, 0, 0], radius_m: 0.5, "
                       "finish: true}\nevents:\n" +
                       go + "  - {name: a, when: r1 inside slow, times: 1, do: [{log: here}]}\n" +
                       "  - {name: b, when: r1 faster than 0.5, " + tick);
  const auto mailbox = test.bus.open_mailbox("tick", 1000);
  test.run_for(6);
  EXPECT_TRUE(mailbox->take());
  EXPECT_FALSE(mailbox->take());  // it became faster once
  const sim::ZoneRecord& record = test.world.zone_records().at("r1");
  // 2 m at 1 m/s; and the goal begins at 3.5 m, which it reaches after a start of less than a second.
  EXPECT_NEAR(record.speeding_s, 2, 0.05);
  ASSERT_TRUE(record.finish_s);
  EXPECT_NEAR(*record.finish_s, 3.5, 1.0);
}

TEST(Events, PublishWithTheTimeWhenNoneIsGiven) {
  test::TestWorld test(
      event_world("  - {name: a, at: 0.25, do: [{publish: {channel: cmd, type: shoal.twist_command_t, value: "
                  "{forward_mps: 1.5, turn_radps: -0.5}}}, {publish: {channel: cmd, type: shoal.twist_command_t, "
                  "value: {utime: 7}}}]}\n"));
  test::Listener<shoal::twist_command_t> commands(test, "cmd");
  test.run_for(1);
  const auto all = commands.take_all();
  ASSERT_EQ(all.size(), 2u);
  EXPECT_EQ(all[0].utime, test.world.epoch_us() + 250000);
  EXPECT_EQ(all[0].forward_mps, 1.5);
  EXPECT_EQ(all[0].turn_radps, -0.5);
  EXPECT_EQ(all[1].utime, 7);
}

TEST(Events, SetFaultsAndClearThem) {
  test::TestWorld test(test::rover_world("        - {name: gps, type: gps, rate_hz: 10, phase_s: 0.05}\n") +
                       "events:\n  - {name: a, at: 1, do: [{fault: {device: r1/gps, kind: silent}}]}\n"
                       "  - {name: b, at: 2, do: [{clear_fault: r1/gps}]}\n");
  test::Listener<shoal::gps_data_t> fixes(test, "r1.gps");
  std::vector<std::size_t> counts;
  for (int i = 0; i < 3; ++i) {
    test.run_for(1);
    counts.push_back(fixes.take_all().size());
  }
  EXPECT_THAT(counts, ElementsAre(10, 0, 10));
}

TEST(Events, SetTheRangeOfALidarAgainAndAgain) {
  test::TestWorld test(
      test::rover_world("        - {name: lidar, type: lidar, beams: 3, fov_deg: 1, range_max_m: 10, rate_hz: 10, "
                        "position_m: [0, 0, 0.4]}\n") +
      "events:\n  - {name: a, at: 1, do: [{set: {device: r1/lidar, values: {range_max_m: 4}}}]}\n"
      "  - {name: b, at: 2, do: [{set: {device: r1/lidar, values: {rate_hz: 20}}}]}\n");
  test::Listener<shoal::planar_lidar_t> scans(test, "r1.lidar");
  test.run_for(1);
  EXPECT_EQ(scans.last().ranges[1], 10);
  test.run_for(1);
  EXPECT_EQ(scans.last().ranges[1], 4);
  test.run_for(1);
  const auto all = scans.take_all();
  EXPECT_EQ(all.back().ranges[1], 4);  // the first change outlives the second
  EXPECT_NEAR(static_cast<double>(all.size()), 20, 1);
}

TEST(Zones, DenyGpsUntilItHasBeenAcquiredAgain) {
  test::TestWorld test(test::rover_world("        - {name: gps, type: gps, rate_hz: 10, phase_s: 0.05, "
                                         "reacquisition_s: 0.5}\n") +
                       "zones:\n  - {name: roof, shape: sphere, radius_m: 2, gps_denied: true}\n"
                       "events:\n  - {name: a, at: 1, do: [{move: {name: r1, position_m: [5, 0, 0]}}]}\n");
  test::Listener<shoal::gps_data_t> fixes(test, "r1.gps");
  test.run_for(1);
  for (const auto& fix : fixes.take_all()) EXPECT_EQ(fix.gps_lock, 0);
  test.run_for(1);
  const auto all = fixes.take_all();
  ASSERT_EQ(all.size(), 10u);
  // Denied last at 0.95 s, so that there is no fix up to 1.45 s: that is five samples from 1.05 s.
  for (std::size_t i = 0; i < all.size(); ++i) EXPECT_EQ(all[i].gps_lock, i < 5 ? 0 : 1) << i;
}

TEST(Zones, DenyRadioToSenderAndReceiver) {
  const std::string model =
      "    model: {shoal: 1, vehicle: v, bodies: [{name: b, parts: [{shape: sphere, radius_m: 0.1, "
      "mass_kg: 1}]}], devices: [{name: modem, type: modem, rate_hz: 100}]}\n";
  for (const double zone_x : {0.0, 5.0, 20.0}) {
    test::TestWorld test("shoal: 1\nphysics: {gravity_mps2: 0}\nvehicles:\n  - name: a\n" + model +
                         "  - name: b\n    position_m: [5, 0, 0]\n" + model +
                         "zones:\n  - {name: cave, shape: sphere, radius_m: 1, radio_denied: true, position_m: [" +
                         std::to_string(zone_x) + ", 0, 0]}\n");
    test::Listener<shoal::modem_received_t> received(test, "b.modem");
    shoal::modem_send_t message{};
    message.size = 3;
    message.data = {1, 2, 3};
    test.send("a.modem.cmd", message);
    test.run_for(1);
    EXPECT_EQ(received.take_all().size(), zone_x == 20.0 ? 1u : 0u) << zone_x;
  }
}

// Actions from outside

sim::ConfigNode yaml(const std::string& text) {
  sim::Diagnostics diagnostics;
  sim::ConfigNode node = sim::parse_config_text(text, "request", diagnostics);
  diagnostics.throw_if_any();
  return node;
}

std::string failure(sim::World& world, const std::string& action) {
  try {
    world.editor().run_action(yaml(action));
  } catch (const sim::ConfigError& error) {
    return error.what();
  }
  return "none";
}

TEST(RunAction, DoesInAWorldWithoutEventsWhatAnEventDoes) {
  test::TestWorld test(test::rover_world(drive));
  test.world.editor().run_action(
      yaml("{add: {object: {name: post, fixed: true, position_m: [3, 0, 0], parts: [{shape: box}]}}}"));
  EXPECT_NE(test.world.find_object("post"), nullptr);
  test.world.editor().run_action(yaml("[{move: {name: r1, position_m: [1, 1, 0.1]}}, {remove: post}]"));
  EXPECT_EQ(test.world.find_object("post"), nullptr);
  EXPECT_NEAR(test.world.vehicles()[0]->X_WV().translation().x(), 1, 1e-12);
}

TEST(RunAction, SaysWhatIsWrongInOneLine) {
  test::TestWorld test(test::rover_world(drive));
  EXPECT_EQ(
      failure(test.world, "{move: {name: r2, position_m: [0, 0, 0]}}"),
      "request:1:15: action 1: move: 'name' names no vehicle or object 'r2'; known vehicles or objects: ground, r1");
  EXPECT_EQ(failure(test.world, "{fault: {device: r1/drve, kind: dead}}"),
            "request:1:1: action 1: there is no device 'r1/drve'; devices are named VEHICLE/DEVICE; vehicle 'r1' has: "
            "drive");
  EXPECT_THAT(failure(test.world, "{dance: r1}"),
              testing::HasSubstr("unknown action 'dance'; known actions: actor, add"));
  EXPECT_THAT(failure(test.world, "{mve: r1}"), testing::HasSubstr("; did you mean 'move'?"));
  EXPECT_THAT(failure(test.world, "{set: {device: r1/drive, values: {body: x}}}"),
              testing::HasSubstr("'body' cannot change while the device runs"));
  EXPECT_THAT(failure(test.world, "{publish: {channel: x, type: shoal.twist_command_t, value: {forward: 1}}}"),
              testing::HasSubstr("shoal.twist_command_t: unknown member 'forward'"));
  EXPECT_THAT(failure(test.world, "{publish: {channel: r1.drive.cmd, type: shoal.gps_data_t}}"),
              testing::AllOf(testing::HasSubstr("device 'r1/drive' takes shoal.twist_command_t"),
                             testing::HasSubstr("on 'r1.drive.cmd', not 'shoal.gps_data_t'")));
}

TEST(World, WithEverythingOnHasTheSameHashesTwice) {
  const std::string text =
      test::rover_world(
          drive + "        - {name: gps, type: gps, rate_hz: 10}\n",
          "  - {name: cart, parts: [{shape: box, size_m: [1, 1, 1]}]}\n"
          "  - {name: crate, present: false, position_m: [0, 4, 1], parts: [{shape: box, mass_kg: 1}]}\n") +
      R"(
zones:
  - {name: slow, shape: cylinder, position_m: [1, 0, 0], radius_m: 1, height_m: 3, speed_limit_mps: 0.2, gps_denied: true}
actors:
  - {name: ride, object: cart, path: spline, points: [[0, 3, 0.6], [4, 3, 0.6], [4, 6, 0.6]], speed_mps: 2}
events:
)" + go +
      R"(
  - {name: come, every: 0.5, jitter_s: 0.2, probability: 0.6, do: [{add: {object: crate, area_m: [1, 1, 0], random_yaw: true}}]}
  - {name: pass, every: 0.7, delay_s: 0.1, do: [{remove: crate}]}
  - {name: hit, when: cart touches any, do: [{log: hit}]}
  - {name: fail, when: r1 enters slow, do: [{one_of: [[{fault: {device: r1/gps, kind: silent}}], [{fault: {device: r1/gps, kind: stuck}}]]}]}
run: {seed: 5}
)";
  const auto hashes = [&] {
    test::TestWorld test(text);
    std::vector<std::uint64_t> all;
    for (int i = 0; i < 4000; ++i) {
      test.world.step();
      all.push_back(test.world.state().hash());
    }
    return all;
  };
  EXPECT_EQ(hashes(), hashes());
}

}  // namespace
