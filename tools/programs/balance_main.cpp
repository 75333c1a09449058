// SPDX-License-Identifier: BSD-3-Clause
#include <iostream>
#include <stdexcept>

#include "autonomy/missions/robots/balance.hpp"
#include "autonomy/missions/robots/balance_model.hpp"
#include "shoal/utime_t.hpp"
#include "sim/base/math.hpp"
#include "tools/programs/program.hpp"

namespace {

struct Options {
  std::string name;
  std::vector<autonomy::SpeedPoint> speeds;
  double balanced_tilt_deg = -9.926;
  autonomy::Balance::Params balance;
  autonomy::Participation participation;
};

/// State of the program, all of which is rewound with the world.
struct State {
  autonomy::Balance balance;
  std::optional<std::int64_t> started_utime = {}, fell_utime = {};
  std::size_t next_speed = 0;
  bool waits = false;     ///< it has reported that sensors are missing
  bool balanced = false;  ///< it has published torques
};

int balance(const Options& options) {
  State state{autonomy::Balance(options.balance)};
  autonomy::Balance& balance = state.balance;
  const std::vector<autonomy::SpeedPoint>& speeds = options.speeds;
  shoal::Client client(options.name, options.participation.lcm_url);

  // Subscriptions to sensors and commands.
  const auto take = [&](const auto& message) { balance.receive(message); };
  const std::string prefix = options.name + ".";
  client.subscribe<shoal::inclination_t>(prefix + "inclinometer", take, shoal::Finite::required);
  if (options.balance.filter_s > 0) client.subscribe<shoal::imu_t>(prefix + "imu", take, shoal::Finite::required);
  client.subscribe<shoal::wheel_encoder_t>(prefix + "encoder", take, shoal::Finite::required);
  client.subscribe_bytes(prefix + "balance.cmd", [&](std::span<const std::byte> payload) {
    if (shoal::fingerprint(payload) == shoal::fingerprint_of<shoal::inclination_t>())
      balance.command_tilt(shoal::decode<shoal::inclination_t>(payload, shoal::Finite::required).pitch_rad);
    else
      balance.receive(shoal::decode<shoal::twist_command_t>(payload, shoal::Finite::required));
  });

  const int exit_code = autonomy::take_part(client, options.participation, state, [&](std::int64_t utime) {
    // Apply the speed profile.
    if (!state.started_utime) state.started_utime = utime;
    const double now_s = static_cast<double>(utime - *state.started_utime) * 1e-6;
    for (std::size_t& next = state.next_speed; next < speeds.size() && speeds[next].from_s <= now_s; ++next)
      balance.drive(speeds[next].forward_mps, speeds[next].turn_radps);

    // Publish the torques.
    const auto torques = balance.step();
    if (!torques) {
      if (now_s < 1 || state.waits) return;
      state.waits = true;
      std::cerr << options.name << ": no torque, because reports are missing: " << prefix << "inclinometer, " << prefix
                << "encoder" << (options.balance.filter_s > 0 ? ", " + prefix + "imu" : "") << '\n';
      return;
    }
    const auto publish = [&](const char* motor, double torque_Nm) {
      shoal::joint_servo_command_t command{};
      command.utime = utime;
      command.mode = 2;
      command.effort = torque_Nm;
      client.publish(prefix + motor, command);
    };
    publish("left_motor.cmd", torques->left_Nm);
    publish("right_motor.cmd", torques->right_Nm);
    state.balanced = true;
    // Report a fall once.
    if (!balance.fallen() || state.fell_utime) return;
    state.fell_utime = utime;
    std::cerr << options.name << ": fell after " << now_s << " s\n";
    shoal::utime_t fell{};
    fell.utime = utime;
    client.publish(prefix + "fallen", fell);
  });
  if (!state.fell_utime) std::cerr << options.name << (state.balanced ? ": did not fall\n" : ": never balanced\n");
  return exit_code;
}

void declare_gains(command_line::DeclaredOptions& declared, Options& options) {
  autonomy::Balance::Params& gains = options.balance;
  declared.number("balanced_tilt_deg", options.balanced_tilt_deg, -45, 45,
                  "tilt at which its center of mass is above its axle, positive forward");
  declared.number("kp_Nm_per_rad", gains.kp_Nm_per_rad, 0, 1e4, "torque of both wheels per tilt error");
  declared.number("kd_Nms_per_rad", gains.kd_Nms_per_rad, 0, 1e4, "torque of both wheels per tilt rate");
  declared.number("kv_rad_per_mps", gains.kv_rad_per_mps, 0, 10, "tilt setpoint per speed error");
  declared.number("ki_rad_per_m", gains.ki_rad_per_m, 0, 10, "tilt setpoint per integral of that error");
  declared.number("max_tilt_rad", gains.max_tilt_rad, 0.01, 0.7, "limit of the tilt setpoint, from the balanced tilt");
  declared.number("max_acceleration_mps2", gains.max_acceleration_mps2, 0.01, 10, "limit of the speed setpoint");
  declared.number("max_tilt_speed_mps", gains.max_tilt_speed_mps, 0.01, 10,
                  "speed limit of a commanded tilt, which is reduced as the vehicle approaches it");
  declared.number("tilt_torque_Nm_per_rad", gains.tilt_torque_Nm_per_rad, 0, 1e4,
                  "torque of both wheels per commanded tilt, which holds the tilt while it accelerates");
  declared.number("turn_gain_Nms_per_rad", gains.turn_gain_Nms_per_rad, 0, 1e4,
                  "differential wheel torque per yaw rate error");
  declared.number("turn_ki_Nm_per_rad", gains.turn_ki_Nm_per_rad, 0, 1e4,
                  "differential wheel torque per integral of that error");
  declared.number("rate_filter_s", gains.rate_filter_s, 0, 1, "time constant of the low-pass filter of the tilt rate");
  declared.number("speed_filter_s", gains.speed_filter_s, 0, 1,
                  "time constant of the low-pass filter of speed and turn rate");
  declared.number(
      "filter_s", gains.filter_s, 0, 1000,
      "time constant of the complementary filter of IMU and inclinometer; 0: tilt by the inclinometer alone");
  declared.number("wheel_radius_m", gains.wheel_radius_m, 0.01, 10, "radius of its wheels");
  declared.number("track_m", gains.track_m, 0.01, 10, "distance between the wheels");
  declared.number("max_torque_Nm", gains.max_torque_Nm, 0.1, 1e4, "limit of the torque of each wheel");
}

void declare(command_line::DeclaredOptions& declared, Options& options) {
  declared.publishes({"{name}.left_motor.cmd", "{name}.right_motor.cmd", "{name}.fallen"});
  declared.subscribes({"{name}.inclinometer", "{name}.imu", "{name}.encoder", "{name}.balance.cmd"});
  autonomy::add_name(declared, options.name, "vehicle to balance").required_in_worlds();
  declared.tuples(
      "speeds", {"from_s", "forward_mps", "turn_radps"}, 2, sim::any_place(),
      [&options](const auto& lists) {
        for (const auto& numbers : lists)
          options.speeds.push_back({numbers[0], numbers[1], numbers.size() > 2 ? numbers[2] : 0});
      },
      "forward speed and turn rate, each row from its time on; a missing turn rate is 0");
  declare_gains(declared, options);
  options.participation.declare(declared);
  autonomy::set_help_end(
      declared, {"shoal-balance --name segway1 --speeds '[[5,0.5],[15,-0.5],[25,0]]'", "shoal-balance --delay-margin"},
      "It reads NAME.inclinometer, NAME.encoder and, with filter_s, NAME.imu, and follows shoal.twist_command_t on "
      "NAME.balance.cmd, or tilts from its balance by the pitch of shoal.inclination_t there; it publishes "
      "NAME.left_motor.cmd and NAME.right_motor.cmd, and "
      "NAME.fallen when it has fallen.  Start it beside `shoal run worlds/segway.yaml --await segway1`.  "
      "docs/models/segway.md explains the gains.");
}

int run(int argc, char** argv) {
  Options options;
  options.participation.period_s = 0.01;
  CLI::App app{"Balances a vehicle on two wheels, such as the Segway RMP, in lockstep with `shoal run`.",
               "shoal-balance"};
  command_line::DeclaredOptions declared(app);
  declare(declared, options);
  bool print_margin = false;
  app.add_flag("--delay-margin", print_margin, "print the delay margin of a Segway RMP with these gains, and exit");
  if (const auto exit_code = declared.parse(argc, argv)) return *exit_code;
  options.balance.period_s = options.participation.period_s;
  options.balance.balanced_tilt_rad = sim::degrees_to_radians(options.balanced_tilt_deg);
  if (print_margin) {
    const autonomy::DelayMargin margin = autonomy::delay_margin(options.balance);
    std::cout << "it swings at " << margin.frequency_radps << " rad/s when the torque comes " << 1e3 * margin.delay_s
              << " ms late\n";
    return autonomy::exit_ok;
  }
  // Required here and not by the parser, since --delay-margin needs no vehicle.
  if (options.name.empty()) throw std::invalid_argument("--name is required");
  autonomy::check_speeds(options.speeds);
  return balance(options);
}

}  // namespace

int main(int argc, char** argv) {
  return autonomy::run_program("shoal-balance", [&] { return run(argc, argv); });
}
