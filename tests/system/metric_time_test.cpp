// SPDX-License-Identifier: BSD-3-Clause
#include <gmock/gmock.h>

#include <map>
#include <nlohmann/json.hpp>

#include "sim/world_file/metric_registry.hpp"
#include "tests/system/shoal_program.hpp"

// Every type of metric goes back with its world: by rewind, by restore, into a branch, and with --from.

namespace {

using namespace system_test;

/// A metric of each type.  `figure` changes between 2 and 4 s, and again or not until 6 s.
struct TimeCase {
  std::string keys;
  std::string figure;
};

/// By the word of the type.  A type without an entry fails the test.
const std::map<std::string, std::vector<TimeCase>>& cases() {
  static const std::map<std::string, std::vector<TimeCase>> all{
      {"position_error", {{"vehicle: r1, channel: r1.estimate", "rms_m"}}},
      {"consistency", {{"vehicle: r1, channel: r1.estimate", "nees_mean"}}},
      {"distance", {{"vehicle: r1", "travelled_m"}, {"vehicle: r1, from_s: 1", "travelled_m"}}},
      {"delivery", {{"", "received"}, {"vehicle: r2, device: modem", "received"}}},
      {"bound", {{"vehicle: r1, start_std_m: 0.1", "rms_m"}, {"vehicle: r1, of: alone, from_s: 1", "final_m"}}},
      {"bound_ratio", {{"metric: position_error0, bound: bound0", "ratio"}}},
      {"bytes_per_metre", {{"metric: position_error0, against: far", "bytes_sent"}}},
      {"mission_time",
       {{"when: r1 inside goal", "time_s"},
        {"when: message on r1.hello", "time_s"},
        {"vehicle: r1, position_m: [1.2, 0, 0], radius_m: 0.3", "time_s"}}},
      {"collisions", {{"", "count"}, {"vehicle: r2, with: ball, from_s: 0.5", "first_s"}}},
      {"messages", {{"channel: r1.lidar", "count"}, {"channel: r1.hello", "first_s"}}},
      {"stability",
       {{"vehicle: r2", "carried_share"},
        {"vehicle: r2", "static_min_m"},
        {"vehicle: r1, from_s: 1", "static_mean_m"}}},
      {"separation", {{"", "min_m"}, {"vehicle: r2, from_s: 1", "at_s"}}},
      {"formation_error", {{"vehicle: r2, leader: r1, offset_m: [0, 5]", "rms_m"}}},
      {"trajectory", {{"vehicle: r1, channel: r1.far", "ate_m"}, {"vehicle: r1, channel: r1.far, from_s: 1", "poses"}}},
      {"map", {{"channel: r1.map, height_m: 0.15", "iou"}, {"channel: r1.map, from_s: 1", "maps"}}},
      {"tilt", {{"vehicle: r2", "fell_s"}, {"vehicle: r2", "max_deg"}, {"vehicle: r1, from_s: 1", "pitch_std_deg"}}},
  };
  return all;
}

/// r1 drives, and says where it is; r2 is thrown over and hit by a ball after 3 s.
std::string world_text() {
  std::string text =
      "shoal: 1\nname: timed\nrun: {duration_s: 6, speed: max}\nphysics: {step_s: 0.01}\n"
      "objects:\n  - {name: ground, fixed: true, parts: [{shape: plane}]}\n"
      "  - {name: ball, position_m: [9, 9, 0.5], parts: [{shape: sphere, radius_m: 0.2, mass_kg: 1}]}\n"
      "vehicles:\n  - {name: r1, file: " +
      source("vehicles/rover.yaml") +
      "}\n  - {name: r2, position_m: [4, 5, 0], file: " + source("vehicles/rover.yaml") +
      "}\n"
      "zones: [{name: goal, shape: box, position_m: [2, 0, 0], size_m: [2, 2, 2]}]\n"
      "events:\n"
      "  - {name: go, every: 0.2, do: [{publish: {channel: r1.drive.cmd, type: shoal.twist_command_t, value: "
      "{forward_mps: "
      "0.4}}}]}\n"
      "  - {name: think, every: 0.3, do: [{publish: {channel: r1.estimate, type: shoal.estimate_t, value: "
      "{covariance_m2: [1, 0, 0, 0, 1, 0, 0, 0, 1]}}}]}\n"
      "  - {name: think_far, every: 0.3, do: [{publish: {channel: r1.far, type: shoal.pose_t, value: {pos: [99, 0, "
      "0]}}}]}\n"
      "  - {name: talk, every: 0.7, do: [{publish: {channel: r1.modem.cmd, type: shoal.modem_send_t, value: {data: [1, "
      "2]}}}]}\n"
      "  - {name: draw, every: 0.5, do: [{publish: {channel: r1.map, type: shoal.occupancy_grid_t, value: "
      "{cell_m: 0.25, origin_m: [8.5, 8.5], width: 4, height: 4, ncells: 16, "
      "cells: [100, 100, 100, 100, 100, 100, 100, 100, 100, 100, 100, 100, 100, 100, 100, 100]}}}]}\n"
      "  - {name: hello, at: 3, do: [{publish: {channel: r1.hello, type: shoal.pose_t, value: {}}}]}\n"
      "  - {name: throw, at: 3, do: [{move: {name: r2, position_m: [0, 5, 0.5], rpy_deg: [90, 0, 0]}}, "
      "{move: {name: ball, position_m: [0, 5, 1.5]}}]}\n"
      "metrics:\n  - {name: far, type: position_error, vehicle: r1, channel: r1.far}\n";
  for (const auto& [type, metrics] : cases())
    for (std::size_t i = 0; i < metrics.size(); ++i)
      text += "  - {name: " + type + std::to_string(i) + ", type: " + type +
              (metrics[i].keys.empty() ? "" : ", " + metrics[i].keys) + "}\n";
  return text;
}

nlohmann::json metrics_in(const std::string& directory) {
  const std::string text = text_of_file(directory + "/summary.json");
  return text.empty() ? nlohmann::json() : nlohmann::json::parse(text)["metrics"];
}

class MetricsInTime : public testing::Test {
 protected:
  void SetUp() override { write_file(folder_.file("world.yaml"), world_text()); }

  /// Metrics of a run that no one touches.
  nlohmann::json straight(const std::string& duration_s) {
    const std::string results = folder_.file("straight" + duration_s);
    const Ended ended = run_shoal({"run", folder_.file("world.yaml"), "--bus", "none", "--duration", duration_s,
                                   "--results", results, "--no-plots"});
    EXPECT_EQ(ended.exit_code, 0) << ended.errors;
    return metrics_in(results);
  }

  std::unique_ptr<Program> live(const std::string& results) {
    auto program = std::make_unique<Program>(std::vector<std::string>{
        built("shoal"), "run", folder_.file("world.yaml"), "--paused", "--speed", "max", "--lcm-url", own_url(),
        "--snapshots", folder_.file("snaps"), "--overwrite", "--results", results, "--no-plots"});
    EXPECT_TRUE(await([] { return control({"where", "--timeout", "0.5"}).exit_code == 0; }, timeout));
    return program;
  }

  void run_until(const std::string& time_s) {
    const Ended ended = control({"until", "--value", time_s});
    EXPECT_EQ(ended.exit_code, 0) << ended.errors;
    EXPECT_TRUE(await([] { return control({"where"}).output.find(", paused") != std::string::npos; }, timeout));
  }

  ScratchFolder folder_;
};

/// Names each figure that differs.
void expect_same(const nlohmann::json& got, const nlohmann::json& desired, const std::string& how) {
  ASSERT_TRUE(got.is_object()) << how;
  ASSERT_EQ(got.size(), desired.size()) << how;
  for (const auto& [name, value] : desired.items())
    EXPECT_EQ(got.value(name, nlohmann::json("absent")), value) << how << ": " << name;
}

TEST_F(MetricsInTime, OfEveryTypeGoBackWithTheWorld) {
  for (const std::string& type : sim::MetricRegistry::instance().words())
    ASSERT_TRUE(cases().contains(type)) << "metric type '" << type << "' needs a case here: does it go back?";
  const auto at2 = straight("2"), at4 = straight("4"), at6 = straight("6");
  for (const auto& [type, metrics] : cases())
    for (std::size_t i = 0; i < metrics.size(); ++i) {
      const std::string name = type + std::to_string(i) + "." + metrics[i].figure;
      ASSERT_TRUE(at2.contains(name)) << name;
      EXPECT_NE(at2[name], at4[name]) << name << " shows nothing: it is the same at 2 s and at 4 s";
    }

  // Back, and not on: what came after 2 s has not happened.
  for (const std::string distance : {"rewind", "restore"}) {
    const std::string results = folder_.file(distance + "_2");
    const auto program = live(results);
    run_until("2");
    EXPECT_EQ(control({"snapshot", "two"}).exit_code, 0);
    run_until("4");
    const Ended back = distance == "rewind" ? control({"rewind", "--value", "2"}) : control({"restore", "two"});
    EXPECT_EQ(back.exit_code, 0) << back.errors;
    control({"quit"});
    EXPECT_EQ(program->wait(), 0) << program->errors();
    expect_same(metrics_in(results), at2, distance + " to 2 s");
    expect_same(metrics_in(results + "/branch0"), at4, distance + ": the branch that was left");
  }
  // Back, and on to the end.
  for (const std::string distance : {"rewind", "restore"}) {
    const std::string results = folder_.file(distance + "_6");
    const auto program = live(results);
    run_until("4");
    const Ended back = distance == "rewind" ? control({"rewind", "--value", "2"}) : control({"restore", "two"});
    EXPECT_EQ(back.exit_code, 0) << back.errors;
    EXPECT_EQ(control({"resume"}).exit_code, 0);
    EXPECT_EQ(program->wait(), 0) << program->errors();
    expect_same(metrics_in(results), at6, distance + " and on to 6 s");
  }
  for (const std::string duration_s : {"2", "4", "6"}) {
    const std::string results = folder_.file("from_" + duration_s);
    const Ended ended = run_shoal({"run", "--from", folder_.file("snaps/two.snapshot"), "--bus", "none", "--duration",
                                   duration_s, "--results", results, "--no-plots"});
    EXPECT_EQ(ended.exit_code, 0) << ended.errors;
    expect_same(metrics_in(results),
                duration_s == "2"   ? at2
                : duration_s == "4" ? at4
                                    : at6,
                "--from 2 s to " + duration_s + " s");
  }
}

}  // namespace
