// SPDX-License-Identifier: BSD-3-Clause
#include "viewer/log/log_distances.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>
#include <nlohmann/json.hpp>

#include "bridges/log/record_file.hpp"
#include "bridges/view/view_publisher.hpp"
#include "experiment/replay/replay.hpp"
#include "shoal/sim_scene_t.hpp"
#include "tests/experiment/replay/recorded_run.hpp"
#include "tests/scratch_folder.hpp"
#include "viewer/server/log_view.hpp"

namespace {

/// A log of a vehicle without gravity at (1, 2, 3) for three seconds.
struct RestLog {
  explicit RestLog(const std::string& more = "") {
    test::RecordedRun run(
        "shoal: 1\nname: rest\nphysics: {step_s: 0.01, gravity_mps2: 0}\nvehicles: [{name: probe, position_m: "
        "[1, 2, 3], model: {shoal: 1, vehicle: probe, bodies: [{name: hull, parts: [{shape: sphere, mass_kg: "
        "1}]}]}}]\n" +
            more,
        path);
    bridges::ViewPublisher view(run.gate, run.world, {}, [] { return true; });
    view.after_step();
    for (int i = 0; i < 300; ++i) {
      run.world.step();
      view.after_step();
    }
  }
  std::string scene() const {
    bridges::EventLogReader reader(path);
    while (const auto event = reader.next())
      if (event->channel == "sim.scene")
        return shoal::decode<shoal::sim_scene_t>(event->payload, shoal::Finite::required).scene;
    return "";
  }
  test_support::ScratchFolder folder;
  const std::string path = folder.file("run.lcm");
};

nlohmann::json distances(const RestLog& a, const RestLog& b) {
  const viewer::LogIndex index_a(a.path), index_b(b.path);
  viewer::LogDistances distances(a.path, index_a, b.path, index_b, a.scene());
  while (!distances.compute(std::chrono::steady_clock::now() + std::chrono::milliseconds(1))) {
  }
  return nlohmann::json::parse(distances.text(viewer::first_difference(a.path, index_a, b.path, index_b)));
}

/// In the second log the vehicle is put 3 m to the east and 4 m higher after one second.
TEST(LogDistances, AreThoseOfEachVehicleAndTheFirstDifferenceIsMarked) {
  const RestLog a, b("events: [{name: jump, at: 1, do: [{move: {name: probe, position_m: [4, 2, 7]}}]}]\n");
  const nlohmann::json json = distances(a, b);
  EXPECT_EQ(json["op"], "distances");
  ASSERT_EQ(json["vehicles"].size(), 1u);
  EXPECT_EQ(json["vehicles"][0]["name"], "probe");
  const nlohmann::json &t_us = json["t_us"], &distance_m = json["vehicles"][0]["distance_m"];
  ASSERT_EQ(t_us.size(), distance_m.size());
  ASSERT_EQ(t_us.size(), 31u);  // ten poses per second
  EXPECT_LE(t_us.size(), viewer::LogDistances::max_times);
  const auto differs_us = json["differs_us"].get<std::int64_t>();
  EXPECT_EQ(differs_us, 1'100'000);  // the first poses after the jump
  for (std::size_t i = 0; i < t_us.size(); ++i)
    EXPECT_NEAR(distance_m[i].get<double>(), t_us[i].get<std::int64_t>() < differs_us ? 0 : 5, 1e-5) << t_us[i];
  EXPECT_EQ(t_us.front(), 0);
  EXPECT_EQ(t_us.back(), 3'000'000);
}

TEST(LogDistances, AreUnknownWhereALogLacksTheVehicle) {
  const RestLog a, b("events: [{name: gone, at: 2, do: [{remove: {name: probe}}]}]\n");
  const nlohmann::json json = distances(a, b);
  const nlohmann::json& distance_m = json["vehicles"][0]["distance_m"];
  EXPECT_EQ(distance_m.front(), 0);
  EXPECT_TRUE(distance_m.back().is_null());
}

TEST(LogDistances, OfADamagedSceneAreNone) {
  const RestLog a;
  const viewer::LogIndex index(a.path);
  viewer::LogDistances none(a.path, index, a.path, index, "{\"vehicles\": [{\"name\": 3}]}");
  EXPECT_TRUE(none.compute(std::chrono::steady_clock::now()));
  EXPECT_TRUE(nlohmann::json::parse(none.text(std::nullopt))["vehicles"].empty());
}

/// Logs with hashes, as `shoal run` writes them, differ where their hashes do.
class LogDifference : public testing::Test {
 protected:
  static std::string world(double z_m) {
    return "shoal: 1\nrun: {hash_every_steps: 10}\nphysics: {step_s: 0.01}\nobjects: [{name: ball, parts: [{shape: "
           "sphere, mass_kg: 1}], position_m: [0, 0, " +
           std::to_string(z_m) + "]}]\n";
  }
  /// Records a second; `lift_at`: step at which a client moves the ball.
  std::string record(const std::string& name, double z_m, std::int64_t lift_at = -1) {
    test::RecordedRun run(world(z_m), folder_.file(name));
    bridges::ViewPublisher view(run.gate, run.world, {}, [] { return true; });
    view.after_step();
    run.run(100, [&](std::int64_t step) {
      if (step == lift_at) run.request("do", "{move: {name: ball, position_m: [0, 0, 9]}}");
    });
    return folder_.file(name);
  }

  test_support::ScratchFolder folder_;
};

TEST_F(LogDifference, IsTheFirstHashThatDiffers) {
  const std::string a = record("a.lcm", 1), b = record("b.lcm", 1, 52);
  const auto difference = viewer::first_difference(a, viewer::LogIndex(a), b, viewer::LogIndex(b));
  ASSERT_TRUE(difference);
  EXPECT_EQ(difference->by, "sim.hash");
  EXPECT_EQ(difference->step, 60);
  EXPECT_EQ(difference->time_us, 600'000);
}

TEST_F(LogDifference, IsThatOfAReplay) {
  const std::string a = record("a.lcm", 1), b = record("b.lcm", 2);
  const auto difference = viewer::first_difference(a, viewer::LogIndex(a), b, viewer::LogIndex(b));
  ASSERT_TRUE(difference);
  // The log of b in the world of a.
  experiment::ReplayOptions options;
  options.log = b;
  options.world = folder_.file("a.yaml");
  std::ofstream(options.world) << world(1);
  options.quiet = true;
  const experiment::ReplayOutcome replayed = experiment::replay(options);
  ASSERT_TRUE(replayed.first);
  EXPECT_EQ(replayed.first->step, *difference->step);
}

}  // namespace
