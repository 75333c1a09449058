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

/// Axes of numbers: forward, left, up as bodies have them, or forward, right, down as papers print them.
enum class AxesFrame { flu, frd };

inline constexpr ChoiceWords<AxesFrame> axes_frame_words{{"flu", AxesFrame::flu}, {"frd", AxesFrame::frd}};

/// The letters of the names of derivatives: forces and moments, and velocities (SNAME).
inline constexpr std::string_view derivative_rows = "XYZKMN";
inline constexpr std::string_view derivative_states = "uvwpqr";

/// A hydrodynamic force named as SNAME does: `coefficient` times one or two components of the velocity, such as
/// Y_uv (u v), N_rr (|r| r), X_rr (r r), X_u.  Rows and states: 0 to 5 are X u, Y v, Z w, K p, M q, N r.
struct DerivativeTerm {
  int row = 0;
  int first = 0;
  int second = -1;        ///< -1: linear
  bool absolute = false;  ///< |first| second
  double coefficient = 0;
};

/// Drag of a slender hull across its axis, strip by strip.
struct CrossFlowConfig {
  double length_m = 1;
  double height_m = 0.2;                      ///< diameter of a round hull; draft of a boat
  std::optional<double> density_kgpm3;        ///< unset: the water's
  std::vector<double> drag_coefficient{1.1};  ///< one number, or pairs Reynolds number, coefficient
  double reynolds_length_m = 1;
  double kinematic_viscosity_m2ps = 1e-6;
  int strips = 0;  ///< 0: the exact integral; n: the sum over n points, both ends with full weight
  void read(ParamReader& in);
};

/// Lift and drag of a hull in its plane of symmetry, by angle of attack.
struct HullLiftConfig {
  double area_m2 = 1;
  std::optional<double> density_kgpm3;  ///< unset: the water's
  double lift_slope = 0;                ///< dC_L/d(alpha), 1/rad
  double drag_coefficient = 0;          ///< C_D at no lift
  double induced_drag = 0;              ///< C_D grows by this times C_L^2
  void read(ParamReader& in);
};

/// Restoring forces of a surface craft, linear in its heave, roll and pitch against the water surface.
struct WaterlineConfig {
  double length_m = 1;  ///< of the water plane: the waves are felt at its ends
  double beam_m = 1;
  double heave_Npm = 0;
  double heave_pitch_N = 0;  ///< couples heave and pitch: force per rad and moment per m
  double roll_Nmprad = 0;
  double pitch_Nmprad = 0;
  double load_kg = 0;  ///< pulls the craft out of the trim in which its frame lies in the surface
  Vector3d load_at_m = Vector3d::Zero();
  void read(ParamReader& in);
};

/// What the wind does to the part of a craft that is over the water (Fossen 2011, eq. 8.23 to 8.30), by the angle at
/// which it comes: X = q C_X A_F cos, Y = q C_Y A_L sin, N = q C_N A_L L sin(2 angle), K = Y times the height.
struct WindageConfig {
  double frontal_area_m2 = 0;
  double lateral_area_m2 = 0;
  double surge_coefficient = 0.7;
  double sway_coefficient = 0.8;
  double yaw_coefficient = 0.05;  ///< positive: wind from abeam of the bow turns the bow away from it
  double height_m = 0;            ///< of the middle of the lateral area over the origin
  double length_m = 1;            ///< over all
  void read(ParamReader& in);
};

/// What some published models do and the physics does not.
struct PublishedQuirks {
  enum class Coriolis {
    full,
    without_munk,  ///< added mass couples no sway, heave and turning
    none,          ///< no Coriolis forces of added mass
  };
  enum class Current {
    full,
    yaw_only,  ///< the current is turned into the body by its yaw alone
  };
  enum class FadeSpeed {
    water,
    ground,  ///< sqrt(u + v^2) over ground, as MSS has it
  };

  Coriolis added_mass_coriolis = Coriolis::full;
  Current current = Current::full;
  double surge_damping_fade_spm = 0;  ///< linear surge damping falls with exp(-this * speed)
  FadeSpeed fade_speed = FadeSpeed::water;
  void read(ParamReader& in);
};

/// `hydrodynamics:` of a body: a vehicle as its published coefficients describe it (Fossen, Handbook of Marine Craft
/// Hydrodynamics and Motion Control).  All numbers are about the origin of the body's frame.
///
/// Whatever `frame` the file has, the numbers here are in forward-right-down.
struct HydrodynamicsConfig {
  enum class Model {
    coefficients,
    none,  ///< water does nothing to this body
  };

  Model model = Model::coefficients;
  AxesFrame frame = AxesFrame::flu;
  double mass_kg = 0;
  Vector3d center_of_mass_m = Vector3d::Zero();
  Matrix3d inertia_kgm2 = Matrix3d::Zero();  ///< about the centre of mass
  std::optional<double> weight_N;            ///< unset: mass times gravity
  std::optional<double> buoyancy_N;          ///< when all of it is immersed; unset: of volume_m3
  std::optional<double> volume_m3;           ///< unset: neutral
  Vector3d center_of_buoyancy_m = Vector3d::Zero();
  std::optional<double> hull_height_m;  ///< over which it emerges; unset: of a ball of its volume
  double hull_length_m = 0;             ///< it emerges over this when it stands upright
  Matrix6d added_mass = Matrix6d::Zero();
  Matrix6d linear_damping = Matrix6d::Zero();
  Matrix6d quadratic_damping = Matrix6d::Zero();  ///< times |nu_j| nu_j
  std::vector<DerivativeTerm> derivatives;        ///< beyond the matrices; forces, signs as printed
  std::optional<CrossFlowConfig> cross_flow;
  std::optional<HullLiftConfig> hull_lift;
  std::optional<WaterlineConfig> waterline;
  std::optional<WindageConfig> windage;
  PublishedQuirks quirks;
  SourcePlace place;

  void read(ParamReader& in);
};

}  // namespace sim
