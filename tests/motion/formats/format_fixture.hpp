// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <gtest/gtest.h>

#include <string>

#include "motion/formats/motion_format.hpp"

namespace test {

/// A leg of two servos, of which the knee has an alias, and what other programs call them.
inline motion::JointNames leg_names() {
  return {"leg",
          {{"lf_swing", "PRM:/r2/c1-Joint2:21", 0, false},
           {"lf_knee", "PRM:/r2/c1/c2/c3-Joint2:23", 0.5, false},
           {"rf_swing", "", 0, false}},
          {{"tekkotsu", "", false, {{"lf_swing", "LFr:rotor"}, {"lf_knee", "LFr:knee"}, {"rf_swing", "RFr:rotor"}}},
           {"opencat", "", false, {{"lf_swing", "8"}, {"lf_knee", "12"}, {"rf_swing", "9"}}}}};
}

/// A motion with keys of joints, by time.
struct KeyOf {
  double at_s;
  sim::JointValues joints;
  std::optional<sim::Easing> ease = {};
  std::string note = {};
};
inline sim::JointMotion motion(std::vector<KeyOf> keys) {
  sim::JointMotion motion;
  motion.name = "wave";
  motion.angles = sim::AngleUnit::rad;
  for (KeyOf& key : keys) {
    sim::MotionKey& one = motion.keys.emplace_back();
    one.at_s = key.at_s;
    one.joints = std::move(key.joints);
    one.ease = key.ease;
    one.note = key.note;
  }
  return motion;
}

struct Written {
  std::string bytes;
  motion::Losses losses;
};
inline Written written(const char* format, const sim::JointMotion& motion, const motion::JointNames& names = {},
                       const motion::FormatOptions& options = {}) {
  Written result;
  result.bytes = motion::bytes_of_motion(*motion::find_motion_format(format), motion, names, options, result.losses);
  return result;
}

struct Read {
  sim::JointMotion motion;
  motion::Losses losses;
};
inline Read read(const char* format, const std::string& bytes, const motion::JointNames& names = {},
                 const motion::FormatOptions& options = {}) {
  Read result;
  result.motion =
      motion::motion_of_bytes(*motion::find_motion_format(format), {bytes, "file", names, options, {}}, result.losses);
  return result;
}

/// The message of the error of a read or write; empty: none.
template <typename Work>
std::string error_of(const Work& work) {
  try {
    work();
  } catch (const sim::ConfigError& error) {
    return error.what();
  }
  return "";
}
inline std::string read_error(const char* format, const std::string& bytes, const motion::JointNames& names = {}) {
  return error_of([&] { read(format, bytes, names); });
}

inline double value(const sim::JointMotion& motion, const std::string& joint, double at_s) {
  for (const sim::MotionTrack& track : motion.tracks())
    if (track.joint == joint) return track.value_at(at_s);
  ADD_FAILURE() << "no joint " << joint;
  return 0;
}

}  // namespace test
