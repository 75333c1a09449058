// SPDX-License-Identifier: BSD-3-Clause
#include "experiment/score/first_contacts.hpp"

#include <gmock/gmock.h>

#include "shoal/twist_command_t.hpp"
#include "sim/vehicle/vehicle.hpp"
#include "sim/world/world_editor.hpp"
#include "sim/world/world_state.hpp"
#include "tests/devices/world_fixture.hpp"

namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

/// A world whose contacts are watched as in a run.
struct WatchedWorld {
  explicit WatchedWorld(const std::string& yaml)
      : test(yaml), contacts(test.world, [this](const std::string& line) { lines.push_back(line); }) {}
  void run_for(double time_s) {
    const sim::Time end = test.world.now() + sim::from_seconds(time_s);
    while (test.world.now() < end) {
      test.world.step();
      contacts.after_step();
    }
  }
  void push(const std::string& vehicle, double speed_mps) {
    for (const auto& [name, body] : test.world.find_vehicle(vehicle)->bodies())
      body->set_velocity_W({speed_mps, 0, 0}, sim::Vector3d::Zero());
  }
  std::vector<std::string> pairs() const {
    std::vector<std::string> all;
    for (const auto& each : contacts.all())
      all.push_back(each.first + "-" + each.second + " " + std::to_string(each.count));
    return all;
  }

  test::TestWorld test;
  experiment::FirstContacts contacts;
  std::vector<std::string> lines;
};

/// Balls of 0.5 m radius in free space along x, `count` of them, `apart_m` from middle to middle; a rock at x = -3.
std::string balls(int count, double apart_m) {
  std::string yaml =
      "shoal: 1\nphysics: {step_s: 0.01, gravity_mps2: 0}\ncontacts: [{between: [any, any], restitution: 1, friction: "
      "0, "
      "restitution_velocity_mps: 0.01}]\n"
      "objects: [{name: rock, fixed: true, position_m: [-3, 0, 0], parts: [{shape: box}]}]\nvehicles:\n";
  for (int i = 0; i < count; ++i)
    yaml +=
        "  - {name: v" + std::to_string(i + 1) + ", position_m: [" + std::to_string(i * apart_m) +
        ", 0, 0], model: {shoal: 1, vehicle: ball, bodies: [{name: hull, parts: [{shape: sphere, mass_kg: 1}]}]}}\n";
  return yaml;
}

TEST(FirstContacts, ReportAVehicleThatHitsAnObject) {
  WatchedWorld watched(balls(1, 0));
  watched.push("v1", -1);  // the ball's edge is at -0.5 m, the rock's at -2.5 m
  watched.run_for(3);
  EXPECT_THAT(watched.lines, ElementsAre("2.0 s: v1 hits rock"));
  ASSERT_THAT(watched.pairs(), ElementsAre("v1-rock 1"));
  EXPECT_NEAR(watched.contacts.all().front().first_s, 2.0, 0.0201);  // a step before and after
}

TEST(FirstContacts, CountContactsThatBeginAnew) {
  WatchedWorld watched(balls(2, 2));
  for (int i = 0; i < 3; ++i) {
    watched.push("v1", 2);
    watched.run_for(1);
    watched.test.world.editor().move_vehicle("v1", sim::Pose::Identity());
    watched.test.world.editor().move_vehicle("v2", sim::make_pose({2, 0, 0}, sim::Vector3d::Zero()));
  }
  EXPECT_THAT(watched.pairs(), ElementsAre("v1-v2 3"));
  EXPECT_THAT(watched.lines, ElementsAre("0.5 s: v1 hits v2"));
}

TEST(FirstContacts, LeaveOutWheelsOnTheFloor) {
  const std::string drive = "        - {name: drive, type: differential_drive, left_joint: left, right_joint: right}\n";
  const std::string floor =
      "  - {name: floor, fixed: true, position_m: [0, 0, -0.5], parts: [{shape: box, size_m: [20, 20, 1]}]}\n"
      "  - {name: crate, fixed: true, position_m: [2, 0, 0.5], parts: [{shape: box, size_m: [1, 1, 1]}]}\n";
  WatchedWorld watched(test::rover_world(drive, floor));
  watched.run_for(1);
  EXPECT_THAT(watched.pairs(), IsEmpty());
  shoal::twist_command_t command{};
  command.forward_mps = 0.5;
  watched.test.send("r1.drive.cmd", command);
  watched.run_for(5);
  EXPECT_THAT(watched.pairs(), ElementsAre(HasSubstr("r1-crate")));
}

TEST(FirstContacts, LeaveOutWhatAVehicleStandsOn) {
  std::string yaml = balls(1, 0);
  yaml.replace(yaml.find("gravity_mps2: 0"), 15, "gravity_mps2: 9.8");
  yaml.replace(yaml.find("restitution: 1"), 14, "restitution: 0");
  yaml.replace(yaml.find("[-3, 0, 0]"), 10, "[0, 0, -1]");
  WatchedWorld watched(yaml);
  watched.run_for(1);
  EXPECT_THAT(watched.pairs(), IsEmpty());
}

/// A heavy ball of 0.5 m radius in water over a plane at 10 m, at a depth of its middle.
std::string sinking_ball(double depth_m) {
  return "shoal: 1\nphysics: {step_s: 0.01}\nmedium: {water: {}}\nobjects: [{name: bottom, fixed: true, position_m: "
         "[0, 0, -10], parts: [{shape: plane}]}]\nvehicles: [{name: auv, position_m: [0, 0, " +
         std::to_string(-depth_m) +
         "], model: {shoal: 1, vehicle: ball, bodies: [{name: hull, parts: [{shape: sphere, mass_kg: 700}]}]}}]\n";
}

TEST(FirstContacts, ReportACraftThatTouchesTheBottom) {
  WatchedWorld sinks(sinking_ball(9));
  sinks.run_for(5);
  ASSERT_THAT(sinks.lines, ElementsAre(HasSubstr(" s: auv hits bottom")));
  EXPECT_THAT(sinks.pairs(), ElementsAre(HasSubstr("auv-bottom")));
  WatchedWorld rests(sinking_ball(9.5));
  rests.run_for(5);
  EXPECT_THAT(rests.pairs(), IsEmpty()) << "it starts on it";
}

TEST(FirstContacts, TakeABodyForACraftOnlyIfItStartsInTheWater) {
  std::string on_land = sinking_ball(-4);
  on_land.replace(on_land.find("[0, 0, -10]"), 11, "[0, 0, 2]");  // it falls 1.5 m
  WatchedWorld falls(on_land);
  falls.run_for(1);
  EXPECT_THAT(falls.pairs(), IsEmpty());
  WatchedWorld sinks(sinking_ball(-0.4));  // 0.1 m of it are in the water
  sinks.run_for(15);
  EXPECT_THAT(sinks.pairs(), ElementsAre(HasSubstr("auv-bottom")));
}

TEST(FirstContacts, GoBackWithTheWorld) {
  WatchedWorld watched(balls(3, 2));
  watched.push("v1", 2);
  watched.run_for(0.3);
  const sim::Bytes world = watched.test.world.state().snapshot();
  auto saver = sim::StateArchive::saver();
  watched.contacts.visit_state(saver);
  saver.end();
  const sim::Bytes before = saver.take_bytes();
  const auto rewinds = [&] {
    watched.test.world.state().restore(world);
    auto restorer = sim::StateArchive::restorer(before);
    watched.contacts.visit_state(restorer);
    restorer.end();
  };
  watched.run_for(3);
  const auto straight = watched.pairs();
  ASSERT_EQ(straight.size(), 2u);  // the first passes its speed on to the second, and that to the third
  rewinds();
  EXPECT_THAT(watched.pairs(), IsEmpty());
  watched.run_for(3);
  EXPECT_EQ(watched.pairs(), straight);
  EXPECT_EQ(watched.lines.size(), 2u) << "what was said is not said again";
}

// What a vehicle stands on is found out in its own first 0.1 s, not in those after a way back.
TEST(FirstContacts, CountAFallThatEndsRightAfterAWayBack) {
  std::string yaml = balls(1, 0);
  yaml.replace(yaml.find("gravity_mps2: 0"), 15, "gravity_mps2: 9.8");
  yaml.replace(yaml.find("restitution: 1"), 14, "restitution: 0");
  yaml.replace(yaml.find("[-3, 0, 0]"), 10, "[0, 0, -2]");  // the ball falls 1 m, for 0.45 s
  WatchedWorld watched(yaml);
  watched.run_for(0.4);
  const sim::Bytes world = watched.test.world.state().snapshot();
  auto saver = sim::StateArchive::saver();
  watched.contacts.visit_state(saver);
  saver.end();
  const sim::Bytes before = saver.take_bytes();
  watched.run_for(0.5);
  const auto straight = watched.pairs();
  EXPECT_THAT(straight, ElementsAre("v1-rock 1"));
  watched.test.world.state().restore(world);
  auto restorer = sim::StateArchive::restorer(before);
  watched.contacts.visit_state(restorer);
  restorer.end();
  watched.run_for(0.5);
  EXPECT_EQ(watched.pairs(), straight);
}

TEST(FirstContacts, DoNotChangeTheRun) {
  const auto hash = [](bool watch) {
    test::TestWorld test(balls(3, 1.2));
    std::unique_ptr<experiment::FirstContacts> contacts;
    if (watch) contacts = std::make_unique<experiment::FirstContacts>(test.world);
    for (const auto& [name, body] : test.world.find_vehicle("v1")->bodies())
      body->set_velocity_W({2, 0.1, 0}, sim::Vector3d::Zero());
    for (int i = 0; i < 300; ++i) {
      test.world.step();
      if (contacts) contacts->after_step();
    }
    return test.world.state().hash();
  };
  EXPECT_EQ(hash(true), hash(false));
}

TEST(FirstContacts, FloodNoTerminal) {
  WatchedWorld watched(balls(40, 1.01));
  watched.push("v1", 20);
  watched.run_for(2);
  EXPECT_EQ(watched.contacts.all().size(), 39u);
  ASSERT_EQ(watched.lines.size(), 21u);
  EXPECT_THAT(watched.lines.back(), HasSubstr("further first contacts are only counted"));
}

TEST(FirstContacts, AreTenLinesAtTheEndAtMost) {
  std::vector<experiment::FirstContacts::Contact> contacts(12, {"auv4", "rock", 105.7, 1, 105.7});
  const std::string text = experiment::contacts_text(contacts);
  EXPECT_EQ(std::count(text.begin(), text.end(), '\n'), 11);
  EXPECT_THAT(text, testing::StartsWith("  auv4 hit rock: 1 contact, first at 105.70 s\n"));
  EXPECT_THAT(text, HasSubstr("  and 2 more pairs hit each other\n"));
  EXPECT_EQ(experiment::contacts_text({}), "");
}

}  // namespace
