// SPDX-License-Identifier: BSD-3-Clause
#include <numbers>
#include <optional>
#include <stdexcept>

#include "autonomy/missions/robots/striker.hpp"
#include "shoal/compass_t.hpp"
#include "shoal/twist_command_t.hpp"
#include "sim/base/math.hpp"
#include "tools/programs/program.hpp"

namespace {

struct Options {
  std::string name, vehicle, camera = "camera", compass = "compass", drive = "balance";
  autonomy::BallDetector::Params detector;
  autonomy::Striker::Params striker;
  std::optional<double> goal_yaw_deg;
  autonomy::Participation participation;
};

/// Chases with a vehicle that drives as shoal.twist_command_t says.
int chase_ball(const Options& options) {
  autonomy::BallDetector detector(options.detector);
  autonomy::Striker striker(options.striker);  // all of the program's state: it is rewound with the world
  shoal::Client client(options.name, options.participation.lcm_url);
  const std::string prefix = options.vehicle + ".";
  client.subscribe<shoal::image_t>(prefix + options.camera,
                                   [&](const shoal::image_t& image) { striker.see(detector.detect(image)); });
  if (options.goal_yaw_deg)
    client.subscribe<shoal::compass_t>(
        prefix + options.compass,
        [&](const shoal::compass_t& compass) { striker.head(std::numbers::pi / 2 - compass.heading_true_rad); },
        shoal::Finite::required);
  return autonomy::take_part(client, options.participation, striker, [&](std::int64_t utime) {
    const autonomy::ChaseCommand command = striker.step(utime);
    shoal::twist_command_t twist{};
    twist.utime = utime;
    twist.forward_mps = command.forward_mps;
    twist.turn_radps = command.turn_radps;
    client.publish(prefix + options.drive + ".cmd", twist);
  });
}

void declare_ball(command_line::DeclaredOptions& declared, autonomy::BallDetector::Params& ball) {
  declared.number("fov_deg", ball.fov_deg, 1, 170, "horizontal field of view of the camera");
  declared.number("ball_radius_m", ball.ball_radius_m, 0.001, 10,
                  "radius of the ball, from which its range is computed");
  declared.integer("min_pixels", ball.min_pixels, 1, 1000000, "a smaller group of orange pixels is noise");
  declared.integer("min_red", ball.min_red, 1, 255, "darker pixels are not orange");
  declared.number("min_saturation", ball.min_saturation, 0, 1, "smallest (red - blue) / red of an orange pixel");
  declared.number("min_green_share", ball.min_green_share, 0, 1, "smallest green / red of an orange pixel; 0 is red");
  declared.number("max_green_share", ball.max_green_share, 0, 1, "largest green / red of an orange pixel; 1 is yellow");
}

void declare_chase(command_line::DeclaredOptions& declared, autonomy::BallChase::Params& chase) {
  declared.number("search_turn_radps", chase.search_turn_radps, 0.01, 10, "turn rate while it searches");
  declared.number("turn_gain_per_s", chase.turn_gain_per_s, 0.01, 100, "turn rate per bearing of the ball");
  declared.number("max_turn_radps", chase.max_turn_radps, 0.01, 10, "limit of the turn rate");
  declared.number("approach_mps", chase.approach_mps, 0, 10, "speed towards the ball");
  declared.number("slow_bearing_rad", chase.slow_bearing_rad, 0.01, 3, "bearing above which it turns on the spot");
  declared.number("kick_mps", chase.kick_mps, 0, 10, "speed of a kick");
  declared.number("kick_range_m", chase.kick_range_m, 0.01, 100, "range at which a kick starts");
  declared.number("kick_bearing_rad", chase.kick_bearing_rad, 0.001, 3, "largest bearing at which a kick starts");
  declared.number("kick_s", chase.kick_s, 0.01, 100, "a kick ends this long after the ball was last in its range");
  declared.number("lost_s", chase.lost_s, 0.01, 100, "it searches after it has not seen the ball for this long");
  declared.number("back_s", chase.back_s, 0, 100, "time for which it backs up after a full turn without a ball");
  declared.number("back_mps", chase.back_mps, -10, 0, "speed while it backs up");
  declared.flag("predict", chase.predict, "correct the bearings of delayed images by the turn since they were taken");
}

void declare_striker(command_line::DeclaredOptions& declared, Options& options) {
  declare_chase(declared, options.striker.chase);
  declared.number("goal_yaw_deg", options.goal_yaw_deg, -360, 360,
                  "direction of the goal, counter-clockwise from east: it drives around the ball to kick it there, "
                  "with the true heading of a compass; without it, it kicks in any direction");
  declared
      .number("aligned_rad", options.striker.aligned_rad, 0.01, 3,
              "largest angle between the directions of ball and goal at which it plays the ball")
      .needs({"goal_yaw_deg"});
  declared.number("behind_m", options.striker.behind_m, 0.01, 10, "distance at which it drives around the ball")
      .needs({"goal_yaw_deg"});
  declared
      .number("memory_s", options.striker.memory_s, 0.01, 100,
              "time for which it remembers a ball that has left the image")
      .needs({"goal_yaw_deg"});
}

void declare(command_line::DeclaredOptions& declared, Options& options) {
  declared.publishes({"{vehicle}.{drive}.cmd"});
  declared.subscribes({"{vehicle}.{camera}", "{vehicle}.{compass}"});
  declared.text("name", "NAME", options.name, "its client name in the lockstep").required_in_worlds();
  declared.text("vehicle", "VEHICLE", options.vehicle, "vehicle that chases the ball").required_in_worlds();
  declared.text("camera", "DEVICE", options.camera, "its camera: raw RGB images of a pinhole without distortion");
  declared.text("compass", "DEVICE", options.compass, "its compass").needs({"goal_yaw_deg"});
  declared.text("drive", "NAME", options.drive, "what takes the commands, on NAME.cmd of the vehicle");
  declare_ball(declared, options.detector);
  declare_striker(declared, options);
  options.participation.declare(declared);
  autonomy::set_help_end(declared, {"shoal-ball-chase --name chase --vehicle segway1"},
                         "It reads VEHICLE.camera, with goal_yaw_deg VEHICLE.compass, and publishes "
                         "shoal.twist_command_t on VEHICLE.balance.cmd.  "
                         "docs/guides/vision_in_the_loop.md explains it.");
}

int run(int argc, char** argv) {
  Options options;
  options.participation.period_s = 0.05;
  CLI::App app{"Finds an orange ball with a camera, drives to it and kicks it, in lockstep with `shoal run`.",
               "shoal-ball-chase"};
  command_line::DeclaredOptions declared(app);
  declare(declared, options);
  if (const auto exit_code = declared.parse(argc, argv)) return *exit_code;
  if (options.name.empty()) throw std::invalid_argument("--name is required");
  if (options.vehicle.empty()) throw std::invalid_argument("--vehicle is required");
  if (options.goal_yaw_deg) options.striker.goal_yaw_rad = sim::degrees_to_radians(*options.goal_yaw_deg);
  return chase_ball(options);
}

}  // namespace

int main(int argc, char** argv) {
  return autonomy::run_program("shoal-ball-chase", [&] { return run(argc, argv); });
}
