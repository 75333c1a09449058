// SPDX-License-Identifier: BSD-3-Clause
#include "motion/record/recorded_motion.hpp"

#include <gmock/gmock.h>
#include <unistd.h>

#include <cmath>
#include <filesystem>
#include <fstream>

#include "motion/analysis/motion_check.hpp"
#include "motion/analysis/push_trials.hpp"
#include "motion/record/motion_recorder.hpp"
#include "sim/vehicle/mounted_device.hpp"
#include "sim/world_file/vehicle_loader.hpp"
#include "tests/motion/record/recording_studio.hpp"

namespace {

using namespace recording_studio;

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

}  // namespace
