// SPDX-License-Identifier: BSD-3-Clause
#include "sim/model/hydrodynamics_config.hpp"

#include <cassert>
#include <cmath>
#include <numbers>
#include <optional>

#include "sim/base/number.hpp"
#include "sim/config/message_text.hpp"

namespace sim {
namespace {

/// Signs that convert components from forward-left-up to forward-right-down.
const Vector6d flip = (Vector6d() << 1, -1, -1, 1, -1, -1).finished();

Vector3d to_frd(const Vector3d& v) {
  return {v.x(), -v.y(), -v.z()};
}

/// Reads a matrix: n numbers (diagonal) or n x n numbers, row by row.
template <int n>
void read_matrix(ParamReader& in, const char* key, Eigen::Matrix<double, n, n>& matrix, const char* meaning) {
  std::vector<double> values;
  in.read(key, values, any_number(), meaning);
  if (in.describing() || !in.has(key)) return;
  if (values.size() == n) {
    matrix = Eigen::Map<const Eigen::Matrix<double, n, 1>>(values.data()).asDiagonal();
  } else if (values.size() == n * n) {
    matrix = Eigen::Map<const Eigen::Matrix<double, n, n, Eigen::RowMajor>>(values.data());
  } else {
    in.error(key, std::string("'") + key + "' must have " + std::to_string(n) + " numbers (the diagonal) or " +
                      std::to_string(n * n) + " (row by row), got " + std::to_string(values.size()));
  }
}

enum class InertiaAbout { center_of_mass, origin };

/// Section `added_mass_of_spheroid:`.
struct SpheroidConfig {
  double half_length_m = 1, radius_m = 0.1, density_kgpm3 = 1025;
  void read(ParamReader& in) {
    in.require("half_length_m");
    in.read("half_length_m", half_length_m, above_to(0, 1000), "half the length of the hull");
    in.require("radius_m");
    in.read("radius_m", radius_m, above_to(0, 1000), "radius of the hull, at most half its length");
    in.read("density_kgpm3", density_kgpm3, above(0), "density of the water");
    if (half_length_m < radius_m)
      in.error("radius_m", "'radius_m' must be <= 'half_length_m' " + number_text(half_length_m) + ", got " +
                               number_text(radius_m));
  }
};

/// Returns true when the force changes sign with the motion, for a hull symmetric about its vertical and horizontal
/// planes: surge in X; sway, roll and yaw in Y, K and N; heave and pitch in Z and M.  Other quadratic terms, such as
/// X_vv and M_rr, are even in the velocity.
bool reverses(int row, int motion) {
  constexpr int plane[] = {0, 1, 2, 1, 2, 1};
  return plane[row] == plane[motion];
}

/// Parses the name of a derivative: `X_uu`, `Y_uv`, `N_|v|r`, `M_qdot`.  Returns false for other names.  `second` is -2
/// for an acceleration.
bool parse_derivative(std::string_view name, DerivativeTerm& term) {
  if (name.size() < 3 || name[1] != '_') return false;
  // Row: force or moment.
  const auto row = derivative_rows.find(name[0]);
  if (row == std::string_view::npos) return false;
  term.row = static_cast<int>(row);
  name.remove_prefix(2);
  // States, with bars around the one whose absolute value is taken.
  const auto state = [](char c) { return static_cast<int>(derivative_states.find(c)); };
  const bool bars = name.size() == 4 && ((name[0] == '|' && name[2] == '|') || (name[1] == '|' && name[3] == '|'));
  std::string letters;
  if (bars && name[0] == '|') letters = {name[1], name[3]};
  if (bars && name[1] == '|') letters = {name[2], name[0]};
  if (!bars) letters = name;
  // Acceleration.
  if (letters.size() == 4 && letters.substr(1) == "dot") {
    term.first = state(letters[0]);
    term.second = -2;
    return term.first >= 0;
  }
  // One or two velocities.
  if (letters.empty() || letters.size() > 2) return false;
  term.first = state(letters[0]);
  term.second = letters.size() == 2 ? state(letters[1]) : -1;
  term.absolute =
      letters.size() == 2 && (bars || (letters[0] == letters[1] && term.first >= 0 && reverses(term.row, term.first)));
  return term.first >= 0 && (letters.size() == 1 || term.second >= 0);
}

}  // namespace

void CrossFlowConfig::read(ParamReader& in) {
  in.require("length_m");
  in.read("length_m", length_m, above_to(0, 1000), "length of the hull, half of it before the origin");
  in.require("height_m");
  in.read("height_m", height_m, above_to(0, 1000), "diameter of a round hull, draft of a boat");
  in.read("density_kgpm3", density_kgpm3, above(0), "instead of the water's");
  in.read("drag_coefficient", drag_coefficient, at_least(0),
          "drag coefficient of a strip: one number, or pairs of Reynolds number and coefficient");
  const std::size_t count = drag_coefficient.size();
  if (count == 0 || (count > 1 && count % 2 != 0))
    in.error("drag_coefficient", "'drag_coefficient' must be one number or pairs, got " + std::to_string(count));
  for (std::size_t i = 2; count > 2 && count % 2 == 0 && i < count; i += 2)
    if (drag_coefficient[i] < drag_coefficient[i - 2])
      in.error("drag_coefficient", "the Reynolds numbers of 'drag_coefficient' must increase, got " +
                                       number_text(drag_coefficient[i - 2]) + " before " +
                                       number_text(drag_coefficient[i]));
  in.read("reynolds_length_m", reynolds_length_m, above(0), "length in the Reynolds number");
  in.read("kinematic_viscosity_m2ps", kinematic_viscosity_m2ps, above(0),
          "kinematic viscosity of the water, for the Reynolds number");
  in.read_or_word(
      "strips", strips, between(2, 1000), {"exact"},
      "number of points of a sum with full weight at both ends, as in some references; exact: the integral");
}

void HullLiftConfig::read(ParamReader& in) {
  in.require("area_m2");
  in.read("area_m2", area_m2, above(0), "reference area");
  in.read("density_kgpm3", density_kgpm3, above(0), "instead of the water's");
  in.read("lift_slope", lift_slope, at_least(0), "dC_L/d(alpha), per rad");
  in.read("drag_coefficient", drag_coefficient, at_least(0), "C_D without lift");
  in.read("induced_drag", induced_drag, at_least(0), "C_D grows by this times C_L squared");
}

void WaterlineConfig::read(ParamReader& in) {
  in.read("length_m", length_m, above(0), "length of the water plane: the waves are felt at its ends");
  in.read("beam_m", beam_m, above(0), "beam of the water plane");
  in.require("heave_Npm");
  in.read("heave_Npm", heave_Npm, above(0), "stiffness in heave: density, gravity and area of the water plane");
  in.read("heave_pitch_N", heave_pitch_N, any_number(), "couples heave and pitch: force per rad, moment per m");
  in.read("roll_Nmprad", roll_Nmprad, above(0), "stiffness in roll: weight times metacentric height");
  in.read("pitch_Nmprad", pitch_Nmprad, above(0), "stiffness in pitch");
  in.read("load_kg", load_kg, at_least(0), "payload that the trim of the frame does not include");
  in.read("load_at_m", load_at_m, between(-1000, 1000), "position of the payload");
}

void WindageConfig::read(ParamReader& in) {
  in.require("frontal_area_m2");
  in.read("frontal_area_m2", frontal_area_m2, at_least(0), "projected above the water, seen from ahead");
  in.require("lateral_area_m2");
  in.read("lateral_area_m2", lateral_area_m2, at_least(0), "projected above the water, seen from the side");
  in.read("surge_coefficient", surge_coefficient, between(0, 5),
          "surge coefficient of the force ahead; 0.5 to 0.9 for ships");
  in.read("sway_coefficient", sway_coefficient, between(0, 5),
          "sway coefficient of the force sideways; 0.7 to 0.95 for ships");
  in.read("yaw_coefficient", yaw_coefficient, between(-1, 1),
          "yaw coefficient of the moment about the vertical; 0.05 to 0.2 for ships");
  in.read("height_m", height_m, between(-100, 100), "height of the middle of the lateral area over the origin");
  in.read("length_m", length_m, above(0), "over all");
}

void PublishedQuirks::read(ParamReader& in) {
  in.read_choice("added_mass_coriolis", added_mass_coriolis,
                 {{"full", Coriolis::full}, {"without_munk", Coriolis::without_munk}, {"none", Coriolis::none}},
                 "without_munk: no Munk moment in pitch and yaw, as in MSS remus100; none: to see the difference");
  in.read_choice("current", current, {{"full", Current::full}, {"yaw_only", Current::yaw_only}},
                 "yaw_only: the current is rotated into the body frame by yaw alone, as in MSS");
  in.read("surge_damping_fade_spm", surge_damping_fade_spm, at_least(0),
          "linear surge damping falls with exp(-this times speed)");
  in.read_choice("fade_speed", fade_speed, {{"water", FadeSpeed::water}, {"ground", FadeSpeed::ground}},
                 "ground: sqrt(u + v^2) over ground, as in MSS remus100");
}

void HydrodynamicsConfig::read(ParamReader& in) {
  if (in.node() != nullptr) place = in.node()->place;
  in.read_choice("model", model, {{"coefficients", Model::coefficients}, {"none", Model::none}},
                 "coefficients: as published for this vehicle; none: no hydrodynamic forces");
  in.read_choice("frame", frame, axes_frame_words, "axes of the numbers: frd as printed in papers, flu as of bodies");
  // Mass and inertia.
  if (model == Model::coefficients) in.require("mass_kg");
  in.read("mass_kg", mass_kg, between(1e-9, 1e12), "mass of the body, instead of that of its parts");
  in.read("center_of_mass_m", center_of_mass_m, between(-1000, 1000), "in the body's frame");
  if (model == Model::coefficients) in.require("inertia_kgm2");
  read_matrix<3>(in, "inertia_kgm2", inertia_kgm2,
                 "3 numbers (diagonal) or 9, row by row; products of inertia negative");
  InertiaAbout about = InertiaAbout::center_of_mass;
  in.read_choice("inertia_about", about,
                 {{"center_of_mass", InertiaAbout::center_of_mass}, {"origin", InertiaAbout::origin}},
                 "point that the inertia is about");
  // Weight and buoyancy.
  in.read("weight_N", weight_N, above(0), "instead of mass times gravity");
  in.read("buoyancy_N", buoyancy_N, at_least(0), "buoyancy of the whole vehicle under water; unset: of volume_m3");
  in.read("volume_m3", volume_m3, above(0), "volume of displaced water; unset: it floats in balance");
  if (buoyancy_N && volume_m3) in.error("volume_m3", "needs either 'buoyancy_N' or 'volume_m3', not both");
  in.read("center_of_buoyancy_m", center_of_buoyancy_m, between(-1000, 1000), "in the body's frame");
  in.read("hull_height_m", hull_height_m, above(0),
          "height over which it emerges; unset: that of a ball of its volume");
  in.read("hull_length_m", hull_length_m, at_least(0), "height over which it emerges when it stands upright");
  // Added mass.
  read_matrix<6>(in, "added_mass", added_mass, "6 numbers (diagonal) or 36, row by row; positive as mass");
  std::optional<SpheroidConfig> spheroid;
  in.read("added_mass_of_spheroid", spheroid, "instead of added_mass: that of a spheroid about the origin");
  if (spheroid && in.has("added_mass"))
    in.error("added_mass_of_spheroid", "only one of 'added_mass' and 'added_mass_of_spheroid'");
  if (spheroid && spheroid->half_length_m >= spheroid->radius_m)
    added_mass = spheroid_added_mass(spheroid->half_length_m, spheroid->radius_m, spheroid->density_kgpm3).asDiagonal();
  // Damping.
  read_matrix<6>(in, "linear_damping", linear_damping, "6 or 36 numbers; positive values damp");
  read_matrix<6>(in, "quadratic_damping", quadratic_damping,
                 "6 or 36 numbers, times |speed| speed; positive values damp");
  // Convert to forward-right-down.
  if (frame == AxesFrame::flu) {
    const Matrix6d P = flip.asDiagonal();
    for (Matrix6d* matrix : {&added_mass, &linear_damping, &quadratic_damping}) *matrix = (P * *matrix * P).eval();
    const Matrix3d P3 = flip.head<3>().asDiagonal();
    inertia_kgm2 = (P3 * inertia_kgm2 * P3).eval();
    center_of_mass_m = to_frd(center_of_mass_m);
    center_of_buoyancy_m = to_frd(center_of_buoyancy_m);
  }
  // Derivatives by name.
  ConfigNode named;
  in.read_raw("derivatives", named,
              "forces in SNAME notation, signs as printed: X_uu: -1.62, Y_uv: -28.6, Z_wdot: -35.5");
  for (const ConfigNode::Entry& entry : named.entries) {
    DerivativeTerm term;
    const std::optional<double> number = read_number(entry.value.scalar);
    term.coefficient = number.value_or(0);
    if (!parse_derivative(entry.key, term)) {
      in.diagnostics().error(
          entry.place, in.who(),
          "'" + shortened(printable(entry.key)) +
              "' is not a derivative: X_u, X_uu, Y_uv, N_|v|r, Z_wdot with rows XYZKMN, states uvwpqr");
      continue;
    }
    // Check that the value is a finite number.
    if (entry.value.kind != ConfigNode::Kind::scalar || !number || !std::isfinite(*number)) {
      in.diagnostics().error(entry.value.place, in.who(),
                             "'" + entry.key + "' must be a number, got " + shown(entry.value));
      continue;
    }
    // Convert the sign to forward-right-down.
    if (frame == AxesFrame::flu) {
      double sign = flip[term.row];
      if (!term.absolute) sign *= flip[term.first];
      if (term.second >= 0) sign *= flip[term.second];
      term.coefficient *= sign;
    }
    // Acceleration derivatives are part of the added mass.
    if (term.second == -2)
      added_mass(term.row, term.first) -= term.coefficient;
    else
      derivatives.push_back(term);
  }
  // Optional models.
  in.read("cross_flow", cross_flow, "drag of a slender hull across its axis");
  in.read("hull_lift", hull_lift, "lift and drag of the hull by its angle of attack");
  in.read("waterline", waterline, "waterline of a surface craft: restoring forces against the surface");
  if (frame == AxesFrame::flu && waterline) {
    waterline->load_at_m = to_frd(waterline->load_at_m);
  }
  in.read("windage", windage, "wind force on the part above the water");
  in.read("quirks", quirks, "deviations of published models from physics");
  // Shift the inertia to the center of mass (parallel axis theorem).
  if (about == InertiaAbout::origin) {
    const Vector3d& r = center_of_mass_m;
    inertia_kgm2 -= mass_kg * (r.squaredNorm() * Matrix3d::Identity() - r * r.transpose());
  }
  check_coefficients(*this, in);
}

Vector6d spheroid_added_mass(double half_length_m, double radius_m, double density_kgpm3) {
  assert(half_length_m >= radius_m && radius_m > 0);
  const double a = half_length_m, b = radius_m;
  const double mass = 4.0 / 3 * std::numbers::pi * density_kgpm3 * a * b * b;
  const double e2 = 1 - (b / a) * (b / a), e = std::sqrt(e2);
  // Use the limit of a sphere for small eccentricity, where the formulas suffer from cancellation.
  if (e < 1e-2) return mass * (Vector6d() << 0.5, 0.5, 0.5, 0, 0, 0).finished();
  // Shape factors alpha_0 and beta_0 (Lamb, article 114).
  const double logarithm = std::log((1 + e) / (1 - e));
  const double alpha = 2 * (1 - e2) / (e2 * e) * (logarithm / 2 - e);
  const double beta = 1 / e2 - (1 - e2) / (2 * e2 * e) * logarithm;
  // Added mass over displaced mass, along and across the axis, and for rotation.
  const double along = alpha / (2 - alpha), across = beta / (2 - beta);
  const double turning = e2 * e2 * (beta - alpha) / ((2 - e2) * (2 * e2 - (2 - e2) * (beta - alpha)));
  const double inertia = mass * (a * a + b * b) / 5;
  Vector6d added;
  added << along * mass, across * mass, across * mass, 0, turning * inertia, turning * inertia;
  return added;
}

}  // namespace sim
