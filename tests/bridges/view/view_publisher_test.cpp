// SPDX-License-Identifier: BSD-3-Clause
#include "bridges/view/view_publisher.hpp"

#include <gmock/gmock.h>

#include <array>
#include <memory>
#include <nlohmann/json.hpp>

#include "shoal/sim_asset_t.hpp"
#include "shoal/sim_scene_t.hpp"
#include "sim/world/world_state.hpp"
#include "tests/bridges/lcm/lcm_test_support.hpp"
#include "tests/bridges/view/viewed_world.hpp"
#include "tests/devices/comms/modem_fixture.hpp"

namespace {

using namespace viewed_world;

TEST(ViewPublisher, BodiesAreTheMovableOnesOfTheSceneAtTheirPoses) {
  ViewedWorld viewed(rover_and_ball);
  const Json scene = viewed.last_scene();
  viewed.run_for(0.1);
  const shoal::sim_bodies_t bodies = viewed.bodies.last();
  std::vector<int> movable;
  for (const Json& body : scene["bodies"])
    if (!body["fixed"].get<bool>()) movable.push_back(body["id"]);
  EXPECT_EQ(bodies.body, std::vector<std::int32_t>(movable.begin(), movable.end()));
  EXPECT_EQ(bodies.revision, scene["revision"]);
  for (std::size_t i = 0; i < movable.size(); ++i) {
    const sim::Vector3d p_W =
        viewed.test.world.physics().bodies()[static_cast<std::size_t>(movable[i])]->X_WB().translation();
    for (int axis = 0; axis < 3; ++axis) EXPECT_EQ(bodies.position_m[i][static_cast<std::size_t>(axis)], p_W[axis]);
  }
}

TEST(ViewPublisher, PublishesBodiesAtTheirRate) {
  ViewedWorld viewed(rover_and_ball + "view: {bodies_rate_hz: 20}\n");
  viewed.run_for(1);
  EXPECT_EQ(viewed.bodies.take_all().size(), 21u);
}

TEST(ViewPublisher, PublishesNothingThatIsSwitchedOff) {
  ViewedWorld viewed(rover_and_ball +
                     "view: {scene: false, bodies_rate_hz: never, sounds: false, events: false}\n"
                     "events: [{name: e, at: 0.05, do: [{log: now}]}]\n");
  viewed.run_for(0.2);
  EXPECT_TRUE(viewed.scenes.take_all().empty());
  EXPECT_TRUE(viewed.bodies.take_all().empty());
  EXPECT_TRUE(viewed.events.take_all().empty());
}

TEST(ViewPublisher, ANewObjectMakesAnotherRevision) {
  ViewedWorld viewed(
      rover_and_ball +
      "events: [{name: more, at: 1, do: [{add: {object: {name: box, position_m: [5, 0, 1], parts: [{shape: box, "
      "mass_kg: 1}]}}}]}]\n");
  viewed.run_for(0.9);
  const std::vector<shoal::sim_scene_t> first = viewed.scenes.take_all();
  ASSERT_EQ(first.size(), 1u);
  viewed.run_for(0.3);
  const shoal::sim_scene_t second = viewed.scenes.last();
  EXPECT_GT(second.revision, first.front().revision);
  EXPECT_EQ(viewed.bodies.last().count, 5);
  std::vector<std::string> kinds;
  for (const shoal::sim_event_t& event : viewed.events.take_all()) kinds.push_back(event.kind + " " + event.who);
  EXPECT_THAT(kinds, testing::ElementsAre("event more", "added box"));
}

/// A viewer that starts later asks for it.
TEST(ViewPublisher, TheSceneAndItsAssetsComeAgainOnRequest) {
  ViewedWorld viewed(
      "shoal: 1\nobjects: [{name: hill, fixed: true, parts: [{shape: terrain, terrain: {source: slope, "
      "angle_deg: 10, cell_m: 1, size_m: [4, 2]}}]}]\n");
  const std::vector<shoal::sim_asset_t> assets = viewed.assets.take_all();
  ASSERT_EQ(assets.size(), 1u);
  EXPECT_EQ(viewed.last_scene()["bodies"][0]["parts"][0]["asset"], assets.front().hash);
  EXPECT_EQ(assets.front().size, 28 + 4 * 5 * 3);  // seven words, 5 x 3 heights
  viewed.run_for(0.1);
  EXPECT_TRUE(viewed.scenes.take_all().empty());
  viewed.view.request_scene();
  viewed.run_for(0.1);
  EXPECT_EQ(viewed.scenes.take_all().size(), 1u);
  EXPECT_EQ(viewed.assets.take_all().size(), 1u);
}

/// A logger may start at any time.
TEST(ViewPublisher, TheSceneComesAgainAfterTenSeconds) {
  ViewedWorld viewed(rover_and_ball);
  const std::string first = viewed.scenes.take_all().at(0).scene;
  viewed.run_for(9.9);
  EXPECT_TRUE(viewed.scenes.take_all().empty());
  viewed.run_for(0.2);
  const std::vector<shoal::sim_scene_t> again = viewed.scenes.take_all();
  ASSERT_EQ(again.size(), 1u);
  EXPECT_EQ(again[0].scene, first) << "by which a viewer knows that it has it";
  EXPECT_EQ(again[0].utime, viewed.test.world.epoch_us() + 10'000'000);
}

TEST(ViewPublisher, TheSceneIsMadeAnewWhenTheTimeGoesBack) {
  ViewedWorld viewed(
      "shoal: 1\nphysics: {step_s: 0.01}\nobjects: [{name: gate, fixed: true, position_m: [1, 0, 0], parts: [{shape: "
      "box}]}]\nevents: [{name: open, at: 15, do: [{move: {name: gate, position_m: [9, 0, 0]}}]}]\n");
  viewed.run_for(13);
  const sim::Bytes before = viewed.test.world.state().snapshot();
  viewed.run_for(5);
  const std::vector<shoal::sim_scene_t> scenes = viewed.scenes.take_all();
  ASSERT_NE(scenes.back().scene, scenes.front().scene) << "the gate has moved";
  viewed.test.world.state().restore(before);
  viewed.view.discard();
  viewed.view.set_branch(1);
  viewed.run_for(0.02);
  const std::vector<shoal::sim_scene_t> again = viewed.scenes.take_all();
  ASSERT_EQ(again.size(), 1u);
  EXPECT_NE(again[0].scene.find("\"pose\":[1.0,"), std::string::npos) << again[0].scene;
}

TEST(ViewPublisher, ALargeSceneAndItsAssetsComeAgainMoreRarely) {
  ViewedWorld viewed(
      "shoal: 1\nphysics: {step_s: 0.01}\nobjects: [{name: hill, fixed: true, parts: [{shape: terrain, terrain: "
      "{source: slope, angle_deg: 10, cell_m: 1, size_m: [200, 100]}}]}]\n");
  const std::size_t bytes = viewed.scenes.take_all().at(0).scene.size() + viewed.assets.take_all().at(0).data.size();
  const double after_s = static_cast<double>(bytes) / 2000;
  ASSERT_GT(after_s, 40);  // 201 x 101 heights of 4 bytes
  viewed.run_for(after_s - 0.1);
  EXPECT_TRUE(viewed.scenes.take_all().empty());
  viewed.run_for(0.2);
  EXPECT_EQ(viewed.scenes.take_all().size(), 1u);
  EXPECT_EQ(viewed.assets.take_all().size(), 1u);
}

TEST(ViewPublisher, FaultsAreEvents) {
  ViewedWorld viewed(rover_and_ball +
                     "events: [{name: dark, at: 0.1, do: [{fault: {device: r1/lidar, kind: silent}}]}]\n");
  viewed.run_for(0.2);
  const std::vector<shoal::sim_event_t> events = viewed.events.take_all();
  ASSERT_EQ(events.size(), 2u);
  EXPECT_EQ(events[1].kind, "fault");
  EXPECT_EQ(events[1].who, "r1/lidar");
  EXPECT_EQ(events[1].text, "silent");
}

/// Three modems in a row, 750 m apart: the first sends, and the middle one begins to send before the signal arrives.
const std::string three_modems = test::modem_sea({{"a", "[0, 0, -50]", "{name: modem, type: acoustic_modem}", ""},
                                                  {"b", "[750, 0, -50]", "{name: modem, type: acoustic_modem}", ""},
                                                  {"c", "[1500, 0, -50]", "{name: modem, type: acoustic_modem}", ""}});

TEST(ViewPublisher, ASoundHasItsResultAtEachReceiver) {
  ViewedWorld viewed(three_modems);
  const shoal::modem_send_t send = test::bytes_to("four");
  viewed.test.send("a.modem.cmd", send);
  viewed.run_for(0.3);
  viewed.test.send("b.modem.cmd", send);
  viewed.run_for(20);
  const std::vector<shoal::sim_sound_t> sounds = viewed.sounds.take_all();
  ASSERT_EQ(sounds.size(), 2u);
  EXPECT_EQ(sounds[0].source, "a/modem");
  EXPECT_EQ(sounds[0].kind, "message");
  EXPECT_NEAR(sounds[0].sound_speed_mps, 1500, 0.1);
  std::map<std::string, std::string> outcome;
  for (const shoal::sim_sound_arrival_t& arrival : viewed.arrivals.take_all()) {
    outcome[arrival.source + ">" + arrival.receiver] = arrival.outcome;
    const double distance_m = std::abs(arrival.position_m[0] - (arrival.source == "a/modem" ? 0 : 750));
    EXPECT_NEAR(arrival.travel_time_s, distance_m / 1500, 1e-3) << arrival.source << arrival.receiver;
  }
  EXPECT_EQ(outcome["a/modem>b/modem"], "half_duplex");
  EXPECT_EQ(outcome["b/modem>a/modem"], "half_duplex") << "a still sends when the sound of b arrives";
  EXPECT_EQ(outcome.size(), 4u);
}

TEST(ViewPublisher, DoesNotChangeTheRun) {
  const auto hash_of = [](bool viewed_too) {
    test::TestWorld test(three_modems);
    std::optional<bridges::ViewPublisher> view;
    if (viewed_too) view.emplace(test.bus, test.world, bridges::ViewPublisher::FillScores(), [] { return true; });
    test.send("a.modem.cmd", test::bytes_to("four"));
    for (int i = 0; i < 500; ++i) {
      test.world.step();
      if (view) view->after_step();
    }
    return test.world.state().run_hash();
  };
  EXPECT_EQ(hash_of(true), hash_of(false));
}

/// The publisher lies in memory that was used before, as on the stack of a program.
TEST(ViewPublisher, PublishesNoScoresWhenThereAreNone) {
  test::TestWorld test(rover_and_ball);
  test::Listener<shoal::sim_scores_t> scores(test, "sim.scores");
  struct Destroy {
    void operator()(bridges::ViewPublisher* view) const { view->~ViewPublisher(); }
  };
  alignas(bridges::ViewPublisher) std::array<unsigned char, sizeof(bridges::ViewPublisher)> used;
  used.fill(0x55);
  const std::unique_ptr<bridges::ViewPublisher, Destroy> view(new (used.data()) bridges::ViewPublisher(
      test.bus, test.world, [](shoal::sim_scores_t&) {}, [] { return true; }));
  view->after_step();
  EXPECT_TRUE(scores.take_all().empty());
}

TEST(ViewPublisher, MakesNothingWhileNothingIsObserved) {
  test::TestWorld test(rover_and_ball);
  bridges::ViewPublisher view(test.bus, test.world, {}, [] { return false; });
  test::Listener<shoal::sim_scene_t> scenes(test, "sim.scene");
  view.after_step();
  EXPECT_TRUE(scenes.take_all().empty());
}

}  // namespace
