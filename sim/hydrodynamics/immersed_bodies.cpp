#include "sim/hydrodynamics/immersed_bodies.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <limits>

#include "sim/config/message_text.hpp"

namespace sim {

namespace {

/// Skin friction: a drag that grows with the speed instead of its square below this speed.  Without it no swing ends.
constexpr double slow_mps = 0.005;
/// In waves a part is cut into sections of this length, but not into more than 8.
constexpr double section_m = 0.25;

Matrix3d cross_matrix(const Vector3d& v) {
  Matrix3d m;
  m << 0, -v.z(), v.y(), v.z(), 0, -v.x(), -v.y(), v.x(), 0;
  return m;
}

}  // namespace

/// Sums over the pieces of a body, about its centre of mass, in the world's axes.
struct ImmersedBodies::Wrench {
  Matrix3d R_WB;
  Vector3d p_WB, p_WC, v_WC_W, w_W;
  Vector3d force_N = Vector3d::Zero(), torque_Nm = Vector3d::Zero();  ///< all but drag
  Vector3d drag_N = Vector3d::Zero(), drag_torque_Nm = Vector3d::Zero();
  double linear_rate_kgps = 0;  ///< bound of d(drag force) / d(velocity)
  double angular_rate_Nms = 0;  ///< bound of d(drag torque) / d(rate)
  double added_kg = 0;          ///< added mass
  double solver_mass_kg = 0;    ///< of add_stiffness(), upwards
  Vector3d added_moment_kgm = Vector3d::Zero();
  Matrix3d added_inertia_kgm2 = Matrix3d::Zero();
  bool wet = false;
  bool afloat = false;  ///< the surface cuts a piece

  void add_drag(const ImmersedPiece& piece, double share, double density, const Vector3d& v_fluid_W,
                const Vector3d& at_CP_W, const Matrix3d& R_WP);
  void add_added_mass(double mass_kg, const Vector3d& at_CP_W, const Vector3d& a_fluid_W);
};

double ImmersedBodies::add(Body& body, const BodyConfig& config, double gravity_mps2,
                           std::vector<std::string>& warnings) {
  ImmersedBody added;
  added.body = &body;
  added.pieces = pieces_of(body, config, std::numeric_limits<double>::infinity(), warnings);
  if (added.pieces.empty()) return 0;
  find_stiffness(added, gravity_mps2, warnings);
  if (medium_.has_waves()) {
    std::vector<std::string> known;
    added.pieces = pieces_of(body, config, section_m, known);
  }
  for (const ImmersedPiece& piece : added.pieces) {
    added.radius_m = std::max(added.radius_m, piece.p_BP.norm() + piece.radius_m);
    added.added_mass |= piece.added_mass_coefficient > 0;
  }
  added.smallest_inertia_kgm2 = body.inertia_C_B().diagonal().minCoeff();
  bodies_.push_back(std::move(added));
  return bodies_.back().radius_m;
}

std::vector<ImmersedPiece> ImmersedBodies::pieces_of(const Body& body, const BodyConfig& config, double longest_m,
                                                     std::vector<std::string>& warnings) {
  std::vector<ImmersedPiece> pieces;
  for (const PartConfig& part : config.parts) {
    std::optional<std::string> warning;
    for (ImmersedPiece& piece : sim::pieces_of(part, longest_m, "body '" + body.name() + "'", meshes_, warning))
      pieces.push_back(std::move(piece));
    if (warning) warnings.push_back(*warning);
  }
  return pieces;
}

/// A body that is light for its water line can have swings faster than the step can follow: semi-implicit Euler does up
/// to h w = 2.  From sqrt(2) on these springs are followed by backward Euler, which is stable for any, and brakes.
void ImmersedBodies::find_stiffness(ImmersedBody& body, double gravity_mps2, std::vector<std::string>& warnings) const {
  const LocalWater water = medium_.water_at(body.body->X_WB().translation());
  const double pressure = water.density_kgpm3 * std::abs(gravity_mps2);  // per metre
  double heave_Npm = 0;
  Vector3d turn_Nmprad = Vector3d::Zero();
  for (const ImmersedPiece& piece : body.pieces) {
    // The largest water planes that the extents in the axes of the body allow.
    const Vector3d size = piece.R_BP.cwiseAbs() * piece.size_m;
    heave_Npm += pressure * size.prod() / size.minCoeff();
    const Vector3d p_CP = piece.p_BP - body.body->p_BC();
    for (int i = 0; i < 3; ++i)
      for (const int j : {(i + 1) % 3, (i + 2) % 3})
        turn_Nmprad[i] =
            std::max(turn_Nmprad[i], pressure * size[i] * size[j] * (size[j] * size[j] / 12 + p_CP[j] * p_CP[j]));
  }
  const double most = 2 / (step_s_ * step_s_);
  double fastest = heave_Npm / body.body->mass_kg();
  if (fastest > most) body.stiff_Npm = heave_Npm;
  for (int i = 0; i < 3; ++i) {
    const double square = turn_Nmprad[i] / body.body->inertia_C_B()(i, i);
    if (square > most) body.stiff_Nmprad[i] = turn_Nmprad[i];
    fastest = std::max(fastest, square);
  }
  body.stiff = fastest > most;
  if (!body.stiff) return;
  warnings.push_back("body '" + body.body->name() + "': it is so light that it swings in the water faster than " +
                     "'step_s' " + number_text(step_s_) + " can follow, and is braked; a step below " +
                     number_text(std::floor(std::sqrt(2 / fastest) * 1e4) / 1e4) + " s would follow it");
}

void ImmersedBodies::remove_group(int group) {
  std::erase_if(bodies_, [&](const ImmersedBody& body) { return body.body->group() == group; });
}

void ImmersedBodies::step(double gravity_mps2, std::span<const BodyInWater> around) {
  for (const ImmersedBody& body : bodies_) {
    const LocalWater& at_origin = around[static_cast<std::size_t>(body.body->number())].water;
    step_body(body, gravity_mps2, at_origin);
  }
}

void ImmersedBodies::step_body(const ImmersedBody& body, double gravity_mps2, const LocalWater& at_origin) const {
  const Pose X_WB = body.body->X_WB();
  if (X_WB.translation().z() - body.radius_m > medium_.highest_surface_m()) return;
  Wrench sum;
  sum.R_WB = X_WB.linear();
  sum.p_WB = X_WB.translation();
  sum.p_WC = X_WB * body.body->p_BC();
  sum.v_WC_W = body.body->velocity_at_W(body.body->p_BC());
  sum.w_W = body.body->w_WB_W();
  for (const ImmersedPiece& piece : body.pieces) add_piece(piece, gravity_mps2, at_origin, sum);
  if (!sum.wet) return;
  add_wind(body, sum);

  // Drag of an explicit step must not turn the motion round.
  const double mass = body.body->mass_kg();
  const double rate =
      std::max(sum.linear_rate_kgps / (mass + sum.added_kg), sum.angular_rate_Nms / body.smallest_inertia_kgm2);
  const double drag_share = rate * step_s_ > 1 ? 1 / (rate * step_s_) : 1;
  sum.force_N += drag_share * sum.drag_N;
  sum.torque_Nm += drag_share * sum.drag_torque_Nm;

  const bool stiff = body.stiff && sum.afloat;
  if (!body.added_mass && !stiff) {
    body.body->add_force_W(sum.force_N, sum.p_WC);
    body.body->add_torque_W(sum.torque_Nm);
    return;
  }
  if (stiff) add_stiffness(body, at_origin, sum);
  apply_with_added_mass(*body.body, gravity_mps2, sum);
}

/// Backward Euler: the force of the spring at the end of the step, for heave and for turning about level axes.
void ImmersedBodies::add_stiffness(const ImmersedBody& body, const LocalWater& water, Wrench& sum) const {
  const double h = step_s_;
  Matrix3d turning = sum.R_WB * body.stiff_Nmprad.asDiagonal() * sum.R_WB.transpose();
  turning.row(2).setZero();
  turning.col(2).setZero();
  sum.force_N.z() -= h * body.stiff_Npm * (sum.v_WC_W.z() - water.velocity_W.z());
  sum.torque_Nm -= h * turning * sum.w_W;
  sum.solver_mass_kg = h * h * body.stiff_Npm;
  sum.added_inertia_kgm2 += h * h * turning;
}

/// ODE knows rigid mass only: solves with the added mass, and hands over the force that gives this acceleration.
void ImmersedBodies::apply_with_added_mass(Body& body, double gravity_mps2, const Wrench& sum) {
  const Matrix3d I_W = sum.R_WB * body.inertia_C_B() * sum.R_WB.transpose();
  const Vector3d weight(0, 0, -body.mass_kg() * gravity_mps2);  // ODE adds it, and this torque too
  const Vector3d gyroscopic = sum.w_W.cross(I_W * sum.w_W);
  Eigen::Matrix<double, 6, 6> M;
  const Matrix3d S = cross_matrix(sum.added_moment_kgm);
  M.topLeftCorner<3, 3>() = (body.mass_kg() + sum.added_kg) * Matrix3d::Identity();
  M(2, 2) += sum.solver_mass_kg;
  M.topRightCorner<3, 3>() = -S;
  M.bottomLeftCorner<3, 3>() = S;
  M.bottomRightCorner<3, 3>() = I_W + sum.added_inertia_kgm2;
  Eigen::Matrix<double, 6, 1> f;
  f << body.applied_force_W() + sum.force_N + weight, body.applied_torque_W() + sum.torque_Nm - gyroscopic;
  const Eigen::Matrix<double, 6, 1> a = M.llt().solve(f);
  body.set_applied_W(body.mass_kg() * a.head<3>() - weight, I_W * a.tail<3>() + gyroscopic);
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
                               Wrench& sum) const {
  const Vector3d p_BP_W = sum.R_WB * piece.p_BP, p_WP = sum.p_WB + p_BP_W;
  // Near the origin of the body the water is that of the origin, unless there are waves.
  constexpr double near_m = 0.5;
  const bool looks = medium_.has_waves() || p_BP_W.squaredNorm() > near_m * near_m;
  const LocalWater water = looks ? medium_.water_at(p_WP) : at_origin;
  if (p_WP.z() - piece.radius_m > water.surface_m + (medium_.has_waves() ? piece.radius_m : 0)) return;
  const Matrix3d R_WP = sum.R_WB * piece.R_BP;
  ImmersedVolume immersed = piece.whole;
  if (p_WP.z() + piece.radius_m > water.surface_m - (medium_.has_waves() ? piece.radius_m : 0)) {
    const WaterPlane plane = surface_at(piece, p_WP, water);
    sum.afloat = true;
    immersed = piece.immersed({R_WP.transpose() * plane.normal, plane.level_m});
  }
  if (immersed.volume_m3 <= 0) return;
  sum.wet = true;
  const Vector3d at_CP_W = p_WP + R_WP * immersed.centroid_m - sum.p_WC;
  const double displaced_kg = water.density_kgpm3 * immersed.volume_m3;
  // Froude and Krylov: the pressure that accelerates the water pushes what is in its place.
  const Vector3d lift = displaced_kg * (Vector3d(0, 0, gravity_mps2) + water.acceleration_W);
  sum.force_N += lift;
  sum.torque_Nm += at_CP_W.cross(lift);
  const double share = immersed.volume_m3 / piece.whole.volume_m3;
  // The pressure on a round side goes through its axis, however deep it lies.
  Vector3d pressed_P = immersed.centroid_m;
  if (piece.shape == ImmersedPiece::Shape::round) pressed_P.x() = pressed_P.y() = 0;
  if (piece.shape == ImmersedPiece::Shape::sphere) pressed_P.setZero();
  sum.add_drag(piece, share, water.density_kgpm3, water.velocity_W, p_WP + R_WP * pressed_P - sum.p_WC, R_WP);
  if (piece.added_mass_coefficient > 0)
    sum.add_added_mass(piece.added_mass_coefficient * displaced_kg, at_CP_W, water.acceleration_W);
}

void ImmersedBodies::Wrench::add_drag(const ImmersedPiece& piece, double share, double density,
                                      const Vector3d& v_fluid_W, const Vector3d& at_CP_W, const Matrix3d& R_WP) {
  const Vector3d v_P = R_WP.transpose() * (v_WC_W + w_W.cross(at_CP_W) - v_fluid_W);
  const Vector3d w_P = R_WP.transpose() * w_W;
  const double pressure = 0.5 * density * share;
  const double speed = v_P.norm() + slow_mps, rate = w_P.norm() + slow_mps / piece.radius_m;
  const Vector3d force = R_WP * (-pressure * speed * piece.drag_area_m2.cwiseProduct(v_P));
  drag_N += force;
  drag_torque_Nm += at_CP_W.cross(force) + R_WP * (-pressure * rate * piece.angular_drag_area_m5.cwiseProduct(w_P));
  const double linear = 2 * pressure * speed * piece.drag_area_m2.maxCoeff();
  linear_rate_kgps += linear;
  angular_rate_Nms += linear * at_CP_W.squaredNorm() + 2 * pressure * rate * piece.angular_drag_area_m5.maxCoeff();
}

/// Water that goes along sits as a mass at the centroid of what is under water.
void ImmersedBodies::Wrench::add_added_mass(double mass_kg, const Vector3d& at_CP_W, const Vector3d& a_fluid_W) {
  added_kg += mass_kg;
  added_moment_kgm += mass_kg * at_CP_W;
  added_inertia_kgm2 += mass_kg * (at_CP_W.squaredNorm() * Matrix3d::Identity() - at_CP_W * at_CP_W.transpose());
  const Vector3d force = mass_kg * (a_fluid_W - w_W.cross(w_W.cross(at_CP_W)));
  force_N += force;
  torque_Nm += at_CP_W.cross(force);
}

/// On the parts over water of a body that swims.
void ImmersedBodies::add_wind(const ImmersedBody& body, Wrench& sum) const {
  const Vector3d wind_W = medium_.air_velocity_W(sum.p_WC);
  if (wind_W.isZero(0)) return;
  for (const ImmersedPiece& piece : body.pieces) {
    const Vector3d p_WP = sum.p_WB + sum.R_WB * piece.p_BP;
    const double over = p_WP.z() - medium_.surface_m(p_WP.x(), p_WP.y());
    const double share = std::clamp(0.5 + over / (2 * piece.radius_m), 0.0, 1.0);
    constexpr double air_density_kgpm3 = 1.225;
    if (share > 0) sum.add_drag(piece, share, air_density_kgpm3, wind_W, p_WP - sum.p_WC, sum.R_WB * piece.R_BP);
  }
}

}  // namespace sim
