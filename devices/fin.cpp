#include "devices/fin.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace devices {

void FinCoefficients::read(sim::ParamReader& in) {
  std::string frame = "flu";
  in.read_choice("frame", frame, {"flu", "frd"}, "axes of the numbers: frd as papers print them");
  const char* const keys[] = {"X", "Y", "Z", "K", "M", "N"};
  const char* const meanings[] = {"force along x, N per rad and (m/s)^2",    "force along y, N per rad and (m/s)^2",
                                  "force along z, N per rad and (m/s)^2",    "moment about x, N m per rad and (m/s)^2",
                                  "moment about y, N m per rad and (m/s)^2", "moment about z, N m per rad and (m/s)^2"};
  for (int i = 0; i < 3; ++i) in.read(keys[i], force[i], sim::between(-1e6, 1e6), meanings[i]);
  for (int i = 0; i < 3; ++i) in.read(keys[i + 3], moment[i], sim::between(-1e6, 1e6), meanings[i + 3]);
  if (frame == "flu") return;
  force = {force.x(), -force.y(), -force.z()};
  moment = {moment.x(), -moment.y(), -moment.z()};
}

void Fin::Params::read(sim::ParamReader& in) {
  in.read_choice("model", model, {{"lift", Model::lift}, {"coefficients", Model::coefficients}},
                 "lift: by area and slope; coefficients: force and moment per angle and square of the forward speed");
  in.read_choice("flow", flow, {{"local", Flow::local}, {"body", Flow::body}},
                 "local: as it is at the fin; body: lift by the angle of the fin alone and the speed of the body's "
                 "origin, as MSS remus100 has it");
  in.read("area_m2", area_m2, sim::above_to(0, 1000), "of the fin, one side; of both fins for a pair on one servo");
  in.read("aspect_ratio", aspect_ratio, sim::above_to(0, 100), "square of the span over the area");
  in.read("lift_slope", lift_slope, sim::between(0, 20),
          "dC_L/d(angle), per rad; absent: pi AR / (1 + sqrt(1 + (AR/2)^2))");
  in.read_deg("stall_deg", stall_rad, sim::above_to(0, 89), "angle of attack at which the flow begins to part");
  in.read_deg("stall_width_deg", stall_width_rad, sim::above_to(0, 89), "so much later it is a plate across the flow");
  in.read("drag_coefficient", drag_coefficient, sim::between(0, 10), "C_D without lift");
  in.read("span_efficiency", span_efficiency, sim::above_to(0, 2), "e of the drag that comes with lift");
  in.read("plate_coefficient", plate_coefficient, sim::between(0, 3), "C_D when it stands across the flow");
  in.read("density_kgpm3", density_kgpm3, sim::above(0), "instead of the water's");
  in.read("coefficients", coefficients,
          "of model coefficients: about the body's origin, times angle and speed squared");
  in.read_deg("limit_deg", limit_rad, sim::above_to(0, 90), "it turns so far to each side");
  in.read("rate_limit_degps", rate_limit_degps, sim::above(0), "of its servo; absent: no limit");
  lag.read(in);
  if (!in.describing() && (model == Model::coefficients) != coefficients.has_value())
    in.error("coefficients", "'coefficients' belongs to 'model' coefficients, and only to it");
}

double Fin::Params::slope() const {
  // Whicker & Fehlner 1958 without sweep, also Fossen's for fins of low aspect ratio.
  return lift_slope.value_or(std::numbers::pi * aspect_ratio / (1 + std::sqrt(1 + aspect_ratio * aspect_ratio / 4)));
}

Fin::Fin(const Params& params, const sim::DeviceContext& context) : mount_(context) {
  change(params);
}

void Fin::change(const Params& params) {
  params_ = params;
  lag_.set(params.lag, params.rate_limit_degps ? sim::degrees_to_radians(*params.rate_limit_degps)
                                               : std::numeric_limits<double>::infinity());
  command_ = std::clamp(command_, -params.limit_rad, params.limit_rad);
  span_m_ = std::sqrt(params.area_m2 * params.aspect_ratio);
  slope_ = params.slope();
}

void Fin::set_command(double angle_rad) {
  command_ = std::clamp(angle_rad, -params_.limit_rad, params_.limit_rad);
}

void Fin::act(const sim::ActContext& context) {
  // What it gives is the work of its servo; the water pushes a fin that is stuck all the same.
  const double h = context.effectiveness * context.step_s;
  const double angle =
      std::clamp(h > 0 ? lag_.follow(command_, h) : lag_.value(), -params_.limit_rad, params_.limit_rad);
  const WaterFlow flow = mount_.flow();
  if (flow.density_kgpm3 == 0) return;
  const double share = share_under_water(flow.depth_m, span_m_);
  if (share == 0) return;
  if (params_.model == Model::coefficients)
    act_as_published(flow, angle, share);
  else if (params_.flow == Flow::body)
    lift_by_speed_of_body(flow, angle, share);
  else
    lift_locally(flow, angle, share);
}

void Fin::lift_locally(const WaterFlow& flow, double angle_rad, double scale) {
  // The motion of the fin in the plane across its hinge, and its chord turned forward in that.
  const double square = flow.v_D.x() * flow.v_D.x() + flow.v_D.y() * flow.v_D.y();
  if (square < 1e-12) return;
  const double speed = std::sqrt(square);
  const double mx = flow.v_D.x() / speed, my = flow.v_D.y() / speed;
  const double cx = std::cos(angle_rad), cy = std::sin(angle_rad);
  double sine = mx * cy - my * cx, cosine = mx * cx + my * cy;
  if (cosine < 0) {
    sine = -sine;
    cosine = -cosine;
  }
  const double attack = std::atan2(sine, cosine);
  double C_L = slope_ * attack;
  double C_D =
      params_.drag_coefficient + C_L * C_L / (std::numbers::pi * params_.span_efficiency * params_.aspect_ratio);
  const double past = std::min((std::abs(attack) - params_.stall_rad) / params_.stall_width_rad, 1.0);
  if (past > 0) {
    const double stalled = past * past * (3 - 2 * past);
    const double C_N = params_.plate_coefficient * sine * sine;
    C_L += stalled * (std::copysign(C_N * cosine, sine) - C_L);
    C_D += stalled * (params_.drag_coefficient + C_N * std::abs(sine) - C_D);
  }
  const double pressure = 0.5 * params_.density_kgpm3.value_or(flow.density_kgpm3) * square * params_.area_m2 * scale;
  mount_.add_force_D(flow, {pressure * (-C_D * mx - C_L * my), pressure * (-C_D * my + C_L * mx), 0});
}

void Fin::lift_by_speed_of_body(const WaterFlow& flow, double angle_rad, double scale) {
  const sim::Vector3d v_D = mount_.origin_velocity_D(flow);
  const double square = v_D.x() * v_D.x() + v_D.y() * v_D.y();
  const double lift =
      0.5 * params_.density_kgpm3.value_or(flow.density_kgpm3) * square * params_.area_m2 * slope_ * angle_rad * scale;
  mount_.add_force_D(flow, {-lift * angle_rad, lift, 0});
}

void Fin::act_as_published(const WaterFlow& flow, double angle_rad, double scale) {
  const sim::Body& body = mount_.body();
  const double u = flow.R_WB.col(0).dot(body.v_WB_W() - flow.water_W);
  const double factor = u * u * angle_rad * scale;
  const sim::Vector3d force_W = flow.R_WB * (factor * params_.coefficients->force);
  mount_.body().add_force_W(force_W, body.X_WB().translation());
  mount_.body().add_torque_W(flow.R_WB * (factor * params_.coefficients->moment));
}

void Fin::hash_state(sim::StateHash& hash) const {
  lag_.hash_state(hash);
  hash.add(command_);
}

SHOAL_ACTUATOR("fin", Fin, NumberController<Fin>);

}  // namespace devices
