// SPDX-License-Identifier: BSD-3-Clause
#include "motion/formats/motion_format.hpp"
#include "tests/fuzz/fuzz_target.hpp"

// Motions in files of other programs.  What is read is a motion; what is written can be read again.

namespace {

/// A leg with a lamp, with names in all lists, so that words of the corpus are found.
const motion::JointNames& names() {
  static const motion::JointNames names(
      "leg", {{"hip", "PRM:1", 0, false}, {"knee", "PRM:2", 0.5, false}, {"lamp", "", 0, false, true}},
      {{"tekkotsu", "", false, {{"hip", "LFr:rotor"}, {"knee", "RFr:rotor"}, {"lamp", "LED:lamp"}}},
       {"opencat", "", false, {{"hip", "8"}, {"knee", "9"}}}});
  return names;
}

void check(const sim::JointMotion& motion) {
  const std::vector<sim::MotionTrack> tracks = motion.tracks();
  fuzz::require(!tracks.empty() && tracks.size() <= sim::max_motion_joints, "a motion has a joint, and not too many");
  fuzz::require(motion.end_s() <= sim::max_motion_s + 1, "a motion has an end");
  for (const sim::MotionTrack& track : tracks)
    for (std::size_t i = 0; i < track.keys.size(); ++i) {
      fuzz::require(i == 0 || track.keys[i].at_s > track.keys[i - 1].at_s, "times increase");
      fuzz::require(track.keys[i].value >= -1e6 && track.keys[i].value <= 1e6, "values are numbers in their range");
    }
}

/// The motion file of a small motion can be read.
void check_text(const sim::JointMotion& motion) {
  constexpr std::size_t max_text_read = 100'000;
  const std::string text = sim::motion_text(motion);
  if (!motion.frames.empty() || text.size() > max_text_read) return;
  sim::Diagnostics diagnostics;
  const sim::ConfigNode root = sim::parse_config_text(text, "motion.yaml", diagnostics);
  fuzz::require(diagnostics.ok(), "a motion is written as YAML");
  sim::JointMotion again;
  sim::ParamReader in(root, "", diagnostics);
  again.read(in);
  in.finish();
  fuzz::require(diagnostics.ok(), "a motion that is written can be read");
}

void write_and_read(const motion::MotionFormat& format, const sim::JointMotion& motion) {
  if (format.write == nullptr && format.write_folder == nullptr) return;
  std::string bytes;
  try {
    motion::Losses losses;
    bytes = motion::bytes_of_motion(format, motion, {}, {}, losses);
  } catch (const sim::ConfigError&) {
    return;  // the format cannot hold it
  }
  constexpr std::size_t max_bytes_read = 1'000'000;  // large files only take time
  if (format.read == nullptr || bytes.size() > max_bytes_read) return;
  motion::Losses losses;
  check(motion::motion_of_bytes(format, {bytes, "written", {}, {}, {}}, losses));
}

void read(const char* name, fuzz::Input input) {
  const motion::MotionFormat& format = *motion::find_motion_format(name);
  const std::string_view bytes = fuzz::text_of(input);
  const motion::FormatOptions options;
  for (const motion::JointNames& joints : {motion::JointNames(), names()})
    fuzz::allow<sim::ConfigError>([&] {
      motion::Losses losses;
      const motion::MotionSource source{bytes, "file", joints, options, {}};
      const sim::JointMotion motion = motion::motion_of_bytes(format, source, losses);
      check(motion);
      check_text(motion);
      write_and_read(format, motion);
    });
}

}  // namespace

SHOAL_FUZZ_TARGET(motion_csv) {
  read("csv", input);
}

SHOAL_FUZZ_TARGET(motion_webots) {
  read("webots", input);
}

SHOAL_FUZZ_TARGET(motion_mtn) {
  read("mtn", input);
}

SHOAL_FUZZ_TARGET(motion_mot) {
  read("mot", input);
}

SHOAL_FUZZ_TARGET(motion_pos) {
  read("pos", input);
}

SHOAL_FUZZ_TARGET(motion_ros) {
  read("ros", input);
}

SHOAL_FUZZ_TARGET(motion_play_motion2) {
  read("play_motion2", input);
}

SHOAL_FUZZ_TARGET(motion_opencat) {
  read("opencat", input);
}

// A motion file, written in every format.
SHOAL_FUZZ_TARGET(motion_export) {
  sim::Diagnostics diagnostics;
  const sim::ConfigNode root = sim::parse_config_text(std::string(fuzz::text_of(input)), "motion", diagnostics);
  if (!diagnostics.ok()) return;
  sim::JointMotion motion;
  sim::ParamReader in(root, "", diagnostics);
  motion.read(in);
  in.finish();
  if (!diagnostics.ok()) return;
  for (const motion::MotionFormat& format : motion::motion_formats()) write_and_read(format, motion);
}
