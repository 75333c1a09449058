// SPDX-License-Identifier: BSD-3-Clause
#include "devices/marine/thruster.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "sim/config/message_text.hpp"

namespace devices {

namespace {

void check_table(sim::ParamReader& in, const std::vector<double>& table) {
  if (table.size() < 4 || table.size() % 2 != 0) {
    in.error("table",
             "'table' must be two or more pairs of level and thrust, got " + std::to_string(table.size()) + " numbers");
    return;
  }
  for (std::size_t i = 2; i < table.size(); i += 2)
    if (!(table[i] > table[i - 2]))
      in.error("table", "the levels of 'table' must increase, got " + sim::number_text(table[i - 2]) + " before " +
                            sim::number_text(table[i]));
}

double signed_square(double x) {
  return std::abs(x) * x;
}

}  // namespace

void Thruster::Params::read(sim::ParamReader& in) {
  in.read_choice(
      "command", command,
      {{"effort", Command::effort}, {"rpm", Command::rpm}, {"radps", Command::radps}, {"thrust_N", Command::thrust_N}},
      "unit of a command; effort is -1 to 1; also the unit of the levels below");
  // Level: limits, dead band and lag.
  in.read("max", max, sim::above_to(0, 1e6), "largest level; 1 of an effort");
  in.read("min", min, sim::between(-1e6, 0), "largest level astern; unset: -max");
  in.read("dead_band", dead_band, sim::at_least(0), "commands smaller than this are 0");
  lag.read(in);
  in.read("rate_limit", rate_limit, sim::above(0), "maximum change of the level per second; unset: no limit");
  // Thrust curve.
  if (command == Command::thrust_N) curve = Curve::direct;
  in.read_choice(
      "curve", curve,
      {{"quadratic", Curve::quadratic}, {"table", Curve::table}, {"kt_kq", Curve::kt_kq}, {"direct", Curve::direct}},
      "how the level determines the thrust; direct only with commands of thrust_N, and always then");
  in.read("ahead", ahead, sim::between(0, 1e6), "quadratic: N per level squared");
  in.read("astern", astern, sim::between(0, 1e6), "quadratic, at levels below 0; unset: as ahead");
  in.read("inflow_loss", inflow_loss, sim::between(0, 1e6), "quadratic: N lost per level and m/s of inflow");
  in.read("table", table, sim::between(-1e6, 1e6), "table: pairs of level and thrust in N, by growing level");
  in.read("diameter_m", diameter_m, sim::above_to(0, 100), "diameter of the propeller");
  in.read("density_kgpm3", density_kgpm3, sim::above(0), "kt_kq: instead of the water's");
  in.read("k_t0", k_t0, sim::between(0, 10), "kt_kq: thrust coefficient without inflow");
  in.read("k_t_slope", k_t_slope, sim::between(0, 10), "kt_kq: loss of the thrust coefficient per advance ratio");
  in.read("k_q0", k_q0, sim::between(0, 10), "kt_kq: torque coefficient without inflow");
  in.read("k_q_slope", k_q_slope, sim::between(0, 10), "kt_kq: loss of the torque coefficient per advance ratio");
  in.read("full_speed_rpm", full_speed_rpm, sim::above_to(0, 1e6), "kt_kq: shaft speed at effort 1");
  // Interaction with the hull; shares below 1, so that thrust and inflow never vanish.
  in.read("wake_fraction", wake_fraction, sim::between(0, 0.99),
          "wake fraction: share of the speed that the inflow loses to the hull");
  in.read("thrust_deduction", thrust_deduction, sim::between(0, 0.99),
          "thrust deduction: share of the thrust lost to the hull");
  in.read_choice("inflow", inflow,
                 {{"water", Inflow::water}, {"water_speed", Inflow::water_speed}, {"ground", Inflow::ground}},
                 "water: along the axis, where the propeller is; water_speed: speed of the body through the water; "
                 "ground: its speed over ground, as in MSS remus100");
  // Torque, ventilation and power.
  in.read_choice("turns", turns, {{"right", Turns::right}, {"left", Turns::left}},
                 "right: clockwise seen from behind; the reaction torque turns the hull the other way");
  in.read("torque_per_thrust_m", torque_per_thrust_m, sim::between(0, 10), "shaft torque per thrust, except for kt_kq");
  in.read("torque_share", torque_share, sim::between(0, 1), "share of the shaft torque that acts on the hull");
  in.read("ventilation", ventilation, "the thrust fades as the disc emerges from the water; false: never");
  in.read("full_power_W", full_power_W, sim::at_least(0),
          "from the battery at full thrust; less by thrust^1.5; not for kt_kq");
  in.read("efficiency", efficiency, sim::above_to(0, 1), "kt_kq: shaft power over power from the battery");
  // Check combinations of keys.
  if (in.describing()) return;
  if (command != Command::effort && !max) in.error("'max' is missing: the largest level in the unit of 'command'");
  if (command == Command::effort && (upper() > 1 || lower() < -1))
    in.error(upper() > 1 ? "max" : "min", "an effort is at most 1: 'max' and 'min' must lie in -1 to 1");
  if ((command == Command::thrust_N) != (curve == Curve::direct))
    in.error("curve", "'curve' direct belongs to 'command' thrust_N, and only to it");
  if (curve == Curve::table) check_table(in, table);
  if (curve == Curve::kt_kq && command == Command::effort && !full_speed_rpm)
    in.error("'full_speed_rpm' is missing: 'curve' kt_kq needs a shaft speed");
}

Thruster::Thruster(const Params& params, const sim::DeviceContext& context) : mount_(context) {
  change(params);
}

void Thruster::change(const Params& params) {
  params_ = params;
  lag_.set(params.lag, params.rate_limit.value_or(std::numeric_limits<double>::infinity()));
  command_ = std::clamp(command_, params.lower(), params.upper());
  const double any_density = 1000;
  full_thrust_N_ = std::max(std::abs(effort_of(params.upper(), 0, any_density).thrust_N),
                            std::abs(effort_of(params.lower(), 0, any_density).thrust_N));
}

void Thruster::set_command(double command) {
  command_ = std::abs(command) < params_.dead_band ? 0 : std::clamp(command, params_.lower(), params_.upper());
}

double Thruster::turns_per_second(double level) const {
  if (params_.command == Command::rpm) return level / 60;
  if (params_.command == Command::radps) return level / (2 * std::numbers::pi);
  return level * params_.full_speed_rpm.value_or(0) / 60;
}

double Thruster::thrust_in_table(double level) const {
  const std::vector<double>& table = params_.table;
  if (level <= table[0]) return table[1];
  for (std::size_t i = 2; i < table.size(); i += 2) {
    if (level > table[i]) continue;
    const double along = (level - table[i - 2]) / (table[i] - table[i - 2]);
    return table[i - 1] + along * (table[i + 1] - table[i - 1]);
  }
  return table.back();
}

Thruster::Effort Thruster::effort_of(double level, double inflow_mps, double density_kgpm3) const {
  double thrust = level;
  if (params_.curve == Curve::quadratic) {
    const double factor = level >= 0 ? params_.ahead : params_.astern.value_or(params_.ahead);
    thrust = factor * signed_square(level) - params_.inflow_loss * std::abs(level) * inflow_mps;
  } else if (params_.curve == Curve::table) {
    thrust = thrust_in_table(level);
  } else if (params_.curve == Curve::kt_kq) {
    const double n = turns_per_second(level), D = params_.diameter_m;
    // Advance ratio times n; 0 for inflow from behind, which the thrust curve does not cover.
    const double Jn = n > 0 ? std::max(inflow_mps, 0.0) / D : 0;
    const double scale = params_.density_kgpm3.value_or(density_kgpm3) * D * D * D * D * std::abs(n);
    return {scale * (params_.k_t0 * n - params_.k_t_slope * Jn),
            scale * D * (params_.k_q0 * n - params_.k_q_slope * Jn)};
  }
  return {thrust, params_.torque_per_thrust_m * thrust};
}

double Thruster::inflow_mps(const WaterFlow& flow) const {
  const double share = 1 - params_.wake_fraction;
  if (params_.inflow == Inflow::water) return share * mount_.v_D(flow).x();
  if (params_.inflow == Inflow::water_speed) return share * (flow.body.v_WB_W - flow.water_W).norm();
  return share * flow.body.v_WB_W.norm();
}

// Flattened, as other functions of each step: otherwise small functions of Eigen are calls.
[[gnu::flatten]] void Thruster::act(const sim::ActContext& context) {
  const double level = lag_.follow_through(command_, context.step_s);
  thrust_N_ = power_W_ = 0;
  if (context.effectiveness == 0 || level == 0) return;
  const WaterFlow flow = mount_.flow();
  if (flow.density_kgpm3 == 0) return;
  const double share = params_.ventilation ? share_under_water(flow.depth_m, params_.diameter_m) : 1;
  if (share == 0) return;
  // Thrust on the body.
  const Effort full = effort_of(level, inflow_mps(flow), flow.density_kgpm3);
  const double scale = share * context.effectiveness;
  thrust_N_ = scale * (1 - params_.thrust_deduction) * full.thrust_N;
  mount_.add_force_D(flow, {thrust_N_, 0, 0});
  // Reaction torque on the hull, opposed to the rotation of the shaft.
  const double sense = params_.turns == Turns::right ? -1 : 1;
  const double torque = sense * params_.torque_share * scale * full.shaft_torque_Nm;
  if (torque != 0) mount_.add_torque_D(flow, {torque, 0, 0});
  // Electric power.
  if (params_.curve == Curve::kt_kq) {
    const double radps = 2 * std::numbers::pi * turns_per_second(level);
    power_W_ = std::max(scale * full.shaft_torque_Nm * radps, 0.0) / params_.efficiency;
  } else if (params_.full_power_W > 0 && full_thrust_N_ > 0) {
    power_W_ = params_.full_power_W * std::pow(std::abs(scale * full.thrust_N) / full_thrust_N_, 1.5);
  }
}

void Thruster::visit_state(sim::StateArchive& archive) {
  archive(lag_, command_, thrust_N_, power_W_);
}

SHOAL_ACTUATOR("thruster", Thruster, NumberController<Thruster>);

}  // namespace devices
