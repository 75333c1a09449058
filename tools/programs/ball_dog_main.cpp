// SPDX-License-Identifier: BSD-3-Clause
#include <limits>
#include <stdexcept>

#include "autonomy/missions/robots/dog_steering.hpp"
#include "shoal/joint_servo_command_t.hpp"
#include "shoal/motion_command_t.hpp"
#include "tools/programs/program.hpp"

namespace {

struct Options {
  std::string name, vehicle;
  autonomy::BallDetector::Params detector{.fov_deg = 56.9, .ball_radius_m = 0.042};
  autonomy::BallChase::Params chase{.search_turn_radps = 1,
                                    .turn_gain_per_s = 1.5,
                                    .max_turn_radps = 1,
                                    .approach_mps = 0.16,
                                    .kick_mps = 0.16,
                                    .kick_range_m = 0.3,
                                    .kick_bearing_rad = 0.3,
                                    .kick_s = 3,
                                    .lost_s = 1,
                                    .back_s = 0,
                                    .back_mps = 0};
  autonomy::DogSteering::Params steering;
  autonomy::Participation participation;
};

/// All of the program's state, which is rewound with the world.
struct State {
  autonomy::BallChase chase;
  autonomy::DogSteering steering;
  autonomy::HeadPose head = {};
};

int chase_ball(const Options& options) {
  autonomy::BallDetector detector(options.detector);
  State state{autonomy::BallChase(options.chase), autonomy::DogSteering(options.steering)};
  shoal::Client client(options.name, options.participation.lcm_url);
  const std::string prefix = options.vehicle + ".";
  client.subscribe<shoal::image_t>(prefix + "camera", [&](const shoal::image_t& image) {
    const auto ball = detector.detect(image);
    state.chase.see(ball ? std::optional(state.steering.level(*ball)) : std::nullopt);
    state.head = state.steering.look(ball);
  });
  return autonomy::take_part(client, options.participation, state, [&](std::int64_t utime) {
    // The head follows the ball.
    const auto turn_joint = [&](const char* joint, double position_rad) {
      shoal::joint_servo_command_t turn{};
      turn.utime = utime;
      turn.position = position_rad;
      client.publish(prefix + joint + ".cmd", turn);
    };
    turn_joint("neck_tilt", state.head.neck_tilt_rad);
    turn_joint("head_nod", state.head.head_nod_rad);
    // The legs walk.
    const autonomy::ChaseCommand command = state.chase.step(utime);
    const bool is_kick = state.chase.phase() == autonomy::BallChase::Phase::kick;
    const auto motion = state.steering.walk(utime, command, is_kick);
    if (!motion) return;
    shoal::motion_command_t play{};
    play.utime = utime;
    play.motion = *motion;
    play.from_s = play.to_s = play.rate = std::numeric_limits<double>::quiet_NaN();
    play.repeat = -1;
    client.publish(prefix + "player.cmd", play);
  });
}

void declare(command_line::DeclaredOptions& declared, Options& options) {
  declared.publishes({"{vehicle}.neck_tilt.cmd", "{vehicle}.head_nod.cmd", "{vehicle}.player.cmd"});
  declared.subscribes({"{vehicle}.camera"});
  declared.text("name", "NAME", options.name, "its client name in the lockstep").required_in_worlds();
  declared.text("vehicle", "VEHICLE", options.vehicle, "ERS-7 that chases the ball").required_in_worlds();
  declared.number("ball_radius_m", options.detector.ball_radius_m, 0.001, 10,
                  "radius of the ball, from which its range is computed");
  declared.number("kick_range_m", options.chase.kick_range_m, 0.01, 10,
                  "range below which it walks into the ball even when it no longer sees it");
  declared.number("turn_gain_per_s", options.chase.turn_gain_per_s, 0.01, 100, "turn rate per bearing of the ball");
  declared.number("curve_radps", options.steering.curve_radps, 0, 10, "turn rate above which it walks in a curve");
  declared.number("spot_radps", options.steering.spot_radps, 0, 10, "turn rate above which it turns on the spot");
  declared.number("hold_s", options.steering.hold_s, 0, 10, "shortest time between two changes of the motion");
  options.participation.declare(declared);
  autonomy::set_help_end(
      declared, {"shoal-ball-dog --name chase --vehicle dog"},
      "It reads VEHICLE.camera and publishes VEHICLE.player.cmd for the motions trot, trot_left, "
      "trot_right, turn_left, turn_right and kick, and VEHICLE.neck_tilt.cmd and VEHICLE.head_nod.cmd.  "
      "docs/guides/vision_in_the_loop.md explains it.");
}

int run(int argc, char** argv) {
  Options options;
  CLI::App app{"Walks an AIBO ERS-7 to an orange ball that its camera sees, in lockstep with `shoal run`.",
               "shoal-ball-dog"};
  command_line::DeclaredOptions declared(app);
  declare(declared, options);
  if (const auto exit_code = declared.parse(argc, argv)) return *exit_code;
  if (options.name.empty()) throw std::invalid_argument("--name is required");
  if (options.vehicle.empty()) throw std::invalid_argument("--vehicle is required");
  return chase_ball(options);
}

}  // namespace

int main(int argc, char** argv) {
  return autonomy::run_program("shoal-ball-dog", [&] { return run(argc, argv); });
}
