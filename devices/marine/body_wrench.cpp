// SPDX-License-Identifier: BSD-3-Clause
#include "devices/marine/body_wrench.hpp"

#include <cmath>

#include "shoal/message_codec.hpp"
#include "shoal/wrench_t.hpp"
#include "sim/world/world.hpp"

namespace devices {

void BodyWrench::Params::read(sim::ParamReader& in) {
  in.read("force_max_N", force_max_N, sim::between(0, 1e9), "maximum force along each axis, both directions");
  in.read("torque_max_Nm", torque_max_Nm, sim::between(0, 1e9), "maximum torque about each axis, both directions");
  in.read("lag_s", lag_s, sim::at_least(0), "time constant of a first-order lag; 0: none");
}

BodyWrench::BodyWrench(const Params& params, const sim::DeviceContext& context)
    : params_(params),
      world_(context.world),
      body_(context.body),
      p_BD_(context.config.X_BS().translation()),
      R_BD_(context.config.X_BS().linear()) {}

void BodyWrench::change(const Params& params) {
  params_ = params;
  set_wrench(desired_force_N_, desired_torque_Nm_);
}

void BodyWrench::set_wrench(const sim::Vector3d& force_N, const sim::Vector3d& torque_Nm) {
  desired_force_N_ = force_N.cwiseMin(params_.force_max_N).cwiseMax(-params_.force_max_N);
  desired_torque_Nm_ = torque_Nm.cwiseMin(params_.torque_max_Nm).cwiseMax(-params_.torque_max_Nm);
}

void BodyWrench::act(const sim::ActContext& context) {
  // Share of the response that remains after half a step; the wrench half-way acts during the step.
  const double left = params_.lag_s > 0 ? std::exp(-context.step_s / 2 / params_.lag_s) : 0;
  const sim::Vector3d force_N = desired_force_N_ + left * (force_N_ - desired_force_N_);
  const sim::Vector3d torque_Nm = desired_torque_Nm_ + left * (torque_Nm_ - desired_torque_Nm_);
  force_N_ = desired_force_N_ + left * (force_N - desired_force_N_);
  torque_Nm_ = desired_torque_Nm_ + left * (torque_Nm - desired_torque_Nm_);
  if (context.effectiveness == 0 || (force_N.isZero(0) && torque_Nm.isZero(0))) return;
  // Apply force and torque in W.
  const sim::Matrix3d R_WB = world_.hydrodynamics().motion_of(body_).R_WB;
  const sim::Vector3d force_B = R_BD_ * (context.effectiveness * force_N).eval();
  const sim::Vector3d torque_B = R_BD_ * (context.effectiveness * torque_Nm).eval();
  body_.add_force_at_W(R_WB * force_B, R_WB * (p_BD_ - body_.p_BC()));
  if (!torque_B.isZero(0)) body_.add_torque_W(R_WB * torque_B);
}

void BodyWrenchController::receive(sim::Time, std::span<const std::byte> payload) {
  const auto command = shoal::decode<shoal::wrench_t>(payload, shoal::Finite::required);
  wrench_.set_wrench({command.force_N[0], command.force_N[1], command.force_N[2]},
                     {command.torque_Nm[0], command.torque_Nm[1], command.torque_Nm[2]});
}

SHOAL_ACTUATOR("body_wrench", BodyWrench, BodyWrenchController);

}  // namespace devices
