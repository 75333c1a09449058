// SPDX-License-Identifier: BSD-3-Clause
#include "motion/formats/motion_format.hpp"
#include "motion/formats/pose_table.hpp"
#include "sim/motion/motion_frames.hpp"

namespace motion {

namespace {

std::string write_csv(const sim::JointMotion& motion, const JointNames& names, const FormatOptions&, Losses& losses) {
  list_losses(motion, {}, losses);
  const PoseTable table = pose_table(motion, names, csv_format(), {}, losses);
  std::vector<sim::MotionTrack> tracks = table.tracks();
  for (std::size_t i = 0; i < tracks.size(); ++i) {
    tracks[i].joint = table.joints[i].foreign;
    if (tracks[i].joint.find_first_of(",\r\n") != std::string::npos)
      refuse_motion(motion, "joint '" + tracks[i].joint + "' must have no comma in CSV");
  }
  return sim::motion_frames_text(tracks);
}

sim::JointMotion read_csv(const MotionSource& source, Losses&) {
  sim::FramesError error;
  sim::JointMotion motion;
  motion.angles = sim::AngleUnit::rad;
  motion.frames = sim::parse_motion_frames(source.bytes, error);
  const std::string* const file = sim::intern_file_name(source.file);
  if (!error.text.empty()) sim::throw_config_error({file, error.line, error.column}, "", error.text);
  for (sim::MotionTrack& track : motion.frames) track.joint = joint_called(source, "csv", track.joint, {file, 1, 1});
  return motion;
}

}  // namespace

MotionFormat csv_format() {
  return {.name = "csv",
          .meaning = "table of time in s and joints in rad or m, lights from 0 to 1",
          .endings = {".csv"},
          .head = "t_s,",
          .list = "csv",
          .uses_aliases = false,
          .holds_lights = true,
          .write = write_csv,
          .read = read_csv};
}

}  // namespace motion
