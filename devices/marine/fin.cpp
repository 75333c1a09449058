// SPDX-License-Identifier: BSD-3-Clause
#include "devices/marine/fin.hpp"

#include <algorithm>
#include <cmath>

namespace devices {

void FinCoefficients::read(sim::ParamReader& in) {
  sim::AxesFrame frame = sim::AxesFrame::flu;
  in.read_choice("frame", frame, sim::axes_frame_words, "axes of the numbers: frd as printed in papers");
  const char* const keys[] = {"X", "Y", "Z", "K", "M", "N"};
  const char* const meanings[] = {"force along x, N per rad and (m/s)^2",    "force along y, N per rad and (m/s)^2",
                                  "force along z, N per rad and (m/s)^2",    "moment about x, N m per rad and (m/s)^2",
                                  "moment about y, N m per rad and (m/s)^2", "moment about z, N m per rad and (m/s)^2"};
  for (int i = 0; i < 3; ++i) in.read(keys[i], force[i], sim::between(-1e6, 1e6), meanings[i]);
  for (int i = 0; i < 3; ++i) in.read(keys[i + 3], moment[i], sim::between(-1e6, 1e6), meanings[i + 3]);
  if (frame == sim::AxesFrame::flu) return;
  // From forward-right-down to forward-left-up: y and z change their signs.
  force = {force.x(), -force.y(), -force.z()};
  moment = {moment.x(), -moment.y(), -moment.z()};
}

void Fin::Params::read(sim::ParamReader& in) {
  in.read_choice("model", model, {{"lift", Model::lift}, {"coefficients", Model::coefficients}},
                 "lift: by area and slope; coefficients: force and moment per angle and square of the forward speed");
  in.read_choice("flow", flow, {{"local", Flow::local}, {"body", Flow::body}},
                 "local: as it is at the fin; body: lift by the angle of the fin alone and the speed of the body's "
                 "origin, as in MSS remus100");
  in.read("area_m2", area_m2, sim::above_to(0, 1000),
          "area of the fin, one side; of both fins for a pair on one servo");
  foil.read(in);
  in.read("density_kgpm3", density_kgpm3, sim::above(0), "instead of the water's");
  in.read("coefficients", coefficients, "model coefficients: about the body's origin, times angle and speed squared");
  in.read_deg("limit_deg", limit_rad, sim::above_to(0, 90), "maximum deflection to each side");
  in.read("rate_limit_degps", rate_limit_degps, sim::above(0), "rate limit of its servo; unset: no limit");
  lag.read(in);
  if (in.describing()) return;
  if (model == Model::coefficients && !coefficients)
    in.error("'coefficients' is missing: 'model' coefficients needs it");
  if (model != Model::coefficients && coefficients)
    in.error("coefficients", "'coefficients' belongs to 'model' coefficients, and only to it");
  // All zeros would be a fin without effect, most likely a forgotten table.
  if (coefficients && coefficients->force.isZero(0) && coefficients->moment.isZero(0))
    in.error("coefficients", "'coefficients' must have a force or a moment that is not 0");
}

Fin::Fin(const Params& params, const sim::DeviceContext& context) : mount_(context), foil_(params.foil) {
  change(params);
}

void Fin::change(const Params& params) {
  params_ = params;
  lag_.set(params.lag, params.rate_limit_degps ? sim::degrees_to_radians(*params.rate_limit_degps)
                                               : std::numeric_limits<double>::infinity());
  command_ = std::clamp(command_, -params.limit_rad, params.limit_rad);
  span_m_ = std::sqrt(params.area_m2 * params.foil.aspect_ratio);
  foil_ = Foil(params.foil);
  if (params.coefficients)
    max_coefficient_ = std::max(params.coefficients->force.norm(), params.coefficients->moment.norm());
}

void Fin::set_command(double angle_rad) {
  command_ = std::clamp(angle_rad, -params_.limit_rad, params_.limit_rad);
}

[[gnu::flatten]] void Fin::act(const sim::ActContext& context) {
  // The effectiveness acts on the servo only; hydrodynamic forces act on a stuck fin too.
  const double h = context.effectiveness * context.step_s;
  const double angle =
      std::clamp(h > 0 ? lag_.follow_through(command_, h) : lag_.value(), -params_.limit_rad, params_.limit_rad);
  // Forces of the immersed share.
  const WaterFlow flow = mount_.flow();
  if (flow.density_kgpm3 == 0) return;
  const double share = share_under_water(flow.depth_m, span_m_);
  if (share == 0) return;
  switch (params_.model) {
    case Model::coefficients:
      return act_as_published(flow, angle, share, context.step_s);
    case Model::lift:
      break;
  }
  switch (params_.flow) {
    case Flow::local:
      return lift_locally(flow, angle, share, context.step_s);
    case Flow::body:
      return lift_by_speed_of_body(flow, angle, share, context.step_s);
  }
}

void Fin::lift_locally(const WaterFlow& flow, double angle_rad, double scale, double step_s) {
  const sim::Vector3d v_D = mount_.v_D(flow);
  const double square = v_D.x() * v_D.x() + v_D.y() * v_D.y();
  if (square < 1e-12) return;
  const double speed = std::sqrt(square);
  const double pressure = 0.5 * params_.density_kgpm3.value_or(flow.density_kgpm3) * square * params_.area_m2 * scale;
  const Eigen::Vector2d force = pressure * foil_.force(v_D.x() / speed, v_D.y() / speed, angle_rad);
  const double bound = std::min(1.0, mount_.max_force_N(speed, step_s) / force.norm());
  mount_.add_force_D(flow, {bound * force.x(), bound * force.y(), 0});
}

void Fin::lift_by_speed_of_body(const WaterFlow& flow, double angle_rad, double scale, double step_s) {
  const sim::Vector3d v_D = mount_.in_D(flow, flow.body.v_WB_W - flow.water_W);
  // Coefficients are published for motion ahead.  Astern the flow comes from behind, and the force is reversed; it
  // changes in proportion while the flow is more from the side than along.
  const double ahead = v_D.x() == 0 ? 0 : std::clamp(v_D.x() / std::abs(v_D.y()), -1.0, 1.0);
  const double square = (v_D.x() * v_D.x() + v_D.y() * v_D.y()) * ahead;
  const double upper = mount_.max_force_N(std::sqrt(std::abs(square)), step_s);
  const double lift = std::clamp(0.5 * params_.density_kgpm3.value_or(flow.density_kgpm3) * square * params_.area_m2 *
                                     foil_.slope() * angle_rad * scale,
                                 -upper, upper);
  mount_.add_force_D(flow, {-lift * angle_rad, lift, 0});
}

void Fin::act_as_published(const WaterFlow& flow, double angle_rad, double scale, double step_s) {
  const sim::BodyMotion& body = flow.body;
  const double u = body.R_WB.col(0).dot(body.v_WB_W - flow.water_W);
  const double published = u * std::abs(u) * angle_rad * scale;  // published for motion ahead
  if (published == 0) return;
  const double upper = mount_.max_force_N(std::abs(u), step_s);
  const double factor = published * std::min(1.0, upper / (std::abs(published) * max_coefficient_));
  const sim::Vector3d force_B = factor * params_.coefficients->force;
  const sim::Vector3d moment_B = factor * params_.coefficients->moment;
  mount_.body().add_force_at_W(body.R_WB * force_B, -(body.R_WB * mount_.body().p_BC()));
  mount_.body().add_torque_W(body.R_WB * moment_B);
}

SHOAL_ACTUATOR("fin", Fin, NumberController<Fin>);

}  // namespace devices
