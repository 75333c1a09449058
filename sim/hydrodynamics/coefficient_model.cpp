// SPDX-License-Identifier: BSD-3-Clause
#include "sim/hydrodynamics/coefficient_model.hpp"

#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <numbers>

#include "sim/base/math.hpp"

namespace sim {

namespace {

/// Fraction of the lift that a hull keeps at an angle of attack of 0 to 90 degrees: all up to 45, none across the flow,
/// where bow and stern exchange roles.
double kept_lift(double alpha_rad) {
  constexpr double stall_rad = std::numbers::pi / 4;
  const double stalled = std::clamp(std::abs(alpha_rad) / stall_rad - 1, 0.0, 1.0);
  return 1 - stalled * stalled * (3 - 2 * stalled);
}

double signed_square(double x) {
  return std::abs(x) * x;
}

/// Adds the integrals over a piece of |v + x r| (v + x r) and of x times that, where v + x r has one sign.
void add_piece(double sign, double v, double r, const StripWeights& piece, double& force, double& moment) {
  force += sign * (v * v * piece.d1 + 2 * v * r * piece.d2 + r * r * piece.d3);
  moment += sign * (v * v * piece.d2 + 2 * v * r * piece.d3 + r * r * piece.d4);
}

struct StripSum {
  double force = 0, moment = 0;
};

StripSum integrate_strips(double v, double r, double half_length, const StripWeights& whole) {
  StripSum sum;
  const double at_aft = v - half_length * r, at_bow = v + half_length * r;
  // Without a change of sign along the hull |v| v is a plain polynomial; else the hull is split where the flow turns
  // round.
  if (at_aft * at_bow >= 0) {
    add_piece(at_aft + at_bow >= 0 ? 1 : -1, v, r, whole, sum.force, sum.moment);
    return sum;
  }
  const double still = -v / r;
  add_piece(at_aft >= 0 ? 1 : -1, v, r, {-half_length, still}, sum.force, sum.moment);
  add_piece(at_bow >= 0 ? 1 : -1, v, r, {still, half_length}, sum.force, sum.moment);
  return sum;
}

StripSum add_up_strips(double v, double r, double half_length, int strips) {
  StripSum sum;
  const double dx = 2 * half_length / (strips - 1);
  for (int i = 0; i < strips; ++i) {
    const double x = -half_length + i * dx;
    const double strip = signed_square(v + x * r) * dx;
    sum.force += strip;
    sum.moment += x * strip;
  }
  return sum;
}

}  // namespace

CoefficientModel::CoefficientModel(const HydrodynamicsConfig& config, double gravity_mps2)
    : config_(config), gravity_mps2_(gravity_mps2) {
  // Mass matrix: rigid body and added mass.
  const Matrix3d S = cross_matrix(config.center_of_mass_m);
  const double m = config.mass_kg;
  const Matrix3d inertia_O = config.inertia_kgm2 - m * S * S;  // parallel axis theorem: about the origin
  Matrix6d rigid;
  rigid << m * Matrix3d::Identity(), -m * S, m * S, inertia_O;
  mass_ = rigid + config.added_mass;
  mass_inverse_ = mass_.inverse();
  weight_N_ = config.weight_N.value_or(m * gravity_mps2);
  const double any_density = 1025;
  // Negative: computed from the volume and the density of the water.
  buoyancy_N_ = config.buoyancy_N ? *config.buoyancy_N : config.volume_m3 ? -1 : weight_N_;
  const double volume = config.volume_m3.value_or(m / any_density);
  height_m_ = config.hull_height_m.value_or(2 * std::cbrt(volume * 3 / (4 * std::numbers::pi)));
  // Damping: diagonals and rates.
  fold_derivatives();
  linear_diagonal_ = config_.linear_damping.diagonal();
  quadratic_diagonal_ = config_.quadratic_damping.diagonal();
  diagonal_damping_ = config_.linear_damping.isDiagonal(0) && config_.quadratic_damping.isDiagonal(0);
  find_rates();
  // Coriolis forces and published variants.
  added_mass_is_diagonal_ = config.added_mass.isDiagonal(0);
  const PublishedQuirks& quirks = config.quirks;
  coriolis_ = quirks.added_mass_coriolis;
  find_turning();
  current_by_yaw_only_ = quirks.current == PublishedQuirks::Current::yaw_only;
  fade_by_speed_in_water_ = quirks.fade_speed == PublishedQuirks::FadeSpeed::water;
}

/// Moves derivatives such as X_u and X_uu to the damping matrices.
void CoefficientModel::fold_derivatives() {
  std::erase_if(config_.derivatives, [&](const DerivativeTerm& term) {
    if (term.row != term.first) return false;
    const bool linear = term.second < 0, quadratic = term.second == term.first && term.absolute;
    if (linear) config_.linear_damping(term.row, term.row) -= term.coefficient;
    if (quadratic) config_.quadratic_damping(term.row, term.row) -= term.coefficient;
    return linear || quadratic;
  });
}

void CoefficientModel::find_rates() {
  const Vector6d mass = mass_.diagonal();
  linear_rate_ = linear_diagonal_.cwiseQuotient(mass);
  // Cross flow adds to quadratic damping.
  Vector6d quadratic = quadratic_diagonal_;
  if (config_.cross_flow) {
    const CrossFlowConfig& hull = *config_.cross_flow;
    whole_hull_ = {-hull.length_m / 2, hull.length_m / 2};
    double max = 0;
    for (std::size_t i = hull.drag_coefficient.size() > 1 ? 1 : 0; i < hull.drag_coefficient.size(); i += 2)
      max = std::max(max, hull.drag_coefficient[i]);
    const double any_density = 1025, L = hull.length_m;
    const double drag = 0.5 * hull.density_kgpm3.value_or(any_density) * hull.height_m * max;
    for (const int across : {1, 2}) quadratic[across] += drag * L;
    // Integral of |x|^3 over the hull.
    for (const int turning : {4, 5}) quadratic[turning] += drag * L * L * L * L / 32;
  }
  quadratic_rate_ = quadratic.cwiseQuotient(mass);
}

void CoefficientModel::find_turning() {
  const Vector6d mass = mass_.diagonal();
  // Ratios of masses and of moments of inertia bound the rates.
  const bool munk = coriolis_ == Coriolis::full;
  double lightest_share = 1;
  for (int i = 0; i < 3; ++i) {
    const int j = (i + 1) % 3, k = (i + 2) % 3;
    lightest_share = std::max(lightest_share, std::max(mass[j], mass[k]) / mass[i]);
    spin_ratio_ = std::max(spin_ratio_, std::abs(mass[3 + j] - mass[3 + k]) / mass[3 + i]);
    if (munk) munk_radpm_ = std::max(munk_radpm_, std::sqrt(std::abs(mass[j] - mass[k]) / mass[3 + i]));
  }
  constexpr double max = 4;  // of a hull; a larger ratio is probably a mass that constrains an axis
  lightest_share = std::min(lightest_share, max);
  spin_ratio_ = std::clamp(spin_ratio_, lightest_share, max);
  munk_radpm_ *= std::sqrt(lightest_share);
}

CoefficientModel::StepLimit CoefficientModel::max_step() const {
  const double damping = spectral_radius(mass_inverse_ * config_.linear_damping);
  // Stiffness of the waterline, or of weight and buoyancy.
  Matrix6d stiffness = Matrix6d::Zero();
  if (config_.waterline) {
    const WaterlineConfig& plane = *config_.waterline;
    stiffness.diagonal() << 0, 0, plane.heave_Npm, plane.roll_Nmprad, plane.pitch_Nmprad, 0;
    stiffness(2, 4) = stiffness(4, 2) = plane.heave_pitch_N;
  } else {
    const double upright = weight_N_ * config_.center_of_mass_m.z() -
                           (buoyancy_N_ < 0 ? weight_N_ : buoyancy_N_) * config_.center_of_buoyancy_m.z();
    stiffness(3, 3) = stiffness(4, 4) = std::abs(upright);
  }
  // Semi-implicit Euler is stable for a spring while h omega < 2.
  const double restoring = std::sqrt(spectral_radius(mass_inverse_ * stiffness));
  // Report the smaller of both limits.
  const double fastest = std::max(damping, restoring);
  return {fastest > 0 ? 2 / fastest : 1e9, damping >= restoring ? "forces of linear damping" : "restoring forces"};
}

double CoefficientModel::immersed(const CraftState& state) const {
  if (config_.waterline) {
    // 1 up to a rise by the draft, at which the hull leaves the water; falls to 0 over one more draft.
    const double draft = config_.mass_kg * gravity_mps2_ / config_.waterline->heave_Npm;
    return std::clamp(2 + state.depth_m / draft, 0.0, 1.0);
  }
  const double center_depth = state.depth_m + state.down.dot(config_.center_of_buoyancy_m);
  const double height = height_m_ + std::abs(state.down.x()) * config_.hull_length_m;
  const double share = std::clamp(0.5 + center_depth / height, 0.0, 1.0);
  return share * share * (3 - 2 * share);
}

/// Rate of change of the water velocity in body axes, due to their rotation.
Vector3d CoefficientModel::water_turning(const CraftState& state) const {
  const Vector3d w = state.nu.tail<3>();
  const Vector3d& v_c = state.v_water;
  if (current_by_yaw_only_) return {w.z() * v_c.y(), -w.z() * v_c.x(), 0};
  return -w.cross(v_c);
}

// Flattened: otherwise many small functions of Eigen are calls.
[[gnu::flatten]] Vector6d CoefficientModel::acceleration(const CraftState& state, const Vector6d& tau) const {
  Six nu_r(state.nu);
  nu_r.linear -= state.v_water;
  const double share = immersed(state);
  Vector6d total;
  total_forces(state, Six(tau), nu_r, share).copy_to(total);
  Vector6d nu_dot;
  if (share == 1)
    nu_dot = mass_inverse_ * total;
  else
    nu_dot = (mass_ - (1 - share) * config_.added_mass).llt().solve(total);
  nu_dot.head<3>() += water_turning(state);
  return nu_dot;
}

Vector6d CoefficientModel::stiff_acceleration(const CraftState& state, const Vector6d& tau, double step_s) const {
  Vector6d nu_r = state.nu;
  nu_r.head<3>() -= state.v_water;
  const double share = immersed(state);
  // Backward Euler for damping.
  const Matrix6d mass = mass_ - (1 - share) * config_.added_mass;
  Matrix6d left = mass;
  const Vector6d rates = share * (linear_rate_ + 2 * quadratic_rate_.cwiseProduct(nu_r.cwiseAbs()));
  left.diagonal() += step_s * rates.cwiseProduct(mass_.diagonal());
  Vector6d total;
  total_forces(state, Six(tau), Six(nu_r), share).copy_to(total);
  Vector6d nu_dot = left.llt().solve(total);
  nu_dot.head<3>() += water_turning(state);
  // Coriolis forces do no work: limit the kinetic energy at the end of the step to the work of the other forces.
  const Vector3d turned = Vector3d(state.nu.tail<3>()).cross(Vector3d(state.nu.head<3>()));
  Vector6d change = nu_dot;  // of the velocities in non-rotating axes
  change.head<3>() += turned;
  Vector6d after = nu_r + step_s * change;
  const double power = std::max(nu_r.dot(tau + forces(state, nu_r)), 0.0);
  const double allowed = nu_r.dot(mass * nu_r) + 2 * step_s * power, found = after.dot(mass * after);
  if (found <= allowed) return nu_dot;
  after *= std::sqrt(allowed / found);
  change = (after - nu_r) / step_s;
  change.head<3>() -= turned;
  return change;
}

Six CoefficientModel::total_forces(const CraftState& state, const Six& tau, const Six& nu_r, double share) const {
  const Vector3d w = state.nu.tail<3>();
  const Vector3d& v_r = nu_r.linear;
  Six total = forces(state, nu_r, share);
  total.linear = tau.linear + total.linear;
  total.angular = tau.angular + total.angular;
  // Rigid-body Coriolis forces, in the parametrization whose matrix does not depend on the linear velocity, so that it
  // can be used with the relative velocity (Fossen 2011, property 8.1).
  const Vector3d& r_g = config_.center_of_mass_m;
  const double m = config_.mass_kg;
  const Vector3d f = m * w.cross(v_r + w.cross(r_g));
  total.linear -= f;
  total.angular -= w.cross(config_.inertia_kgm2 * w) + r_g.cross(f);
  // Added-mass Coriolis forces: Kirchhoff's equations.  They fade as the craft leaves the water.
  const Matrix6d& A = config_.added_mass;
  Vector3d a, b;
  if (added_mass_is_diagonal_) {
    a = share * A.diagonal().head<3>().cwiseProduct(v_r);
    b = share * A.diagonal().tail<3>().cwiseProduct(w);
  } else {
    Vector6d all;
    nu_r.copy_to(all);
    const Vector6d momentum = share * (A * all);
    a = momentum.head<3>();
    b = momentum.tail<3>();
  }
  switch (coriolis_) {
    case Coriolis::full:
      total.linear -= w.cross(a);
      total.angular -= v_r.cross(a) + w.cross(b);
      break;
    case Coriolis::without_munk:
      total.linear.y() += a.z() * w.x();
      total.linear.z() -= a.y() * w.x();
      total.angular -= w.cross(b);
      total.angular.x() -= a.z() * v_r.y() - a.y() * v_r.z();
      break;
    case Coriolis::none:
      break;
  }
  if (!state.a_water.isZero(0)) {
    // Accelerated water acts on the displaced mass (Froude-Krylov) and on the added mass.
    Vector6d accelerated = Vector6d::Zero();
    accelerated.head<3>() = state.a_water;
    const Six by_added_mass(share * (config_.added_mass * accelerated));
    total.linear += by_added_mass.linear;
    total.angular += by_added_mass.angular;
    const Vector3d displaced = displaced_kg(state) * share * state.a_water;
    total.linear += displaced;
    total.angular += config_.center_of_buoyancy_m.cross(displaced);
  }
  return total;
}

Vector6d CoefficientModel::forces(const CraftState& state, const Vector6d& nu_r) const {
  Vector6d tau;
  forces(state, Six(nu_r), immersed(state)).copy_to(tau);
  return tau;
}

Six CoefficientModel::forces(const CraftState& state, const Six& nu_r, double share) const {
  Six tau;
  if (share > 0) {
    tau = damping(state, nu_r);
    tau.linear *= share;
    tau.angular *= share;
  }
  if (config_.windage) add_windage(state, tau);
  add_restoring(state, share, tau);
  return tau;
}

Six CoefficientModel::damping(const CraftState& state, const Six& nu_r) const {
  Six tau;
  // Linear and quadratic damping.
  if (diagonal_damping_) {
    const auto diagonal = [](const auto& linear, const auto& quadratic, const Vector3d& v) -> Vector3d {
      return -(linear + quadratic.cwiseProduct(v.cwiseAbs())).cwiseProduct(v);
    };
    tau.linear = diagonal(linear_diagonal_.head<3>(), quadratic_diagonal_.head<3>(), nu_r.linear);
    tau.angular = diagonal(linear_diagonal_.tail<3>(), quadratic_diagonal_.tail<3>(), nu_r.angular);
  } else {
    Vector6d all;
    nu_r.copy_to(all);
    tau = Six(-config_.linear_damping * all - config_.quadratic_damping * all.cwiseAbs().cwiseProduct(all));
  }
  // Variants of published models.
  const PublishedQuirks& quirks = config_.quirks;
  if (quirks.surge_damping_fade_spm > 0) {
    const double speed = fade_by_speed_in_water_ ? nu_r.linear.norm()
                                                 : std::sqrt(std::max(0.0, state.nu[0] + state.nu[1] * state.nu[1]));
    tau[0] += config_.linear_damping(0, 0) * nu_r[0] * (1 - std::exp(-quirks.surge_damping_fade_spm * speed));
  }
  // Derivatives that are not pure damping, cross flow and hull lift.
  for (const DerivativeTerm& term : config_.derivatives) {
    const double first = term.absolute ? std::abs(nu_r[term.first]) : nu_r[term.first];
    tau[term.row] += term.coefficient * first * (term.second < 0 ? 1 : nu_r[term.second]);
  }
  if (config_.cross_flow) add_cross_flow(nu_r, config_.cross_flow->density_kgpm3.value_or(state.density_kgpm3), tau);
  if (config_.hull_lift) add_hull_lift(nu_r, config_.hull_lift->density_kgpm3.value_or(state.density_kgpm3), tau);
  return tau;
}

double CoefficientModel::cross_flow_drag(double speed) const {
  const std::vector<double>& table = config_.cross_flow->drag_coefficient;
  if (table.size() == 1) return table.front();
  const double reynolds = speed * config_.cross_flow->reynolds_length_m / config_.cross_flow->kinematic_viscosity_m2ps;
  if (reynolds <= table[0]) return table[1];
  std::size_t i = 2;
  while (i < table.size() && table[i] < reynolds) i += 2;
  if (i >= table.size()) return table.back();
  const double along = (reynolds - table[i - 2]) / (table[i] - table[i - 2]);
  return table[i - 1] + along * (table[i + 1] - table[i - 1]);
}

/// Adds the cross-flow drag by strip theory (Fossen 2011).
void CoefficientModel::add_cross_flow(const Six& nu_r, double density, Six& tau) const {
  const CrossFlowConfig& hull = *config_.cross_flow;
  const double scale =
      -0.5 * density * hull.height_m * cross_flow_drag(std::sqrt(nu_r[1] * nu_r[1] + nu_r[2] * nu_r[2]));
  const double half = hull.length_m / 2;
  const auto strips = [&](double v, double r) {
    return hull.strips == 0 ? integrate_strips(v, r, half, whole_hull_) : add_up_strips(v, r, half, hull.strips);
  };
  const StripSum sideways = strips(nu_r[1], nu_r[5]), vertical = strips(nu_r[2], -nu_r[4]);
  tau[1] += scale * sideways.force;
  tau[5] += scale * sideways.moment;
  tau[2] += scale * vertical.force;
  tau[4] -= scale * vertical.moment;
}

/// Adds lift and drag of the hull in its vertical plane, by the angle of attack.
void CoefficientModel::add_hull_lift(const Six& nu_r, double density, Six& tau) const {
  const HullLiftConfig& hull = *config_.hull_lift;
  const double u = nu_r[0], w = nu_r[2];
  const double square = nu_r.linear.squaredNorm(), in_plane = std::sqrt(u * u + w * w);
  if (in_plane < 1e-12) return;
  const double pressure = 0.5 * density * square * hull.area_m2;
  // A hull that moves astern is treated as its mirror image: alpha is the angle between its axis and its motion.
  const double alpha = std::atan2(w, std::abs(u));
  // The lift is lost when the flow separates; the induced drag remains.
  const double C_L = hull.lift_slope * alpha;
  const double lift = pressure * C_L * kept_lift(alpha);
  const double drag = pressure * (hull.drag_coefficient + hull.induced_drag * C_L * C_L);
  // Rotate lift and drag into body axes.
  const double cosine = u / in_plane, sine = w / in_plane;
  tau[0] += -drag * cosine + (u < 0 ? -lift : lift) * sine;
  tau[2] += -drag * sine - lift * std::abs(cosine);
}

/// Adds the wind forces (Fossen 2011, eq. 8.23 to 8.30).
void CoefficientModel::add_windage(const CraftState& state, Six& tau) const {
  constexpr double air_density_kgpm3 = 1.225;
  const WindageConfig& area = *config_.windage;
  const double u = state.v_air.x() - state.nu[0], v = state.v_air.y() - state.nu[1];
  const double speed = std::hypot(u, v);
  const double pressure_per_speed = 0.5 * air_density_kgpm3 * speed;
  const double sideways = pressure_per_speed * area.sway_coefficient * area.lateral_area_m2 * v;
  tau[0] += pressure_per_speed * area.surge_coefficient * area.frontal_area_m2 * u;
  tau[1] += sideways;
  tau[3] += sideways * area.height_m;  // above the origin: -z
  // With sin(2 angle) = 2 u v / speed^2, the squared speed of the dynamic pressure cancels.
  tau[5] += air_density_kgpm3 * area.yaw_coefficient * area.lateral_area_m2 * area.length_m * -u * v;
}

void CoefficientModel::add_restoring(const CraftState& state, double share, Six& tau) const {
  if (config_.waterline) {
    const WaterlineConfig& plane = *config_.waterline;
    // Attitude relative to the surface.
    const double roll = std::atan2(state.down.y(), state.down.z()) - state.surface_roll_rad;
    const double pitch = std::asin(std::clamp(-state.down.x(), -1.0, 1.0)) - state.surface_pitch_rad;
    const double weight = config_.mass_kg * gravity_mps2_;
    // The springs act while the craft floats; out of the water only its weight acts.
    const double heave = std::max(state.depth_m, -weight / plane.heave_Npm);
    tau[2] -= share * (plane.heave_Npm * heave + plane.heave_pitch_N * pitch);
    tau[3] -= share * (plane.roll_Nmprad * roll);
    tau[4] -= share * (plane.pitch_Nmprad * pitch + plane.heave_pitch_N * heave);
    // Weight of a load.
    if (plane.load_kg > 0) {
      const Vector3d load = share * plane.load_kg * gravity_mps2_ * state.down;
      const Vector3d moment = plane.load_at_m.cross(load);
      tau[2] += load.z();
      tau[3] += moment.x();
      tau[4] += moment.y();
    }
    // Weight of a craft that has left the water.
    if (share < 1) {
      const Vector3d falling = (1 - share) * weight * state.down;
      tau.linear += falling;
      tau.angular += config_.center_of_mass_m.cross(falling);
    }
    return;
  }
  // Weight and buoyancy of a craft without waterline.
  const Vector3d weight = weight_N_ * state.down;
  const double full = buoyancy_N_ >= 0 ? buoyancy_N_ : *config_.volume_m3 * state.density_kgpm3 * gravity_mps2_;
  const Vector3d buoyancy = -full * share * state.down;
  tau.linear += weight + buoyancy;
  tau.angular += config_.center_of_mass_m.cross(weight) + config_.center_of_buoyancy_m.cross(buoyancy);
}

/// Displaced mass of water of the fully submerged craft.  A craft with a waterline floats and displaces its own mass.
double CoefficientModel::displaced_kg(const CraftState& state) const {
  if (config_.waterline) return config_.mass_kg;
  return buoyancy_N_ >= 0 ? buoyancy_N_ / gravity_mps2_ : *config_.volume_m3 * state.density_kgpm3;
}

Vector6d CoefficientModel::equivalent_wrench(const Vector6d& nu_dot, const Vector3d& v, const Vector3d& w,
                                             double mass_kg, const Matrix3d& inertia) const {
  const Vector3d& r_g = config_.center_of_mass_m;
  const Vector3d w_dot = nu_dot.tail<3>();
  Vector6d wrench;
  wrench.head<3>() = mass_kg * (nu_dot.head<3>() + w.cross(v) + w_dot.cross(r_g) + w.cross(w.cross(r_g)));
  wrench.tail<3>() = inertia * w_dot;
  return wrench;
}

}  // namespace sim
