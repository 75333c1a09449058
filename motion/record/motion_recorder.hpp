// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <deque>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "motion/analysis/motion_stage.hpp"
#include "motion/analysis/push_trials.hpp"
#include "motion/record/set_points.hpp"
#include "motion/record/take_journal.hpp"

namespace motion {

/// Subject, place and base of a recording.
struct RecordOptions {
  StageOptions stage;
  std::string name = "motion";           ///< of a new motion
  std::optional<sim::JointMotion> over;  ///< motion that plays, while some of its joints are recorded
  std::vector<std::string> joints;       ///< that are recorded, by name or alias; empty: all of the group
  std::optional<double> from_s,
      to_s;  ///< part of `over` that is recorded; unset: from its start, to the end of the recording, which may be
             ///< later
  double back_s = 30;  ///< how far back() can go
};

/// Records a motion: frame by frame it moves set points of joints by given velocities, plays them in a world, and
/// writes them to a journal.  It depends on no clock: equal velocities and changes give an equal recording.
///
/// The set points are those of a motion player, as if it played the recording from a file.  So the exact motion of the
/// recording, played in the same world, gives the same state at its end, bit for bit.
class MotionRecorder {
 public:
  /// Builds the world, creates the journal, and plays the first frame, at rest; of `over`, after its approach.  Throws
  /// sim::ConfigError, std::runtime_error.
  MotionRecorder(RecordOptions options, const std::string& journal);

  /// Records and plays one frame.  `velocities`: of each joint of the group, rad/s or m/s.
  void frame(std::span<const double> velocities);
  /// Executes an action of the world now, as in `events:`, which becomes a part of the motion.  Throws
  /// sim::ConfigError or sim::WorldError for one that cannot be carried out; it is then not recorded.
  void change(const sim::ConfigNode& action);
  /// Goes back in time; what was recorded since does not count.  Returns the time that it went back, s.
  double back(double by_s);
  /// Measures the pushes that the vehicle withstands now, while the recorded joints hold, in copies of the world.  An
  /// impulse over mass is exact to 1/16 m/s, and 6 m/s at most; the vehicle may fall within a second.
  PushMargin push_margin();
  /// Plays to the end of the motion over which it records, and ends there.  Returns the hash of the state.
  std::uint64_t finish();

  /// Returns whether the recording must end: at the end of a motion that loops or whose part with an end is recorded,
  /// and at the limit of the length of a motion.
  bool is_full() const;
  /// Returns whether the next frame is recorded, and not played from `over`.
  bool is_recording() const;
  /// Time of the motion, s.
  double now_s() const { return static_cast<double>(frames_) * frame_s_; }
  double frame_s() const { return frame_s_; }
  std::span<const double> set_points() const { return set_points_->values(); }
  /// Returns whether a joint was held back by a limit of its servo, or of two joints, in the last frame.
  bool is_at_limit(std::size_t joint) const { return set_points_->is_at_limit(joint); }
  /// Time of the end of the motion over which it records, s; unset: it records a new one.
  std::optional<double> over_end_s() const {
    return options_.over ? std::optional(options_.over->end_s()) : std::nullopt;
  }
  const std::vector<std::string>& joints() const { return names_; }
  /// Returns the number of a joint of the group by name or alias.
  std::optional<std::size_t> find(const std::string& joint);
  /// Returns the keys and sticks of the group.
  const devices::JointControls& controls() const;
  MotionStage& stage() { return *stage_; }
  const TakeSettings& settings() const { return settings_; }

 private:
  struct Frame {
    std::int64_t number;
    std::vector<double> values;  ///< of the recorded joints
  };

  sim::JointMotion live_motion(MotionStage& stage);
  void check_part() const;
  /// Throws sim::ConfigError when an action names what makes the recording: its player or group.
  void check_change(const sim::ConfigNode& action) const;
  void add_frame(std::span<const double> velocities);
  void play_frame();
  void carry_out_changes();
  sim::JointMotion tail() const;
  std::optional<SetPoints::Goal> goal(std::size_t joint, double at_s) const;
  std::vector<double> recorded_values() const;
  std::int64_t frames_over() const;

  RecordOptions options_;
  TakeSettings settings_;
  double frame_s_ = 0.008;
  std::vector<std::string> names_;
  std::vector<std::size_t> armed_;                     ///< numbers of the recorded joints
  std::vector<std::optional<sim::MotionTrack>> over_;  ///< tracks of `over` by number of the joint
  std::unique_ptr<MotionStage> stage_;
  std::optional<SetPoints> set_points_;
  std::optional<TakeJournal> journal_;
  std::vector<double> first_;    ///< values of all joints at the start
  std::int64_t frames_ = 0;      ///< number of the last one
  std::deque<Frame> recent_;     ///< for going back
  std::size_t next_change_ = 0;  ///< of `over`
  std::size_t changes_ = 0;      ///< in the journal
};

}  // namespace motion
