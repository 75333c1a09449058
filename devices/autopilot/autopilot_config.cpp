// SPDX-License-Identifier: BSD-3-Clause
#include "devices/autopilot/autopilot_config.hpp"

#include <algorithm>

namespace devices {

void HoldParams::read(sim::ParamReader& in) {
  in.read("speed_mps", speed_mps, sim::between(-100, 100), "ahead, through the water");
  in.read("heading_deg", heading_deg, sim::between(-360, 360), "counter-clockwise from east; unset: that at the start");
  in.read("depth_m", depth_m, sim::any_place(), "below the still surface; unset: that at the start");
  in.read("altitude_m", altitude_m, sim::above(0), "over the bottom, in place of a depth");
  if (!in.describing() && depth_m && altitude_m) in.error("altitude_m", "give 'depth_m' or 'altitude_m', not both");
}

void StationParams::read(sim::ParamReader& in) {
  std::vector<double> numbers;
  in.read("at_m", numbers, sim::any_place(), "[east, north] in the world frame; unset: its position at the start");
  if (in.describing() || numbers.empty()) return;
  if (numbers.size() != 2) return in.error("at_m", "'at_m' must be two numbers, east and north");
  place_m = Eigen::Vector2d(numbers[0], numbers[1]);
}

void AutopilotParams::read(sim::ParamReader& in) {
  in.read_choice("mode", mode, "auto", autopilot_mode_words,
                 "at the start; auto: waypoints where there are some, else hold; off: others drive the actuators");
  // Actuators.
  in.read("thrusters", thrusters, "names of thrusters of the vehicle");
  in.read("fins", fins, "names of fins of the vehicle; with fins it turns and changes depth by means of them");
  in.read("helm", helm, "name of a device that takes shoal.helm_command_t, in place of thrusters and fins");
  in.read("thruster_weights", thruster_weights, sim::above_to(0, 1e6),
          "one for each thruster: twice the weight means half the use; unset: all 1");
  in.read("axes", axes,
          "axes that the thrusters control, of surge, sway, heave, roll, pitch and yaw; unset: as many as possible, "
          "only surge when there are fins");
  // Setpoints and route.
  in.read("hold", hold, "setpoints held at the start");
  in.read("station", station, "position to hold in mode station");
  in.read_list("waypoints", waypoints, "waypoint", "the route");
  in.read("lawnmower", lawnmower, "a route of parallel tracks, in place of waypoints");
  in.read("loop", loop, "continue with the first waypoint after the last");
  in.read_choice("at_end", at_end,
                 {{"station", AtEnd::station}, {"stop", AtEnd::stop}, {"hold", AtEnd::hold}, {"circle", AtEnd::circle}},
                 "after the last waypoint: hold station there, stop, keep the last heading, or circle around it");
  in.read("circle_radius_m", circle_radius_m, sim::above_to(0, 1e6),
          "radius of the circle; at least the turning radius of the craft at its speed");
  // Guidance and control.
  in.read("guidance", guidance, "how the route is followed");
  in.read("gains", gains, "gains of the controllers");
  in.read("altitude_range_m", altitude_range_m, sim::above(0),
          "maximum distance below at which the bottom is detected");
  if (in.describing()) return;
  check(in);
}

/// Checks combinations of keys.
void AutopilotParams::check(sim::ParamReader& in) const {
  if (thrusters.empty() && helm.empty()) in.error("'thrusters' or 'helm' must name what the autopilot drives");
  if (!helm.empty() && !(thrusters.empty() && fins.empty())) in.error("helm", "'helm' replaces 'thrusters' and 'fins'");
  if (!thruster_weights.empty() && thruster_weights.size() != thrusters.size())
    in.error("thruster_weights", "'thruster_weights' must have one number for each thruster");
  const auto twice = [&](const char* key, std::vector<std::string> names) {
    std::sort(names.begin(), names.end());
    const auto at = std::adjacent_find(names.begin(), names.end());
    if (at != names.end()) in.error(key, std::string("'") + key + "' names '" + *at + "' twice");
  };
  twice("thrusters", thrusters);
  twice("fins", fins);
  for (const std::string& axis : axes)
    if (std::find(wrench_axes().begin(), wrench_axes().end(), axis) == wrench_axes().end())
      in.error("axes", "'axes' must be of surge, sway, heave, roll, pitch, yaw; got '" + axis + "'");
  if (lawnmower && !waypoints.empty()) in.error("lawnmower", "give 'waypoints' or 'lawnmower', not both");
  if (mode == AutopilotMode::waypoints && route().empty())
    in.error("mode", "'mode' waypoints needs 'waypoints' or 'lawnmower'");
}

std::vector<Waypoint> AutopilotParams::route() const {
  return lawnmower ? lawnmower->waypoints() : waypoints;
}

AutopilotMode AutopilotParams::first_mode() const {
  if (mode) return *mode;
  return lawnmower || !waypoints.empty() ? AutopilotMode::waypoints : AutopilotMode::hold;
}

}  // namespace devices
