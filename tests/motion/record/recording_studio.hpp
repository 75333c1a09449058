// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <gmock/gmock.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <memory>
#include <string>
#include <vector>

#include "motion/analysis/motion_check.hpp"
#include "motion/analysis/push_trials.hpp"
#include "motion/record/motion_recorder.hpp"
#include "motion/record/recorded_motion.hpp"
#include "sim/vehicle/mounted_device.hpp"
#include "sim/world_file/vehicle_loader.hpp"
#include "tests/devices/joint/leg_fixture.hpp"
#include "tests/project_paths.hpp"
#include "tests/scratch_folder.hpp"

namespace recording_studio {

inline constexpr double frame_s = 0.008;

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

inline sim::MotionTrack track_of(const std::vector<sim::MotionTrack>& tracks, const std::string& joint) {
  for (const sim::MotionTrack& track : tracks)
    if (track.joint == joint) return track;
  throw std::runtime_error("no track of " + joint);
}

inline void record(motion::MotionRecorder& recorder, int frames, double hip, double knee) {
  for (int i = 0; i < frames; ++i) recorder.frame(std::vector<double>{hip, knee});
}

}  // namespace recording_studio
