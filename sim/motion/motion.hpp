// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "sim/config/param_reader.hpp"
#include "sim/motion/motion_track.hpp"

namespace sim {

/// Value of each joint by its name, in the order of the file: rad, m for a slider, or the intensity of a light.
using JointValues = std::vector<std::pair<std::string, double>>;

/// Pose of a motion file, to which its keys refer by name.
struct MotionPose {
  std::string name;
  JointValues joints;
};

/// Instant of a motion.  A joint that it does not name keeps its own course.
struct MotionKey {
  double at_s = 0;
  std::string pose;  ///< values of all joints of this pose, under those of `joints`; empty: none
  JointValues joints;
  std::optional<Easing> ease;  ///< from the key before of each joint; unset: that of the motion
  std::string note;
  SourcePlace place;
};

/// Action of the world at an instant of a motion, as in `events:` of a world.
struct MotionChange {
  double at_s = 0;
  ConfigNode action;
};

/// Sound that is played at an instant of a motion.
struct MotionSound {
  double at_s = 0;
  std::string sound;  ///< of a speaker of the vehicle
  double volume = 1;  ///< share of its greatest sound pressure, > 0 to 1
  void read(ParamReader& in);
};

/// How the joints reach the first values of a motion.
struct MotionStart {
  double max_velocity = 0.5;  ///< of the fastest joint, rad/s or m/s
  double min_s = 0.5;
  void read(ParamReader& in);
};

/// Run in which a motion was recorded.
struct MotionOrigin {
  std::string world, vehicle;
  std::int64_t seed = 0;
  std::string state_hash;        ///< at its end, hexadecimal
  std::vector<std::string> set;  ///< changes of the world, as with --set
  ConfigNode embedded_world;     ///< resolved world; null: none
  void read(ParamReader& in);
};

enum class AngleUnit : unsigned char { deg, rad };

/// Motion of the joints of a vehicle over time, as in a motion file.
struct JointMotion {
  std::string name, vehicle, description;
  AngleUnit angles = AngleUnit::deg;  ///< in the file; here they are in rad
  std::vector<std::string> sliders;   ///< joints whose values are in m
  std::vector<std::string> lights;    ///< names among those of joints that are lights: 0 off to 1
  Easing ease = Easing::linear;
  bool loop = false;       ///< the last key is followed by the first without a pause
  double frame_s = 0.008;  ///< time between two set points
  MotionStart start;
  std::vector<MotionPose> poses;
  std::vector<MotionKey> keys;
  std::string frames_file;          ///< as written; empty: none
  std::vector<MotionTrack> frames;  ///< sampled tracks of `frames_file`
  std::vector<MotionSound> sounds;
  std::vector<MotionChange> changes;
  std::optional<MotionOrigin> recorded;

  JointMotion();
  JointMotion(const JointMotion&);
  JointMotion(JointMotion&&) noexcept;
  JointMotion& operator=(const JointMotion&);
  JointMotion& operator=(JointMotion&&) noexcept;
  ~JointMotion();

  /// Reads a motion file, and its file of frames.
  void read(ParamReader& in);
  /// Like read(), without the version of the file format: for a motion within another file.
  void read_keys(ParamReader& in);

  /// Returns the values of a key by joint: those of its pose, then its own.
  JointValues values_of(const MotionKey& key) const;
  /// Returns the course of each joint, in the order of first mention.
  std::vector<MotionTrack> tracks() const;
  /// Returns the time of the last key or frame.
  double end_s() const;
  const MotionPose* find_pose(const std::string& pose) const;
  /// Returns the value here of one unit in the file.
  double unit_of(const std::string& joint) const;
  bool is_light(const std::string& joint) const;
};

/// Limits of the size of a motion.
constexpr double max_motion_s = 86400;
constexpr std::size_t max_motion_joints = 200;
constexpr std::size_t max_motion_keys = 1'000'000;

/// Reads a motion file.  Throws ConfigError with all errors.
JointMotion load_motion(const std::string& path);
/// Like load_motion(), with the rules and the collection of errors of the reader of another file.
JointMotion load_motion(const std::string& path, Diagnostics& diagnostics);

/// Returns the text of a motion file that reads to this motion.  Values in degrees keep 12 digits; those in rad are
/// exact.  Its file of frames is written by motion_frames_text().
std::string motion_text(const JointMotion& motion);

/// Bytes of the longest name of a joint in a motion.
constexpr std::size_t max_joint_name = 255;

/// Returns what is wrong with the name of a joint in a motion, for an error: the rule and the name; empty: nothing.
std::string joint_name_error(std::string_view name);

}  // namespace sim
