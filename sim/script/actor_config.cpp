// SPDX-License-Identifier: BSD-3-Clause
#include "sim/script/actor_config.hpp"

#include <algorithm>
#include <cmath>

#include "sim/config/common_keys.hpp"

namespace sim {

namespace {

struct ReadTimedPose : TimedPose {
  void read(ParamReader& in) {
    in.require("at_s");
    in.read("at_s", at_s, between(0, 1e9), "time at the pose, since the start of the path");
    in.require("position_m");
    in.read("position_m", position_m, any_place(), "place in the world");
    in.read_deg("rpy_deg", rpy_rad, "roll, pitch, yaw");
  }
};

}  // namespace

void ActorConfig::read(ParamReader& in) {
  if (in.node() != nullptr) place = in.node()->place;
  in.require("name");
  in.read_name("name", name, "name of the actor, unique in the world");
  in.require("object");
  in.read_reference("object", object, "object", "the object that it moves");
  // Path.
  in.read_choice("path", path,
                 {{"waypoints", PathKind::waypoints}, {"spline", PathKind::spline}, {"timed", PathKind::timed}},
                 "straight lines; a smooth curve through the points; poses at times");
  read_points(in, "points", points_m, 3, "waypoints, spline: positions to pass");
  std::vector<ReadTimedPose> timed;
  in.read_list("poses", timed, "pose", "timed: poses at times, linear in between");
  poses.assign(timed.begin(), timed.end());
  Vector3d fixed_rpy_rad = Vector3d::Zero();
  in.read_deg("rpy_deg", fixed_rpy_rad, "waypoints, spline: kept all the way; unset: it heads along the path");
  if (in.has("rpy_deg")) rpy_rad = fixed_rpy_rad;
  // Motion along the path.
  in.read("speed_mps", speed_mps, above_to(0, 1000), "waypoints, spline: along the path");
  in.read_choice("ends", ends, {{"loop", PathEnds::loop}, {"reverse", PathEnds::reverse}, {"stop", PathEnds::stop}},
                 "at the end: continue with the first point, return along the path, or stop");
  in.read("start_s", start_s, between(0, 1e9), "start time; it waits at the first point until then");
  in.read_choice("starts", starts, {{"moving", ActorStart::moving}, {"waiting", ActorStart::waiting}},
                 "initial state; waiting: until an event commands it");
  if (!in.describing()) check_points(in);
}

void ActorConfig::check_points(ParamReader& in) {
  const bool timed = path == PathKind::timed;
  const char* desired = timed ? "poses" : "points";
  const char* other = timed ? "points" : "poses";
  // Report keys of other kinds of path.
  if (in.has(other)) in.error(other, "'" + std::string(other) + "' does not apply to a path of this kind");
  if (timed)
    for (const char* key : {"rpy_deg", "speed_mps"})
      if (in.has(key)) in.error(key, "'" + std::string(key) + "' does not apply to a path of this kind");
  // Check consecutive points.
  const std::size_t count = timed ? poses.size() : points_m.size();
  if (count < 2)
    return in.error(desired, "'" + std::string(desired) + "' must have at least 2, got " + std::to_string(count));
  for (std::size_t i = 0; i + 1 < count; ++i) {
    const std::string where = std::to_string(i + 1) + " and " + std::to_string(i + 2);
    if (timed && poses[i + 1].at_s <= poses[i].at_s) in.error("poses", "'at_s' must increase: poses " + where);
    const double max_mps = 1000;
    if (timed && (poses[i + 1].position_m - poses[i].position_m).norm() > max_mps * (poses[i + 1].at_s - poses[i].at_s))
      in.error("poses", "poses " + where + " are too far apart for their times: at most 1000 m/s");
    if (!timed && (points_m[i] - points_m[i + 1]).norm() < 1e-6)
      in.error("points", "points " + where + " are the same place");
  }
  // Check the end of a loop.
  if (timed && ends == PathEnds::loop &&
      !make_pose(poses.front().position_m, poses.front().rpy_rad)
           .isApprox(make_pose(poses.back().position_m, poses.back().rpy_rad), 1e-9))
    in.error("ends", "a timed path that loops must end in its first pose");
}

Path ActorConfig::make_path() const {
  if (path == PathKind::timed) return Path::timed(poses);
  std::optional<Matrix3d> R_WO;
  if (rpy_rad) R_WO = rotation_from_rpy(*rpy_rad);
  return Path::through(path, points_m, ends == PathEnds::loop, R_WO);
}

}  // namespace sim
