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
#include "tests/project_paths.hpp"
#include "tests/scratch_folder.hpp"

namespace {

using testing::HasSubstr;

constexpr double frame_s = 0.008;

/// A leg whose imu is noisy: its state depends on every step.
struct Studio {
  test_support::ScratchFolder folder;
  motion::RecordOptions options;
  std::string file = folder.file("swing.yaml");

  explicit Studio(const std::string& world = test::leg_world(
                      "        - {name: imu, type: imu, body: shin, gyro_noise: {gaussian_std: 0.01}}\n"
                      "        - {name: group, type: joint_group}\n"
                      "        - {name: player, type: motion_player, group: group}\n")) {
    options.stage.world = folder.file("world.yaml");
    options.name = "swing";
    std::ofstream(options.stage.world) << world;
  }
  std::unique_ptr<motion::MotionRecorder> recorder() {
    return std::make_unique<motion::MotionRecorder>(options, motion::journal_path(file));
  }
  /// Ends a recording, saves it, and proves that its exact motion, played in the same world, ends in the same state.
  sim::JointMotion save(std::unique_ptr<motion::MotionRecorder> recorder) {
    const std::uint64_t hash = recorder->finish();
    recorder.reset();
    sim::JointMotion keyed = motion::save_take(file, motion::read_journal(file).value(), "", "record").motion;
    EXPECT_FALSE(std::filesystem::exists(motion::journal_path(file)));
    motion::MotionStage stage(options.stage, sim::load_motion(motion::take_path(file)));
    stage.play_out(0, 600);
    EXPECT_EQ(stage.state_hash(), hash);
    EXPECT_LE(tools_difference(keyed), motion::key_tolerance * (1 + 1e-9));
    return keyed;
  }
  /// Greatest difference of a motion to the exact one.
  double tools_difference(const sim::JointMotion& keyed) const {
    const auto exact = sim::load_motion(motion::take_path(file)).tracks();
    double greatest = 0;
    for (const sim::MotionTrack& track : keyed.tracks())
      for (const sim::MotionTrack& other : exact)
        for (double t_s = 0; other.joint == track.joint && t_s <= keyed.end_s(); t_s += frame_s)
          greatest = std::max(greatest, std::abs(track.value_at(t_s) - other.value_at(t_s)));
    return greatest;
  }
};

sim::MotionTrack track_of(const std::vector<sim::MotionTrack>& tracks, const std::string& joint) {
  for (const sim::MotionTrack& track : tracks)
    if (track.joint == joint) return track;
  throw std::runtime_error("no track of " + joint);
}

void record(motion::MotionRecorder& recorder, int frames, double hip, double knee) {
  for (int i = 0; i < frames; ++i) recorder.frame(std::vector<double>{hip, knee});
}

TEST(MotionRecorder, TheExactMotionEndsInTheStateOfTheRecording) {
  Studio studio;
  auto recorder = studio.recorder();
  record(*recorder, 10, 0, 0);
  record(*recorder, 50, 1, -0.5);
  record(*recorder, 25, -3, 0);
  record(*recorder, 10, 0, 2);
  const sim::JointMotion motion = studio.save(std::move(recorder));
  // Three sums of velocity times time.
  const auto tracks = motion.tracks();
  EXPECT_NEAR(track_of(tracks, "hip").value_at(99), (50 * 1 - 25 * 3) * frame_s, 1e-9);
  EXPECT_NEAR(track_of(tracks, "knee").value_at(99), (-50 * 0.5 + 10 * 2) * frame_s, 1e-9);
  EXPECT_LT(motion.keys.size(), 10u);
}

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

TEST(MotionRecorder, OverdubKeepsTheOtherTracksAndTheirKeys) {
  Studio studio;
  sim::JointMotion base;
  base.name = "swing";
  base.ease = sim::Easing::smooth;
  base.poses = {{"bent", {{"hip", 0.2}, {"knee", 0.4}}}};
  base.keys = {{0, "bent", {}, {}, "", {}}, {0.5, "", {{"hip", 1}}, {}, "", {}}, {1, "", {{"hip", 0}, {"knee", -0.3}}}};
  std::ofstream(studio.file) << sim::motion_text(base);
  base = sim::load_motion(studio.file);
  studio.options.over = base;
  studio.options.joints = {"maker/knee"};
  auto recorder = studio.recorder();
  record(*recorder, 40, 9, -1);  // the velocity of a joint that plays has no effect
  EXPECT_FALSE(recorder->is_full());
  const sim::JointMotion motion = studio.save(std::move(recorder));
  const sim::JointMotion exact = sim::load_motion(motion::take_path(studio.file));
  const auto before = track_of(base.tracks(), "hip").keys;
  const auto after = track_of(exact.tracks(), "hip").keys;
  ASSERT_EQ(after.size(), before.size());
  for (std::size_t i = 0; i < before.size(); ++i) {
    EXPECT_EQ(after[i].at_s, before[i].at_s);
    EXPECT_EQ(after[i].value, before[i].value);
    EXPECT_EQ(after[i].ease, before[i].ease);
  }
  for (int i = 0; i <= 125; ++i)
    EXPECT_EQ(track_of(motion.tracks(), "hip").value_at(i * frame_s),
              track_of(base.tracks(), "hip").value_at(i * frame_s));
  // The knee moves from its first value, and holds to the end of the motion.
  EXPECT_NEAR(track_of(exact.tracks(), "knee").value_at(99), 0.4 - 40 * frame_s, 1e-9);
  EXPECT_NEAR(exact.end_s(), 1, 1e-9);
  EXPECT_EQ(motion::MotionStage(studio.options.stage, exact).player().to_s(), 1);
}

TEST(MotionRecorder, AKeyAtTheTimeOfACurvedOneLeavesTheRecordedJointAsFrames) {
  Studio studio;
  sim::JointMotion base;
  base.name = "swing";
  base.ease = sim::Easing::smooth;
  base.keys = {
      {0, "", {{"hip", 0}}, {}, "", {}}, {0.4, "", {{"hip", 1}}, {}, "", {}}, {1, "", {{"hip", 0}}, {}, "", {}}};
  std::ofstream(studio.file) << sim::motion_text(base);
  studio.options.over = base = sim::load_motion(studio.file);
  studio.options.joints = {"knee"};
  auto recorder = studio.recorder();
  // The knee turns round in frame 50, at 0.4 s.
  record(*recorder, 49, 0, 1);
  record(*recorder, 49, 0, -1);
  const sim::JointMotion motion = studio.save(std::move(recorder));
  EXPECT_EQ(motion.keys.size(), 3u);
  ASSERT_EQ(motion.frames.size(), 1u);
  EXPECT_EQ(motion.frames[0].joint, "knee");
}

TEST(MotionRecorder, APartThatIsRecordedAnewEndsAtTheValuesOfTheMotion) {
  Studio studio;
  sim::JointMotion base;
  base.name = "swing";
  base.ease = sim::Easing::cosine;
  base.keys = {{0, "", {{"hip", 0.5}, {"knee", 0}}, {}, "", {}}, {2, "", {{"hip", -0.5}, {"knee", 0.8}}, {}, "", {}}};
  std::ofstream(studio.file) << sim::motion_text(base);
  base = sim::load_motion(studio.file);
  studio.options.over = base;
  studio.options.from_s = 0.4;
  studio.options.to_s = 1.2;
  auto recorder = studio.recorder();
  while (!recorder->is_full()) recorder->frame(std::vector<double>{5, -5});
  const sim::JointMotion motion = studio.save(std::move(recorder));
  const sim::JointMotion exact = sim::load_motion(motion::take_path(studio.file));
  for (const char* joint : {"hip", "knee"}) {
    const sim::MotionTrack old = track_of(base.tracks(), joint);
    double fastest = 0, other = 0;
    for (int i = 1; i <= 250; ++i) {
      const double t_s = i * frame_s, value = track_of(exact.tracks(), joint).value_at(t_s);
      fastest = std::max(fastest, std::abs(value - track_of(exact.tracks(), joint).value_at((i - 1) * frame_s)));
      if (i <= 50 || i >= 150) {
        EXPECT_EQ(value, old.value_at(t_s)) << joint << " at " << t_s;
        EXPECT_NEAR(track_of(motion.tracks(), joint).value_at(t_s), old.value_at(t_s), 1e-12) << joint << " at " << t_s;
      } else {
        other = std::max(other, std::abs(value - old.value_at(t_s)));
      }
    }
    EXPECT_GT(other, 0.5) << joint;
    // The servo is as fast as 50 rad/s.
    EXPECT_LE(fastest, 50 * frame_s * (1 + 1e-9)) << joint;
  }
}

/// A motion of the leg that turns its hip in 1 s.
sim::JointMotion turn_of_hip(Studio& studio, bool loop = false) {
  sim::JointMotion base;
  base.name = "swing";
  base.ease = sim::Easing::smooth;
  base.loop = loop;
  base.keys = {{0, "", {{"hip", 0.2}}, {}, "", {}}, {1, "", {{"hip", loop ? 0.2 : 1}}, {}, "", {}}};
  std::ofstream(studio.file) << sim::motion_text(base);
  return sim::load_motion(studio.file);
}

TEST(MotionRecorder, GoesOnFromTheEndOfAMotion) {
  Studio studio;
  const sim::JointMotion base = turn_of_hip(studio);
  studio.options.over = base;
  studio.options.from_s = 1;
  auto recorder = studio.recorder();
  record(*recorder, 125, 5, 5);  // up to the end velocities have no effect, and the first frame was there
  EXPECT_NEAR(recorder->now_s(), 126 * frame_s, 1e-9);
  EXPECT_TRUE(recorder->is_recording());
  record(*recorder, 50, -1, 0.5);
  EXPECT_FALSE(recorder->is_full());
  const sim::JointMotion motion = studio.save(std::move(recorder));
  // The keys of the motion stay, with its easing: no frames.
  EXPECT_TRUE(motion.frames.empty());
  EXPECT_LE(motion.keys.size(), 6u);
  const sim::MotionTrack before = track_of(base.tracks(), "hip"), hip = track_of(motion.tracks(), "hip");
  for (int i = 0; i <= 125; ++i) EXPECT_EQ(hip.value_at(i * frame_s), before.value_at(i * frame_s));
  // Frame 126 was the last one of the record() before: it moved by its velocity.
  EXPECT_NEAR(hip.value_at(99), 1 + 5 * frame_s - 50 * frame_s, 1e-9);
  EXPECT_NEAR(track_of(motion.tracks(), "knee").value_at(99), 5 * frame_s + 50 * 0.5 * frame_s, 1e-9);
  EXPECT_EQ(track_of(motion.tracks(), "knee").value_at(1), 0);
  EXPECT_NEAR(motion.end_s(), 177 * frame_s, 1e-9);
}

TEST(MotionRecorder, APartWithoutAnEndMayGoBeyondTheMotion) {
  Studio studio;
  studio.options.over = turn_of_hip(studio);
  studio.options.from_s = 0.8;
  auto recorder = studio.recorder();
  record(*recorder, 200, 0, 0.1);
  EXPECT_FALSE(recorder->is_full());
  EXPECT_NEAR(studio.save(std::move(recorder)).end_s(), 202 * frame_s, 1e-9);
  // With an end, and in a loop, it does not.
  for (const bool loop : {false, true}) {
    studio.options.over = turn_of_hip(studio, loop);
    studio.options.to_s = loop ? std::nullopt : std::optional(0.9);
    recorder = studio.recorder();
    record(*recorder, 123, 0, 0.1);
    EXPECT_TRUE(recorder->is_full()) << loop;
    recorder.reset();
    std::filesystem::remove(motion::journal_path(studio.file));
  }
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
