// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <cmath>
#include <set>

#include "motion/formats/pose_table.hpp"
#include "motion/formats/yaml_text.hpp"
#include "sim/config/config_node.hpp"
#include "sim/config/message_text.hpp"

// joint_trajectory_controller goes in straight lines between points with positions only, as written here; between two
// with velocities the path is cubic, between two with velocities and accelerations quintic.

namespace motion {

namespace {

constexpr double billion = 1e9;
constexpr double sample_s = 0.008;
constexpr double any = 1e6;

/// builtin_interfaces/Duration of ROS 2, or duration of ROS 1.
struct RosDuration {
  std::int64_t sec = 0, nanosec = 0;
  void read(sim::ParamReader& in) {
    in.read(in.has("secs") ? "secs" : "sec", sec, sim::between(0, sim::max_motion_s), "s");
    in.read(in.has("nsecs") ? "nsecs" : "nanosec", nanosec, sim::between(0, billion - 1), "1e-9 s");
  }
  double seconds() const { return (static_cast<double>(sec) * billion + static_cast<double>(nanosec)) / billion; }
};

struct RosPoint {
  std::vector<double> positions, velocities, accelerations, effort;
  RosDuration time;
  sim::SourcePlace place;
  void read(sim::ParamReader& in) {
    if (in.node() != nullptr) place = in.node()->place;
    in.require("positions");
    in.read("positions", positions, sim::between(-any, any), "rad or m");
    in.read("velocities", velocities, sim::any_number(), "rad/s or m/s");
    in.read("accelerations", accelerations, sim::any_number(), "rad/s2 or m/s2");
    in.read("effort", effort, sim::any_number(), "N m or N");
    in.require("time_from_start");
    in.read("time_from_start", time, "time from the start");
  }
};

struct RosTrajectory {
  std::vector<std::string> joints;
  std::vector<RosPoint> points;
  void read(sim::ParamReader& in) {
    sim::ConfigNode header;
    in.read_raw("header", header, "stamp and frame, not used");
    in.require("joint_names");
    in.read("joint_names", joints, "names of joints");
    in.require("points");
    in.read_list("points", points, "point", "poses");
  }
};

/// Trajectory alone, or as the goal of an action.
struct RosFile {
  RosTrajectory trajectory;
  void read(sim::ParamReader& in) {
    if (in.has("trajectory"))
      in.read("trajectory", trajectory, "trajectory of an action goal");
    else
      trajectory.read(in);
  }
};

std::string write_ros(const sim::JointMotion& motion, const JointNames& names, const FormatOptions&, Losses& losses) {
  list_losses(motion, {}, losses);
  const PoseTable table = pose_table(motion, names, ros_format(), {}, losses);
  std::string text =
      "# trajectory_msgs/msg/JointTrajectory\nheader: {stamp: {sec: 0, nanosec: 0}, frame_id: ''}\njoint_names: [";
  for (std::size_t j = 0; j < table.joints.size(); ++j)
    text += (j > 0 ? ", " : "") + yaml_word(table.joints[j].foreign);
  text += "]\npoints:\n";
  for (std::size_t i = 0; i < table.rows.size(); ++i) {
    // In whole nanoseconds first, so that sec and nanosec agree.
    const auto time_ns = std::llround(table.times_s[i] * billion);
    text += "- {positions: [";
    for (std::size_t j = 0; j < table.rows[i].size(); ++j) text += (j > 0 ? ", " : "") + yaml_double(table.rows[i][j]);
    text += "], time_from_start: {sec: " + std::to_string(time_ns / 1'000'000'000) +
            ", nanosec: " + std::to_string(time_ns % 1'000'000'000) + "}}\n";
  }
  return text;
}

/// Position on the cubic between two points with velocities.
double cubic(double from, double to, double from_slope, double to_slope, double duration_s, double s) {
  const double s2 = s * s, s3 = s2 * s;
  return (2 * s3 - 3 * s2 + 1) * from + (3 * s2 - 2 * s3) * to +
         duration_s * ((s3 - 2 * s2 + s) * from_slope + (s3 - s2) * to_slope);
}

/// Position on the quintic between two points with velocities and accelerations.
double quintic(double from, double to, double from_slope, double to_slope, double from_bend, double to_bend,
               double duration_s, double s) {
  const double s2 = s * s, s3 = s2 * s, s4 = s3 * s, s5 = s4 * s;
  const double rise = 10 * s3 - 15 * s4 + 6 * s5;
  return (1 - rise) * from + rise * to +
         duration_s * ((s - 6 * s3 + 8 * s4 - 3 * s5) * from_slope + (-4 * s3 + 7 * s4 - 3 * s5) * to_slope) +
         duration_s * duration_s / 2 * ((s2 - 3 * s3 + 3 * s4 - s5) * from_bend + (s3 - 2 * s4 + s5) * to_bend);
}

void check_points(const RosTrajectory& file, sim::Diagnostics& diagnostics, const sim::SourcePlace& place) {
  const std::size_t joints = file.joints.size();
  if (joints == 0 || joints > sim::max_motion_joints)
    diagnostics.error(place, "", "'joint_names' must have 1 to 200 names, got " + std::to_string(joints));
  if (file.points.empty()) diagnostics.error(place, "", "'points' must have a point");
  const RosPoint* before = nullptr;
  for (const RosPoint& point : file.points) {
    const auto check_size = [&](const char* key, const std::vector<double>& values, bool may_be_empty) {
      if (values.size() != joints && !(may_be_empty && values.empty()))
        diagnostics.error(point.place, "",
                          std::string("'") + key + "' must have a value for each of " + std::to_string(joints) +
                              " joints, got " + std::to_string(values.size()));
    };
    check_size("positions", point.positions, false);
    check_size("velocities", point.velocities, true);
    check_size("accelerations", point.accelerations, true);
    if (before != nullptr && !(point.time.seconds() > before->time.seconds()))
      diagnostics.error(point.place, "",
                        "'time_from_start' must be above that of the point before, " +
                            sim::number_text(before->time.seconds()) + ", got " +
                            sim::number_text(point.time.seconds()));
    if (point.time.seconds() > sim::max_motion_s)
      diagnostics.error(point.place, "",
                        "'time_from_start' must be <= 86400, got " + sim::number_text(point.time.seconds()));
    before = &point;
  }
}

/// Adds samples of the cubic between two points, or of the quintic if both have accelerations.
void add_curve(const std::vector<std::string>& joints, const RosPoint& from, const RosPoint& to,
               sim::JointMotion& motion) {
  const double from_s = from.time.seconds(), duration_s = to.time.seconds() - from_s;
  const bool is_quintic = !from.accelerations.empty() && !to.accelerations.empty();
  for (double k = std::floor(from_s / sample_s + 1e-6) + 1; k * sample_s < from_s + duration_s - 1e-9; ++k) {
    sim::MotionKey& key = motion.keys.emplace_back();
    key.at_s = k * sample_s;
    for (std::size_t j = 0; j < joints.size(); ++j) {
      const double s = (key.at_s - from_s) / duration_s;
      const double value =
          is_quintic ? quintic(from.positions[j], to.positions[j], from.velocities[j], to.velocities[j],
                               from.accelerations[j], to.accelerations[j], duration_s, s)
                     : cubic(from.positions[j], to.positions[j], from.velocities[j], to.velocities[j], duration_s, s);
      if (!(std::abs(value) <= any))
        sim::throw_config_error(to.place, "", "the path by 'velocities' must stay within -1e6 and 1e6");
      key.joints.emplace_back(joints[j], value);
    }
  }
}

sim::JointMotion read_ros(const MotionSource& source, Losses& losses) {
  sim::Diagnostics diagnostics;
  const sim::ConfigNode root = parse_yaml_document(source, diagnostics);
  RosFile read;
  sim::ParamReader in(root, "", diagnostics);
  read.read(in);
  in.finish();
  diagnostics.throw_if_any();
  const RosTrajectory& file = read.trajectory;
  check_points(file, diagnostics, root.place);
  // Sizes are checked against 'joint_names', which must be read without errors first.
  diagnostics.throw_if_any();
  const std::vector<std::string> joints = joints_called(source, "ros", file.joints, root.place);
  sim::JointMotion motion;
  motion.angles = sim::AngleUnit::rad;
  bool is_curved = false, has_unused_accelerations = false, has_effort = false;
  double samples = 0;
  for (std::size_t i = 0; i < file.points.size(); ++i) {
    const RosPoint& point = file.points[i];
    has_effort = has_effort || !point.effort.empty();
    has_unused_accelerations = has_unused_accelerations || (!point.accelerations.empty() && point.velocities.empty());
    // Between points with velocities ROS controllers follow a cubic spline, with accelerations a quintic one.
    if (i > 0 && !point.velocities.empty() && !file.points[i - 1].velocities.empty()) {
      is_curved = true;
      has_unused_accelerations =
          has_unused_accelerations || point.accelerations.empty() != file.points[i - 1].accelerations.empty();
      samples += (point.time.seconds() - file.points[i - 1].time.seconds()) / sample_s + 1;
      if (samples * static_cast<double>(joints.size()) > static_cast<double>(sim::max_motion_keys))
        sim::throw_config_error(point.place, "",
                                "the path between points with velocities must have at most 1000000 values");
      add_curve(joints, file.points[i - 1], point, motion);
    }
    sim::MotionKey& key = motion.keys.emplace_back();
    key.at_s = point.time.seconds();
    for (std::size_t j = 0; j < joints.size(); ++j) key.joints.emplace_back(joints[j], point.positions[j]);
  }
  if (is_curved) losses.push_back("the path by 'velocities' is sampled every 8 ms");
  if (has_unused_accelerations)
    losses.push_back("'accelerations' count only between two points that have them and 'velocities'");
  if (has_effort) losses.push_back("'effort' is not kept");
  return motion;
}

}  // namespace

MotionFormat ros_format() {
  return {.name = "ros",
          .meaning = "trajectory_msgs/JointTrajectory of ROS as YAML",
          .endings = {".trajectory.yaml"},
          .head = "# trajectory_msgs/msg/JointTrajectory",
          .list = "ros",
          .uses_aliases = false,
          .write = write_ros,
          .read = read_ros};
}

}  // namespace motion
