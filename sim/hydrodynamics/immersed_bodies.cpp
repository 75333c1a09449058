// SPDX-License-Identifier: BSD-3-Clause
#include "sim/hydrodynamics/immersed_bodies.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <limits>

#include "sim/base/first_failure.hpp"
#include "sim/config/message_text.hpp"

namespace sim {

namespace {

/// Length of the sections into which a part is cut in waves; at most 8 sections.
constexpr double section_m = 0.25;

}  // namespace

/// Sums over the pieces of a body, about its center of mass, in world axes.
struct ImmersedBodies::Wrench {
  Matrix3d R_WB;
  Vector3d p_WB, p_WC, v_WC_W, w_W;
  Vector3d force_N = Vector3d::Zero(), torque_Nm = Vector3d::Zero();  ///< without drag
  double lift_N = 0;                                                  ///< buoyancy, upwards
  double added_kg = 0;                                                ///< added mass
  double solver_mass_kg = 0;                                          ///< of add_stiffness(), upwards
  Vector3d added_moment_kgm = Vector3d::Zero();
  Matrix3d added_inertia_kgm2 = Matrix3d::Zero();
  bool wet = false;
  bool afloat = false;  ///< the surface cuts a piece

  void add_added_mass(double mass_kg, const Vector3d& at_CP_W, const Vector3d& a_fluid_W);
  Vector6d acceleration(double mass_kg, const Matrix3d& I_W, const Vector6d& f) const;
  Matrix6d mass_matrix(double mass_kg, const Matrix3d& I_W) const;
};

double ImmersedBodies::add(Body& body, const BodyConfig& config, double gravity_mps2, std::vector<Warning>& warnings) {
  ImmersedBody added;
  added.body = &body;
  added.pieces = pieces_of(body, config, std::numeric_limits<double>::infinity(), warnings);
  if (added.pieces.empty()) return 0;
  find_stiffness(added, config.place, gravity_mps2, warnings);
  // The stiffness is that of whole parts. For forces long parts are cut, so that a wave is felt at several sections.
  if (medium_.has_waves()) {
    std::vector<Warning> known;
    added.pieces = pieces_of(body, config, section_m, known);
  }
  for (const ImmersedPiece& piece : added.pieces) {
    added.radius_m = std::max(added.radius_m, piece.p_BP.norm() + piece.radius_m);
  }
  bodies_.push_back(std::move(added));
  return bodies_.back().radius_m;
}

std::vector<ImmersedPiece> ImmersedBodies::pieces_of(const Body& body, const BodyConfig& config, double max_m,
                                                     std::vector<Warning>& warnings) {
  const std::string who = "body '" + body.name() + "'";
  std::vector<ImmersedPiece> pieces;
  for (const PartConfig& part : config.parts) {
    std::optional<std::string> warning;
    for (ImmersedPiece& piece : sim::pieces_of(part, max_m, who, meshes_, warning)) pieces.push_back(std::move(piece));
    if (warning) warnings.push_back({part.place, who, *warning});
  }
  return pieces;
}

/// Finds hydrostatic stiffness that the step cannot resolve: a light body with a large water plane may oscillate faster
/// than semi-implicit Euler can follow, h w <= 2.  From h w = sqrt(2) on, these springs are integrated by backward
/// Euler, which is stable for any stiffness, and adds damping.
void ImmersedBodies::find_stiffness(ImmersedBody& body, const SourcePlace& place, double gravity_mps2,
                                    std::vector<Warning>& warnings) const {
  const LocalWater water = medium_.water_at(body.body->X_WB().translation());
  const double pressure = water.density_kgpm3 * std::abs(gravity_mps2);  // per meter
  double heave_Npm = 0;
  Vector3d turn_Nmprad = Vector3d::Zero();
  for (const ImmersedPiece& piece : body.pieces) {
    // Upper bounds of the water planes from the extents in body axes.
    const Vector3d size = piece.R_BP.cwiseAbs() * piece.size_m;
    heave_Npm += pressure * size.prod() / size.minCoeff();
    const Vector3d p_CP = piece.p_BP - body.body->p_BC();
    for (int i = 0; i < 3; ++i)
      for (const int j : {(i + 1) % 3, (i + 2) % 3})
        turn_Nmprad[i] =
            std::max(turn_Nmprad[i], pressure * size[i] * size[j] * (size[j] * size[j] / 12 + p_CP[j] * p_CP[j]));
  }
  // Compare the squared frequencies with the limit of the step.
  const double max = 2 / (step_s_ * step_s_);
  double fastest = heave_Npm / body.body->mass_kg();
  if (fastest > max) body.stiff_Npm = heave_Npm;
  for (int i = 0; i < 3; ++i) {
    const double square = turn_Nmprad[i] / body.body->inertia_C_B()(i, i);
    if (square > max) body.stiff_Nmprad[i] = turn_Nmprad[i];
    fastest = std::max(fastest, square);
  }
  body.stiff = fastest > max;
  if (!body.stiff) return;
  body.body->use_first_order();  // these springs are integrated for its step
  warnings.push_back({place, "body '" + body.body->name() + "'",
                      "it is so light that it oscillates in the water faster than 'step_s' " + number_text(step_s_) +
                          " resolves, and is damped; use a step below " +
                          number_text(std::floor(std::sqrt(2 / fastest) * 1e4) / 1e4) + " s"});
}

void ImmersedBodies::remove_group(int group) {
  std::erase_if(bodies_, [&](const ImmersedBody& body) { return body.body->group() == group; });
}

void ImmersedBodies::step(double gravity_mps2, std::span<const BodyInWater> around, ThreadPool* threads) {
  FirstFailure failure;
  for_each_block(threads, bodies_.size(), [&](std::size_t begin, std::size_t end) {
    // One for each block of bodies: its lists keep their memory.
    ImmersedDrag drag;
    for (std::size_t i = begin; i < end; ++i) {
      const ImmersedBody& body = bodies_[i];
      try {
        step_body(body, gravity_mps2, around[static_cast<std::size_t>(body.body->number())], drag);
      } catch (...) {
        failure.take(i);
      }
    }
  });
  failure.rethrow();
}

void ImmersedBodies::step_body(const ImmersedBody& body, double gravity_mps2, const BodyInWater& around,
                               ImmersedDrag& drag) const {
  const LocalWater& at_origin = around.water;
  const BodyMotion& motion = around.motion;
  // Nothing of the body is below the highest possible crest. This test spares a world with water most of its dry
  // bodies.
  if (motion.p_WB.z() - body.radius_m > medium_.highest_surface_m()) return;
  Wrench sum;
  sum.R_WB = motion.R_WB;
  sum.p_WB = motion.p_WB;
  const Vector3d p_BC_W = motion.R_WB * body.body->p_BC();
  sum.p_WC = motion.p_WB + p_BC_W;
  sum.w_W = motion.w_WB_W;
  sum.v_WC_W = motion.v_WB_W + sum.w_W.cross(p_BC_W);
  drag.begin(sum.R_WB, sum.v_WC_W, sum.w_W);
  for (const ImmersedPiece& piece : body.pieces) add_piece(piece, gravity_mps2, at_origin, drag, sum);
  if (!sum.wet) return;
  add_wind(body, drag, sum);
  if (body.stiff && sum.afloat) add_stiffness(body, at_origin, sum);
  // The drag is too stiff for the midpoint, where `around` was taken. Backward Euler is stable at any stiffness, but
  // starts from the motion at the start of the step, so everything is computed once more.
  if (!apply(*body.body, gravity_mps2, drag, sum)) {
    body.body->take_first_order_step(step_s_);
    BodyInWater at_start = around;
    at_start.motion = body.body->motion();
    step_body(body, gravity_mps2, at_start, drag);
  }
}

/// Adds the spring forces at the end of the step, for heave and for rotation about horizontal axes.  Heave is damped
/// four times as much as by backward Euler, so that a body rises to its water line without overshoot.  A body that
/// would leave the water within the step from below keeps its speed: buoyancy and drag fade together.
void ImmersedBodies::add_stiffness(const ImmersedBody& body, const LocalWater& water, Wrench& sum) const {
  const double h = step_s_;
  Matrix3d turning = sum.R_WB * body.stiff_Nmprad.asDiagonal() * sum.R_WB.transpose();
  turning.row(2).setZero();
  turning.col(2).setZero();
  sum.torque_Nm -= h * turning * sum.w_W;
  sum.added_inertia_kgm2 += h * h * turning;
  const double mass = body.body->mass_kg() + sum.added_kg;
  if (h * h * body.stiff_Npm <= 2 * mass) return;
  const double change_N = h * body.stiff_Npm * (sum.v_WC_W.z() - water.velocity_W.z());
  if (change_N > sum.lift_N) {
    sum.solver_mass_kg = 1e6 * mass;
    return;
  }
  constexpr double brake = 4;
  sum.force_N.z() -= brake * change_N;
  sum.solver_mass_kg = brake * h * h * body.stiff_Npm;
}

/// Applies the sum to the body.  ODE has no added mass: the acceleration is solved with added mass, and the force that
/// gives it to the rigid body is applied.  Returns false, and does nothing, when drag is too stiff for forces half-way.
bool ImmersedBodies::apply(Body& body, double gravity_mps2, ImmersedDrag& drag, const Wrench& sum) const {
  const double mass = body.mass_kg();
  const Matrix3d I_W = sum.R_WB * body.inertia_C_B() * sum.R_WB.transpose();
  const Vector3d weight(0, 0, -mass * gravity_mps2);  // ODE adds the weight, and the gyroscopic torque below
  const Vector3d gyroscopic = sum.w_W.cross(I_W * sum.w_W);
  Vector6d f;
  f << body.applied_force_W() + sum.force_N + weight, body.applied_torque_W() + sum.torque_Nm - gyroscopic;
  const Vector3d inertia = body.inertia_C_B().diagonal();
  const double dv = step_s_ * f.head<3>().norm() / (mass + sum.added_kg);
  const Vector3d dw = step_s_ * (sum.R_WB.transpose() * f.tail<3>()).cwiseAbs().cwiseQuotient(inertia);
  Vector6d a;
  if (drag.too_stiff(mass + sum.added_kg, inertia, dv, dw, step_s_)) {
    if (body.alone()) return false;
    a = drag.acceleration(sum.mass_matrix(mass, I_W), f, step_s_);
    body.take_first_order_step(step_s_);
  } else {
    f.head<3>() += drag.force_N();
    f.tail<3>() += drag.torque_Nm();
    a = sum.acceleration(mass, I_W, f);
  }
  body.set_applied_W(mass * a.head<3>() - weight, I_W * a.tail<3>() + gyroscopic);
  return true;
}

Matrix6d ImmersedBodies::Wrench::mass_matrix(double mass_kg, const Matrix3d& I_W) const {
  const Matrix3d S = cross_matrix(added_moment_kgm);
  Matrix6d M;
  M << (mass_kg + added_kg) * Matrix3d::Identity(), -S, S, I_W + added_inertia_kgm2;
  M(2, 2) += solver_mass_kg;
  return M;
}

/// Solves for the acceleration.  In the mass matrix [D, -S; S, J], D is diagonal: (J + S D^-1 S) w' = t - S D^-1 f, v'
/// = D^-1 (f + S w').
Vector6d ImmersedBodies::Wrench::acceleration(double mass_kg, const Matrix3d& I_W, const Vector6d& f) const {
  const double mass = mass_kg + added_kg;
  const Vector3d by_mass(1 / mass, 1 / mass, 1 / (mass + solver_mass_kg));
  const Matrix3d S = cross_matrix(added_moment_kgm), SD = S * by_mass.asDiagonal();
  const Matrix3d J = I_W + added_inertia_kgm2 + SD * S;
  Vector6d a;
  a.tail<3>() = J.inverse() * (f.tail<3>() - SD * f.head<3>());
  a.head<3>() = by_mass.cwiseProduct(f.head<3>() + added_moment_kgm.cross(a.tail<3>()));
  return a;
}

WaterPlane ImmersedBodies::surface_at(const ImmersedPiece& piece, const Vector3d& p_WP, const LocalWater& water) const {
  if (!medium_.has_waves()) return {Vector3d::UnitZ(), water.surface_m - p_WP.z()};
  const double reach = 0.5 * piece.radius_m;
  const auto height = [&](double x, double y) { return medium_.surface_m(p_WP.x() + x, p_WP.y() + y); };
  const double slope_x = (height(reach, 0) - height(-reach, 0)) / (2 * reach);
  const double slope_y = (height(0, reach) - height(0, -reach)) / (2 * reach);
  const Vector3d normal = Vector3d(-slope_x, -slope_y, 1).normalized();
  return {normal, (water.surface_m - p_WP.z()) * normal.z()};
}

void ImmersedBodies::add_piece(const ImmersedPiece& piece, double gravity_mps2, const LocalWater& at_origin,
                               ImmersedDrag& drag, Wrench& sum) const {
  const Vector3d p_BP_W = sum.R_WB * piece.p_BP, p_WP = sum.p_WB + p_BP_W;
  // Near the origin of the body the water values of the origin are used, unless there are waves.
  constexpr double near_m = 0.5;
  const bool looks = medium_.has_waves() || p_BP_W.squaredNorm() > near_m * near_m;
  const LocalWater water = looks ? medium_.water_at(p_WP) : at_origin;
  if (p_WP.z() - piece.radius_m > water.surface_m + (medium_.has_waves() ? piece.radius_m : 0)) return;
  const Matrix3d R_WP = sum.R_WB * piece.R_BP;
  ImmersedVolume immersed = piece.whole;
  if (p_WP.z() + piece.radius_m > water.surface_m - (medium_.has_waves() ? piece.radius_m : 0)) {
    const WaterPlane plane = surface_at(piece, p_WP, water);
    immersed = piece.immersed({R_WP.transpose() * plane.normal, plane.level_m});
    sum.afloat |= immersed.volume_m3 > 0 && immersed.volume_m3 < (1 - 1e-9) * piece.whole.volume_m3;
  }
  if (immersed.volume_m3 <= 0) return;
  sum.wet = true;
  const Vector3d at_CP_W = p_WP + R_WP * immersed.centroid_m - sum.p_WC;
  const double displaced_kg = water.density_kgpm3 * immersed.volume_m3;
  // Buoyancy and Froude-Krylov force: the pressure gradient that accelerates the water acts on the displaced volume.
  const Vector3d lift = displaced_kg * (Vector3d(0, 0, gravity_mps2) + water.acceleration_W);
  sum.force_N += lift;
  sum.lift_N += lift.z();
  sum.torque_Nm += at_CP_W.cross(lift);
  const double share = immersed.volume_m3 / piece.whole.volume_m3;
  // The pressure on a round side acts through its axis, at any depth.
  Vector3d pressed_P = immersed.centroid_m;
  if (piece.shape == ImmersedPiece::Shape::round) pressed_P.x() = pressed_P.y() = 0;
  if (piece.shape == ImmersedPiece::Shape::sphere) pressed_P.setZero();
  drag.add(piece, share, water.density_kgpm3, water.velocity_W, p_WP + R_WP * pressed_P - sum.p_WC, R_WP);
  if (piece.added_mass_coefficient > 0)
    sum.add_added_mass(piece.added_mass_coefficient * displaced_kg, at_CP_W, water.acceleration_W);
}

/// Adds the added mass as a point mass at the centroid of the submerged volume.
void ImmersedBodies::Wrench::add_added_mass(double mass_kg, const Vector3d& at_CP_W, const Vector3d& a_fluid_W) {
  added_kg += mass_kg;
  added_moment_kgm += mass_kg * at_CP_W;
  added_inertia_kgm2 += mass_kg * (at_CP_W.squaredNorm() * Matrix3d::Identity() - at_CP_W * at_CP_W.transpose());
  const Vector3d force = mass_kg * (a_fluid_W - w_W.cross(w_W.cross(at_CP_W)));
  force_N += force;
  torque_Nm += at_CP_W.cross(force);
}

/// Adds the wind drag on the parts above water of a floating body.
void ImmersedBodies::add_wind(const ImmersedBody& body, ImmersedDrag& drag, const Wrench& sum) const {
  const Vector3d wind_W = medium_.air_velocity_W(sum.p_WC);
  if (wind_W.isZero(0)) return;
  for (const ImmersedPiece& piece : body.pieces) {
    const Vector3d p_WP = sum.p_WB + sum.R_WB * piece.p_BP;
    const double over = p_WP.z() - medium_.surface_m(p_WP.x(), p_WP.y());
    const double share = std::clamp(0.5 + over / (2 * piece.radius_m), 0.0, 1.0);
    constexpr double air_density_kgpm3 = 1.225;
    if (share > 0) drag.add(piece, share, air_density_kgpm3, wind_W, p_WP - sum.p_WC, sum.R_WB * piece.R_BP);
  }
}

}  // namespace sim
