// SPDX-License-Identifier: BSD-3-Clause
#include "motion/analysis/motion_difference.hpp"

#include <algorithm>
#include <cmath>

#include "sim/config/message_text.hpp"

namespace motion {

namespace {

std::vector<sim::MotionTrack> named_tracks(const sim::JointMotion& motion,
                                           const std::function<std::string(const std::string&)>& name_of) {
  std::vector<sim::MotionTrack> tracks = motion.tracks();
  for (sim::MotionTrack& track : tracks) track.joint = name_of(track.joint);
  return tracks;
}

const sim::MotionTrack* find(const std::vector<sim::MotionTrack>& tracks, const std::string& joint) {
  const auto found =
      std::find_if(tracks.begin(), tracks.end(), [&](const sim::MotionTrack& one) { return one.joint == joint; });
  return found == tracks.end() ? nullptr : &*found;
}

}  // namespace

double MotionDifference::max() const {
  double greatest = 0;
  for (const JointDifference& joint : joints) greatest = std::max(greatest, joint.max);
  return greatest;
}

MotionDifference difference_of(const sim::JointMotion& first, const sim::JointMotion& second, double tolerance,
                               const std::function<std::string(const std::string&)>& name_of) {
  MotionDifference difference{first.end_s(), second.end_s(), {}, {}, {}};
  const auto tracks = named_tracks(first, name_of), others = named_tracks(second, name_of);
  const double end_s = std::max(difference.first_end_s, difference.second_end_s);
  const auto last = static_cast<std::int64_t>(std::ceil(end_s / first.frame_s - 1e-6));
  for (const sim::MotionTrack& track : tracks) {
    const sim::MotionTrack* other = find(others, track.joint);
    if (other == nullptr) {
      difference.only_first.push_back(track.joint);
      continue;
    }
    JointDifference joint;
    joint.joint = track.joint;
    double sum = 0;
    for (std::int64_t i = 0; i <= last; ++i) {
      const double t_s = static_cast<double>(i) * first.frame_s;
      const double off = std::abs(other->value_at(t_s) - track.value_at(t_s));
      sum += off * off;
      if (off > tolerance && !joint.first_at_s) joint.first_at_s = t_s;
      if (off > joint.max) {
        joint.max = off;
        joint.max_at_s = t_s;
      }
    }
    joint.rms = std::sqrt(sum / static_cast<double>(last + 1));
    difference.joints.push_back(std::move(joint));
  }
  for (const sim::MotionTrack& track : others)
    if (find(tracks, track.joint) == nullptr) difference.only_second.push_back(track.joint);
  return difference;
}

std::vector<CoursePoint> course_of(const StageOptions& options, const sim::JointMotion& motion) {
  sim::JointMotion once = motion;
  once.loop = false;
  StageOptions without_return = options;
  without_return.kept_s = 0;
  MotionStage stage(without_return, once);
  std::vector<CoursePoint> course;
  stage.after_step = [&](MotionStage& now) {
    // The approach depends on where the vehicle stood, not on the motion.
    if (now.player().phase() == devices::MotionPlayer::Phase::approach) return;
    course.push_back({now.player().at_s(), now.vehicle().X_WV()});
  };
  if (!stage.play_out(0, end_limit_s(once)))
    throw sim::ConfigError(
        {"motion '" + once.name + "' has not ended after " + sim::number_text(end_limit_s(once)) + " s of the run"});
  return course;
}

CourseDifference difference_of(const std::vector<CoursePoint>& first, const std::vector<CoursePoint>& second) {
  CourseDifference difference;
  double sum = 0;
  std::size_t count = 0, other = 0;
  for (const CoursePoint& point : first) {
    // The same time of the motion: steps are equal, but an approach may have ended within one.
    while (other < second.size() && second[other].at_s < point.at_s - 1e-9) ++other;
    if (other == second.size()) break;
    const double off_m = (second[other].X_WV.translation() - point.X_WV.translation()).norm();
    sum += off_m * off_m;
    ++count;
    if (off_m > difference.max_m) {
      difference.max_m = off_m;
      difference.max_at_s = point.at_s;
    }
    difference.end_m = off_m;
    difference.end_at_s = point.at_s;
  }
  if (count > 0) difference.rms_m = std::sqrt(sum / static_cast<double>(count));
  return difference;
}

}  // namespace motion
