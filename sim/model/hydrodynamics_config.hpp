// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "sim/base/math.hpp"
#include "sim/config/choice_words.hpp"
#include "sim/config/param_reader.hpp"

namespace sim {

using Vector6d = Eigen::Matrix<double, 6, 1>;
using Matrix6d = Eigen::Matrix<double, 6, 6>;

/// Axes of the coefficients: forward-left-up as in body frames, or forward-right-down as in the literature.
enum class AxesFrame { flu, frd };

inline constexpr ChoiceWords<AxesFrame> axes_frame_words{{"flu", AxesFrame::flu}, {"frd", AxesFrame::frd}};

/// Letters in the names of hydrodynamic derivatives: forces and moments, and velocities (SNAME 1950).
inline constexpr std::string_view derivative_rows = "XYZKMN";
inline constexpr std::string_view derivative_states = "uvwpqr";

/// Hydrodynamic derivative in the notation of SNAME (1950): `coefficient` times one or two components of the velocity,
/// such as Y_uv (u v), N_rr (|r| r), X_rr (r r), X_u.  Rows 0 to 5 are X, Y, Z, K, M, N; states 0 to 5 are u, v, w, p,
/// q, r.
struct DerivativeTerm {
  int row = 0;
  int first = 0;          ///< first state
  int second = -1;        ///< second state; -1: linear term
  bool absolute = false;  ///< the term is |first| second
  double coefficient = 0;
};

/// Cross-flow drag of a slender hull by strip theory.
struct CrossFlowConfig {
  double length_m = 1;
  double height_m = 0.2;                      ///< diameter of a round hull, draft of a boat
  std::optional<double> density_kgpm3;        ///< unset: density of the water
  std::vector<double> drag_coefficient{1.1};  ///< one number, or pairs of Reynolds number and coefficient
  double reynolds_length_m = 1;
  double kinematic_viscosity_m2ps = 1e-6;
  int strips = 0;  ///< 0: exact integral; n: sum over n points, both ends with full weight
  void read(ParamReader& in);
};

/// Lift and drag of a hull in its plane of symmetry as functions of the angle of attack.
struct HullLiftConfig {
  double area_m2 = 1;
  std::optional<double> density_kgpm3;  ///< unset: density of the water
  double lift_slope = 0;                ///< dC_L/d(alpha), 1/rad
  double drag_coefficient = 0;          ///< C_D at zero lift
  double induced_drag = 0;              ///< k in C_D = drag_coefficient + k C_L^2
  void read(ParamReader& in);
};

/// Linear restoring forces of a surface craft by its heave, roll and pitch relative to the water surface.
struct WaterlineConfig {
  double length_m = 1;  ///< length of the water plane; waves are evaluated at its ends
  double beam_m = 1;
  double heave_Npm = 0;
  double heave_pitch_N = 0;  ///< coupling of heave and pitch: force per rad and moment per m
  double roll_Nmprad = 0;
  double pitch_Nmprad = 0;
  double load_kg = 0;  ///< added load, which changes the trim in which the frame lies in the surface
  Vector3d load_at_m = Vector3d::Zero();
  void read(ParamReader& in);
};

/// Wind loads on the part of a craft above the water by the angle of attack g of the wind (Fossen 2011, eq. 8.23 to
/// 8.30): X = q C_X A_F cos(g), Y = q C_Y A_L sin(g), N = q C_N A_L L sin(2 g), K = Y times the height.
struct WindageConfig {
  double frontal_area_m2 = 0;
  double lateral_area_m2 = 0;
  double surge_coefficient = 0.7;
  double sway_coefficient = 0.8;
  double yaw_coefficient = 0.05;  ///< positive: wind from forward of the beam turns the bow away from it
  double height_m = 0;            ///< height of the centroid of the lateral area over the origin
  double length_m = 1;            ///< length over all
  void read(ParamReader& in);
};

/// Deviations of some published models from the physics, to reproduce their results.
struct PublishedQuirks {
  /// Coriolis forces of added mass.
  enum class Coriolis {
    full,
    without_munk,  ///< without the coupling of sway and heave with rotation by added mass
    none,          ///< no Coriolis forces of added mass
  };
  /// Rotation of the current into the body frame.
  enum class Current {
    full,
    yaw_only,  ///< the current is rotated into the body frame by the yaw angle alone
  };
  /// Speed that reduces the linear surge damping.
  enum class FadeSpeed {
    water,
    ground,  ///< sqrt(u + v^2) over ground, as in MSS
  };

  Coriolis added_mass_coriolis = Coriolis::full;
  Current current = Current::full;
  double surge_damping_fade_spm = 0;  ///< linear surge damping is multiplied by exp(-this * speed)
  FadeSpeed fade_speed = FadeSpeed::water;
  void read(ParamReader& in);
};

/// Section `hydrodynamics:` of a body: maneuvering model with the published coefficients of a vehicle (Fossen, Handbook
/// of Marine Craft Hydrodynamics and Motion Control).  All coefficients refer to the origin of the body frame.
///
/// The members are in forward-right-down for either value of `frame` in the file.
struct HydrodynamicsConfig {
  /// Source of the hydrodynamic forces.
  enum class Model {
    coefficients,
    none,  ///< no forces of the water on this body
  };

  Model model = Model::coefficients;
  AxesFrame frame = AxesFrame::flu;
  double mass_kg = 0;
  Vector3d center_of_mass_m = Vector3d::Zero();
  Matrix3d inertia_kgm2 = Matrix3d::Zero();  ///< about the center of mass
  std::optional<double> weight_N;            ///< unset: mass times gravity
  std::optional<double> buoyancy_N;          ///< buoyancy when fully immersed; unset: from volume_m3
  std::optional<double> volume_m3;           ///< displaced volume; unset: neutral buoyancy
  Vector3d center_of_buoyancy_m = Vector3d::Zero();
  std::optional<double> hull_height_m;  ///< height over which it emerges; unset: diameter of a sphere of its volume
  double hull_length_m = 0;             ///< height over which it emerges in vertical attitude
  Matrix6d added_mass = Matrix6d::Zero();
  Matrix6d linear_damping = Matrix6d::Zero();
  Matrix6d quadratic_damping = Matrix6d::Zero();  ///< multiplied by |nu_j| nu_j
  std::vector<DerivativeTerm> derivatives;        ///< additional terms; as forces, with published signs
  std::optional<CrossFlowConfig> cross_flow;
  std::optional<HullLiftConfig> hull_lift;
  std::optional<WaterlineConfig> waterline;
  std::optional<WindageConfig> windage;
  PublishedQuirks quirks;
  SourcePlace place;

  void read(ParamReader& in);
};

/// Returns the diagonal of the added mass of a prolate spheroid about its center, long axis along x: kg, kg, kg, kg
/// m^2, kg m^2, kg m^2.  It is an approximation for slender hulls without published coefficients.  `half_length_m` must
/// be at least `radius_m`.  Potential flow about an ellipsoid: Lamb, Hydrodynamics, articles 114 and 115.
Vector6d spheroid_added_mass(double half_length_m, double radius_m, double density_kgpm3);

/// Reports unphysical values as errors: inertia that is not positive definite, added mass that is asymmetric or
/// negative, damping that adds energy.  Expects numbers that were read without errors.
void check_coefficients(const HydrodynamicsConfig& config, ParamReader& in);

/// Returns warnings about an inertia that is possible but most likely wrong.
std::vector<std::string> doubts_about_inertia(const HydrodynamicsConfig& config);

/// Returns these, and warnings about coefficients that are possible but most likely wrong.
std::vector<std::string> doubts_about(const HydrodynamicsConfig& config);

}  // namespace sim
