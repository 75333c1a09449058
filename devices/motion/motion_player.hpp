// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "devices/motion/joint_group.hpp"
#include "devices/signals/led.hpp"
#include "devices/signals/speaker.hpp"
#include "sim/motion/motion.hpp"

namespace devices {

/// Motion that a player plays from the start of the run.
struct FirstPlay {
  std::string motion;
  std::optional<double> from_s, to_s, rate;
  int repeat = 0;
  bool skip_approach = false;
  void read(sim::ParamReader& in);
};

/// Player of motion files on a group of joints, and on the lights and the speaker of the vehicle.  Its playhead is part
/// of the state of the world.
///
/// A motion starts with an approach from the present set points to its first values.  The values are those of the
/// tracks at whole frames of the motion, and linear between them, as a robot plays frames.  Lights are as
/// they were until the approach has ended.  An emergency stop and a loss of power stop it.
class MotionPlayer final : public sim::Sensor {
 public:
  static constexpr const char* meaning = "Player of motion files on a group of joints.";
  static constexpr double default_rate_hz = 10;
  static constexpr const char* fixed_keys[] = {"group", "play"};
  static constexpr const char* example = "group: group";
  enum class Phase { idle, approach, playing, paused };
  /// A motion in a file, or with the keys of one.
  struct MotionFile {
    std::string file;
    sim::JointMotion motion;
    void read(sim::ParamReader& in);
  };
  struct Params {
    std::string group;
    std::vector<MotionFile> motions;
    std::optional<FirstPlay> play;
    void read(sim::ParamReader& in);
  };
  /// Part of a motion, and how it is played.
  struct Play {
    std::string motion;
    std::optional<double> from_s, to_s, rate;
    int repeat = 0;  ///< 0: as the motion says; -1: until stopped
    bool skip_approach = false;
  };

  MotionPlayer(const Params& params, const sim::DeviceContext& context);
  void act(const sim::ActContext& context);
  void measure(const sim::SenseContext&) override {}
  void disturb(double, sim::Random&) override {}
  void visit_state(sim::StateArchive& archive) override;
  /// Replaces the motions.  One that is played continues at its time, with its values from then on; it ends when there
  /// is none of its name any more.  Throws std::runtime_error when a motion names a joint that is not in the group.
  void change(const Params& params);

  /// Starts a motion; the one that is played ends.  Throws std::runtime_error for an unknown motion, or a part that is
  /// not within it.
  void play(const Play& play);
  void stop();
  void pause();
  void resume();
  /// Moves the playhead; the joints follow at the velocity of their servos.
  void seek(double at_s);
  /// Sets the values of some joints at a frame of the present motion, rad or m, one for each joint.  Their keys from
  /// that frame on are replaced, except the last one of each; keys more than `kept_frames` before it may be dropped.
  /// A recording adds its frames by this.  They are not state: who restores the world sets them again.
  void set_frame(std::int64_t frame, std::span<const std::size_t> joints, std::span<const double> values,
                 std::int64_t kept_frames);
  /// Sets the speed, > 0.
  void set_rate(double rate);

  Phase phase() const { return phase_; }
  JointGroup& group() const { return *group_; }
  /// Time in the motion; in the approach the negative time until it starts, s.
  double at_s() const;
  double from_s() const { return from_s_; }
  double to_s() const { return to_s_; }
  double rate() const { return rate_; }
  int repeats_left() const { return repeats_left_; }
  std::int64_t finished() const { return finished_; }
  const std::string& motion_name() const { return name_; }

 private:
  // Devices of sounds and lights are set at first use: devices of the vehicle are built one after the other.
  struct LightTrack {
    sim::MotionTrack track;
    Led* led = nullptr;
    std::size_t light = 0;  ///< its number in the device
  };
  struct SoundTime {
    sim::MotionSound sound;
    Speaker* speaker = nullptr;
    std::int64_t number = 0;  ///< of the sound in the device
  };
  /// Tracks of a motion, by the number of their servo in the group.
  struct Tracks {
    std::string name;
    double frame_s = 0, duration_s = 0;  ///< whole frames
    bool loop = false;
    sim::MotionStart start;
    std::vector<std::pair<std::size_t, sim::MotionTrack>> tracks;
    std::vector<LightTrack> lights;
    std::vector<SoundTime> sounds;
  };

  const Tracks& tracks() const { return motions_[number_]; }
  void check_signals(const sim::JointMotion& motion) const;
  void set_light(LightTrack& light) const;
  void play_sounds(double from_s, double to_s, bool with_end, sim::Time now);
  std::vector<Tracks> tracks_of(const Params& params) const;
  const Tracks& motion_named(const std::string& name) const;
  void check_part(const Tracks& motion, double from_s, double to_s) const;
  void values_at(const Tracks& motion, double at_s, std::vector<double>& values) const;
  void begin();
  void approach(const sim::ActContext& context);
  void advance(const sim::ActContext& context);

  std::string group_name_;
  const sim::Vehicle& vehicle_;
  JointGroup* group_;
  std::vector<Tracks> motions_;
  std::string name_;  ///< of the present motion; empty: none yet
  std::size_t number_ = 0;
  Phase phase_ = Phase::idle;
  Phase phase_before_ = Phase::idle;  ///< of a pause
  double playhead_s_ = 0, from_s_ = 0, to_s_ = 0, rate_ = 1;
  int repeats_left_ = 0;
  bool is_starting_ = false;  ///< the approach has not been planned yet
  bool skips_approach_ = false;
  double approach_s_ = 0, approached_s_ = 0;
  std::vector<double> approach_from_;
  std::int64_t finished_ = 0;
  std::vector<double> values_, first_;  ///< of the present step
};

/// Receives shoal.motion_command_t.
class MotionPlayerController final : public sim::Controller {
 public:
  static constexpr const char* command_messages = "shoal.motion_command_t";
  explicit MotionPlayerController(MotionPlayer& player) : player_(player) {}
  void receive(sim::Time now, std::span<const std::byte> payload) override;

 private:
  MotionPlayer& player_;
};

}  // namespace devices
