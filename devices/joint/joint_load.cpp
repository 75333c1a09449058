// SPDX-License-Identifier: BSD-3-Clause
#include "devices/joint/joint_load.hpp"

#include "messages/reporter/message_reporter.hpp"
#include "shoal/wrench_t.hpp"
#include "sim/physics/body.hpp"

namespace devices {

void JointLoad::Params::read(sim::ParamReader& in) {
  in.require("joint");
  in.read_reference("joint", joint, "joint", "joint that it measures, of any type");
  in.read_choice("frame", frame, {{"sensor", Frame::sensor}, {"body", Frame::body}, {"world", Frame::world}},
                 "axes of the reading: as the device is mounted, of the body it is mounted on, or of the world");
  in.read("force_noise", force_noise, "error of each component of the force, N");
  in.read("torque_noise", torque_noise, "error of each component of the torque, N m");
}

JointLoad::JointLoad(const Params& params, const sim::DeviceContext& context)
    : params_(params),
      joint_(context.joint(params.joint)),
      body_(context.body),
      force_noise_(context, params, 3),
      torque_noise_(context, params, 3) {
  context.joint(params.joint).measure_load();
}

sim::Matrix3d JointLoad::R_FW(const sim::SenseContext& context) const {
  switch (params_.frame) {
    case Frame::sensor:
      return context.X_WS.linear().transpose();
    case Frame::body:
      return body_.X_WB().linear().transpose();
    case Frame::world:
      break;
  }
  return sim::Matrix3d::Identity();
}

void JointLoad::measure(const sim::SenseContext& context) {
  const sim::Matrix3d R = R_FW(context);
  force_N_ = R * joint_.force_W_N();
  torque_Nm_ = R * joint_.torque_W_Nm();
}

void JointLoad::disturb(double dt_s, sim::Random& random) {
  force_noise_.apply(std::span<double>(force_N_.data(), 3), dt_s, random);
  torque_noise_.apply(std::span<double>(torque_Nm_.data(), 3), dt_s, random);
}

void fill(const JointLoad& load, shoal::wrench_t& message) {
  for (int i = 0; i < 3; ++i) {
    message.force_N[i] = load.force_N()[i];
    message.torque_Nm[i] = load.torque_Nm()[i];
  }
}

SHOAL_SENSOR("joint_load", JointLoad, shoal::wrench_t);

}  // namespace devices
