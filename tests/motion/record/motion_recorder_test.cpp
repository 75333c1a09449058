// SPDX-License-Identifier: BSD-3-Clause
#include "motion/record/motion_recorder.hpp"

#include <gmock/gmock.h>
#include <unistd.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <numbers>

#include "devices/joint/joint_servo.hpp"
#include "motion/analysis/motion_check.hpp"
#include "motion/analysis/push_trials.hpp"
#include "motion/record/recorded_motion.hpp"
#include "sim/vehicle/mounted_device.hpp"
#include "sim/world_file/vehicle_loader.hpp"
#include "tests/devices/joint/leg_fixture.hpp"
#include "tests/motion/record/recording_studio.hpp"
#include "tests/project_paths.hpp"
#include "tests/scratch_folder.hpp"

namespace {

using namespace recording_studio;

using testing::HasSubstr;

TEST(MotionRecorder, JointsStartInTheSameFrameAndAtOnce) {
  Studio studio;
  auto recorder = studio.recorder();
  record(*recorder, 20, 0, 0);
  const auto set_point = [&](const char* servo) {
    const sim::MountedDevice* device = recorder->stage().world().find_device(std::string("dog/") + servo);
    return dynamic_cast<const devices::JointServo*>(device->actuator())->set_point().position;
  };
  EXPECT_EQ(set_point("hip"), 0);
  const double before_s = recorder->stage().now_s();
  record(*recorder, 1, 1, -1);
  // Within the frame of 8 ms both have moved.
  EXPECT_NEAR(recorder->stage().now_s() - before_s, frame_s, 1e-9);
  EXPECT_GT(set_point("hip"), 0);
  EXPECT_LT(set_point("knee"), 0);
  record(*recorder, 3, 0, 0);
  studio.save(std::move(recorder));
  const auto exact = sim::load_motion(motion::take_path(studio.file)).tracks();
  for (const char* joint : {"hip", "knee"}) {
    const auto keys = track_of(exact, joint).keys;
    const auto moved = std::find_if(keys.begin(), keys.end(), [](const sim::TrackKey& key) { return key.value != 0; });
    EXPECT_NEAR(moved->at_s, 22 * frame_s, 1e-12) << joint;
    EXPECT_NEAR(std::abs(moved->value), frame_s, 1e-12) << joint;
  }
}

TEST(MotionRecorder, EqualVelocitiesGiveAnEqualRecording) {
  std::string first;
  for (int i = 0; i < 2; ++i) {
    Studio studio;
    auto recorder = studio.recorder();
    for (int frame = 0; frame < 200; ++frame)
      recorder->frame(std::vector<double>{std::sin(0.1 * frame), std::cos(0.07 * frame)});
    studio.save(std::move(recorder));
    const std::string text = sim::motion_text(sim::load_motion(studio.file)) +
                             sim::motion_text(sim::load_motion(motion::take_path(studio.file)));
    if (i == 0) first = text;
    EXPECT_EQ(text, first);
  }
}

TEST(MotionRecorder, KeepsTheStopsOfAJointAndTheSpeedOfItsServo) {
  Studio studio;
  auto recorder = studio.recorder();
  record(*recorder, 10, 1000, 0);  // the servo follows at 50 rad/s
  EXPECT_NEAR(recorder->set_points()[0], 10 * 50 * frame_s, 1e-9);
  record(*recorder, 200, 0, 1);  // the knee has a stop at 1 rad
  EXPECT_EQ(recorder->set_points()[1], 1);
  EXPECT_TRUE(recorder->is_at_limit(1));
  EXPECT_FALSE(recorder->is_at_limit(0));
  record(*recorder, 1, 0, -1);
  EXPECT_FALSE(recorder->is_at_limit(1));
}

/// Below -40 deg of the neck of an ERS-7 its head must nod by 5 deg, by Sony; its servo turns 2.65 deg in a frame.
TEST(MotionRecorder, TheNeckOfAnErs7WaitsForItsHead) {
  Studio studio;
  studio.options.stage.world = test_support::source_path("worlds/ers7_studio.yaml");
  auto recorder = studio.recorder();
  const std::size_t neck = recorder->find("neck_tilt").value(), nod = recorder->find("head_nod").value();
  std::vector<double> velocities(recorder->joints().size(), 0.0);
  velocities[neck] = -1.5;
  const double neck_at_start = recorder->set_points()[neck];
  double fastest = 0;
  int waited = 0;
  constexpr int frames = 64;
  for (int i = 0; i < frames; ++i) {
    const double neck_before = recorder->set_points()[neck], nod_before = recorder->set_points()[nod];
    recorder->frame(velocities);
    fastest = std::max(fastest, std::abs(recorder->set_points()[nod] - nod_before));
    waited += recorder->set_points()[neck] == neck_before;
  }
  EXPECT_NEAR(fastest, 5.781 * frame_s, 1e-9);
  EXPECT_EQ(waited, 1);  // the second frame brings the head to 5 deg
  constexpr double degree = std::numbers::pi / 180;
  EXPECT_NEAR(recorder->set_points()[nod], 5 * degree, 1e-9);
  EXPECT_NEAR(recorder->set_points()[neck], neck_at_start - (frames - 1) * 1.5 * frame_s, 1e-9);
  EXPECT_LT(recorder->set_points()[neck], -40 * degree);
  // Motion and take keep all limits of the robot.
  const sim::JointMotion motion = studio.save(std::move(recorder));
  const sim::VehicleConfig ers7 = sim::load_vehicle(test_support::source_path("vehicles/ers7.yaml"), {});
  for (const sim::JointMotion& each : {motion, sim::load_motion(motion::take_path(studio.file))})
    for (const motion::MotionFinding& finding : motion::check_motion(each, ers7)) ADD_FAILURE() << finding.text();
}

TEST(MotionRecorder, GoesBackToTheStateOfThatInstant) {
  Studio studio;
  auto recorder = studio.recorder();
  record(*recorder, 100, 0.5, 0);
  const std::uint64_t hash = recorder->stage().state_hash();
  record(*recorder, 60, 2, -1);
  EXPECT_NEAR(recorder->back(60 * frame_s), 60 * frame_s, 1e-12);
  EXPECT_EQ(recorder->stage().state_hash(), hash);
  EXPECT_NEAR(recorder->set_points()[0], 100 * 0.5 * frame_s, 1e-9);
  record(*recorder, 30, -1, 0);
  const sim::JointMotion motion = studio.save(std::move(recorder));
  EXPECT_NEAR(track_of(motion.tracks(), "hip").value_at(99), (50 - 30) * frame_s, 1e-9);
  EXPECT_NEAR(motion.end_s(), 132 * frame_s, 1e-9);
}

TEST(MotionRecorder, GoesBackNoFurtherThanItsSnapshots) {
  Studio studio;
  studio.options.back_s = 1;
  auto recorder = studio.recorder();
  record(*recorder, 500, 0.1, 0);
  const double went_s = recorder->back(100);
  EXPECT_GE(went_s, 1 - frame_s);
  EXPECT_LE(went_s, 1 + frame_s);
  EXPECT_LE(recorder->back(100), 0.25 + frame_s);  // to the last snapshot before
}

TEST(MotionRecorder, AChangeOfTheWorldIsAPartOfTheMotion) {
  Studio studio;
  auto recorder = studio.recorder();
  record(*recorder, 30, 1, 0);
  sim::Diagnostics diagnostics;
  recorder->change(
      sim::parse_config_text("{add: {object: {name: box, position_m: [3, 0, 1], parts: [{shape: box, "
                             "size_m: [0.1, 0.1, 0.1], mass_kg: 1}]}}}",
                             "here", diagnostics));
  EXPECT_TRUE(diagnostics.ok());
  EXPECT_THROW(recorder->change(sim::parse_config_text("{remove: nothing}", "here", diagnostics)), std::runtime_error);
  record(*recorder, 30, 0, 1);
  // The world is built again from its start.
  recorder->back(50 * frame_s);
  record(*recorder, 10, -1, 0);
  recorder->change(sim::parse_config_text("{set: {device: dog/hip, values: {max_velocity: 3}}}", "here", diagnostics));
  record(*recorder, 30, 0, 1);
  const sim::JointMotion motion = studio.save(std::move(recorder));
  ASSERT_EQ(motion.changes.size(), 1u);
}

TEST(MotionRecorder, ThePushMarginIsThatOfTheFramesAndChangesNothing) {
  Studio studio;
  studio.options.stage.world = test_support::source_path("worlds/ers7_studio.yaml");
  auto recorder = studio.recorder();
  std::vector<double> bend(recorder->joints().size(), 0.0);
  for (const char* knee : {"lf_knee", "rf_knee", "lh_knee", "rh_knee"}) bend[recorder->find(knee).value()] = 1;
  for (int i = 0; i < 60; ++i) recorder->frame(bend);
  const motion::PushMargin margin = recorder->push_margin();
  EXPECT_GT(margin.least_Ns(), 0);
  EXPECT_LT(margin.least_Ns(), 6 * margin.mass_kg);
  studio.save(std::move(recorder));  // the state at the end is the same without it
  // Copies have the recorded frames: the margin is that of the motion, which holds where the recording was measured.
  motion::MotionStage stage(studio.options.stage, sim::load_motion(motion::take_path(studio.file)));
  motion::PushOptions push;
  push.watch_s = 1;
  push.resolution_mps = 1.0 / 16;
  EXPECT_EQ(motion::push_margins(stage, {margin.at_s}, push).front().withstood_mps, margin.withstood_mps);
}

TEST(MotionRecorder, SaysWhatCannotBeRecorded) {
  Studio studio;
  const auto error = [&] {
    try {
      studio.recorder();
    } catch (const std::exception& problem) {
      return std::string(problem.what());
    }
    return std::string();
  };
  studio.options.joints = {"kne"};
  EXPECT_THAT(error(), HasSubstr("joint 'kne' is not a servo of the group; did you mean 'knee'?"));
  studio.options.joints = {};
  studio.options.over = sim::JointMotion{};
  studio.options.over->keys = {{0, "", {{"hip", 0}}, {}, "", {}}, {1, "", {{"hip", 1}}, {}, "", {}}};
  studio.options.from_s = 0.5;
  studio.options.to_s = 3;
  EXPECT_THAT(error(), HasSubstr("the part must lie within the motion, from 0 to 1 s, got 0.5 to 3"));
  EXPECT_FALSE(std::filesystem::exists(motion::journal_path(studio.file)));
}

/// Memory of this process, bytes.
std::int64_t memory() {
  std::int64_t all = 0, resident = 0;
  std::ifstream("/proc/self/statm") >> all >> resident;
  return resident * sysconf(_SC_PAGESIZE);
}

TEST(MotionRecorder, AnHourTakesNoMoreMemoryThanItsFirstMinutes) {
  // As coarse as the frames, so that an hour is short.
  std::string world = test::leg_world(
      "        - {name: group, type: joint_group}\n        - {name: player, type: motion_player, group: group}\n");
  world.replace(world.find("step_s: 0.002"), 13, "step_s: 0.008");
  Studio studio(world);
  studio.options.back_s = 5;
  auto recorder = studio.recorder();
  const auto wave = [&](int minutes) {
    for (int frame = 0; frame < minutes * 7500; ++frame)
      recorder->frame(std::vector<double>{frame % 250 < 125 ? 0.5 : -0.5, frame % 500 < 250 ? 0.3 : -0.3});
  };
  wave(5);
  const std::int64_t before = memory();
  wave(55);
  // A frame of the two joints in one list is 24 bytes, and 55 minutes of them are 10 MB.
  EXPECT_LT(memory() - before, 1'000'000);
  EXPECT_NEAR(recorder->now_s(), 3600, 1);
  const std::uint64_t hash = recorder->finish();
  recorder.reset();
  EXPECT_EQ(motion::read_take(motion::journal_path(studio.file)).frame_count(), 450'003u);
  EXPECT_NE(hash, 0u);
}

}  // namespace
