// SPDX-License-Identifier: BSD-3-Clause
#include <cmath>
#include <numbers>

#include "sim/base/math.hpp"
#include "sim/base/number.hpp"
#include "sim/config/message_text.hpp"
#include "sim/model/hydrodynamics_config.hpp"

namespace sim {

namespace {

constexpr const char* axes[] = {"surge", "sway", "heave", "roll", "pitch", "yaw"};

const char* key_of_added_mass(const ParamReader& in) {
  return in.has("added_mass") || !in.has("derivatives") ? "added_mass" : "derivatives";
}

std::string derivative_name(const DerivativeTerm& term) {
  std::string name{derivative_rows[term.row], '_', derivative_states[term.first]};
  if (term.second >= 0) name += derivative_states[term.second];
  return name;
}

/// Returns a computed value as text with 6 digits, which hides rounding errors.
std::string computed_text(double value) {
  return number_text(rounded_to(value, 6));
}

/// Returns false when an eigenvalue is below zero by more than the rounding error of the matrix.
bool not_negative(double eigenvalue, const Matrix6d& matrix) {
  return eigenvalue >= -1e-9 * matrix.cwiseAbs().maxCoeff();
}

void check_added_mass(const Matrix6d& A, ParamReader& in) {
  const char* key = key_of_added_mass(in);
  // Check the sign of the diagonal.
  for (int i = 0; i < 6; ++i) {
    if (A(i, i) >= 0) continue;
    in.error(key, std::string("the added mass in ") + axes[i] + " must be >= 0, got " + number_text(A(i, i)) +
                      ": papers print derivatives such as " + derivative_rows[i] + "_" + derivative_states[i] +
                      "dot, which are its negative");
    return;
  }
  // Check the symmetry.
  const double scale = A.cwiseAbs().maxCoeff();
  for (int i = 0; i < 6; ++i)
    for (int j = i + 1; j < 6; ++j) {
      if (std::abs(A(i, j) - A(j, i)) <= 1e-6 * scale) continue;
      in.error(key, std::string("the added mass must be symmetric, got ") + number_text(A(i, j)) + " between " +
                        axes[i] + " and " + axes[j] + " and " + number_text(A(j, i)) + " the other way");
      return;
    }
  // Check that the matrix is positive semi-definite.
  const double min = smallest_eigenvalue(A);
  if (!not_negative(min, A))
    in.error(key, "the added-mass matrix is not positive semi-definite, eigenvalue " + computed_text(min) +
                      ": its off-diagonal terms are too large");
}

void check_inertia(const HydrodynamicsConfig& config, ParamReader& in) {
  const Matrix3d& I = config.inertia_kgm2;
  // Relative to the largest moment: papers round the entries separately.
  if ((I - I.transpose()).cwiseAbs().maxCoeff() > 1e-9 * I.cwiseAbs().maxCoeff()) {
    in.error("inertia_kgm2", "'inertia_kgm2' must be symmetric");
    return;
  }
  const double min = symmetric_eigenvalues(I)[0];
  if (!(min > 0))
    in.error("inertia_kgm2",
             "'inertia_kgm2' about the center of mass must be positive definite, its smallest eigenvalue is " +
                 computed_text(min) + "; see 'inertia_about'");
}

void check_damping(const char* key, const Matrix6d& damping, ParamReader& in) {
  for (int i = 0; i < 6; ++i)
    if (!(damping(i, i) >= 0))
      in.error(key,
               std::string("'") + key + "' must be >= 0 in " + axes[i] + ", got " + number_text(damping(i, i)) +
                   ": a negative value would accelerate the vehicle; papers print derivatives, which are its negative");
}

/// Checks that damping adds energy to no combination of motions.  The dissipated power is nu' D nu, to which only the
/// symmetric part of D contributes.
void check_damping_couplings(const HydrodynamicsConfig& config, ParamReader& in) {
  const Matrix6d& D = config.linear_damping;
  if (!(D.diagonal().minCoeff() >= 0)) return;  // already reported
  const double min = smallest_eigenvalue((D + D.transpose()) / 2);
  if (!not_negative(min, D))
    in.error("linear_damping", "the symmetric part of 'linear_damping' has a negative eigenvalue, " +
                                   computed_text(min) + ": it would accelerate some motions");
}

void check_waterline(const WaterlineConfig& plane, ParamReader& in) {
  const double alone = plane.heave_Npm * plane.pitch_Nmprad, coupled = plane.heave_pitch_N * plane.heave_pitch_N;
  if (!(alone > coupled))
    in.error("waterline", "'heave_pitch_N' squared must stay below 'heave_Npm' times 'pitch_Nmprad', got " +
                              number_text(coupled) + " and " + number_text(alone) +
                              ": combined heave and pitch would be unstable");
}

void check_derivatives(const HydrodynamicsConfig& config, ParamReader& in) {
  for (const DerivativeTerm& term : config.derivatives) {
    const bool brakes = term.row == term.first && (term.second < 0 || (term.second == term.first && term.absolute));
    if (brakes && term.coefficient > 0)
      in.error("derivatives", "'" + derivative_name(term) + "' must be <= 0, got " + number_text(term.coefficient) +
                                  ": positive, it would push the vehicle on");
  }
}

}  // namespace

void check_coefficients(const HydrodynamicsConfig& config, ParamReader& in) {
  if (in.describing() || !(config.mass_kg > 0)) return;
  if (in.has("inertia_kgm2")) check_inertia(config, in);
  if (config.model != HydrodynamicsConfig::Model::coefficients) return;
  check_damping("linear_damping", config.linear_damping, in);
  check_damping("quadratic_damping", config.quadratic_damping, in);
  check_damping_couplings(config, in);
  check_derivatives(config, in);
  if (config.waterline) check_waterline(*config.waterline, in);
  check_added_mass(config.added_mass, in);
}

std::vector<std::string> doubts_about_inertia(const HydrodynamicsConfig& config) {
  std::vector<std::string> doubts;
  // Uniform solids of a mass and a volume have at least the inertia of a sphere, 2/5 m r^2.
  constexpr double water_kgpm3 = 1000, far_below = 0.1;
  const double volume_m3 = config.volume_m3.value_or(config.mass_kg / water_kgpm3);
  const double sphere = 0.4 * config.mass_kg * std::pow(0.75 * volume_m3 / std::numbers::pi, 2.0 / 3);
  const double mean = config.inertia_kgm2.trace() / 3;
  if (mean > 0 && mean < far_below * sphere)
    doubts.push_back("the mean of its moments of inertia is " + computed_text(mean) +
                     " kg m^2, less than a tenth of that of a sphere of its mass and volume, " + computed_text(sphere));
  // Triangle inequality of the principal moments of inertia.
  const Vector3d moments = symmetric_eigenvalues(config.inertia_kgm2);
  if (moments[2] > (1 + 1e-9) * (moments[0] + moments[1]))
    doubts.push_back("no solid has its principal moments of inertia, " + number_text(moments[0]) + ", " +
                     number_text(moments[1]) + " and " + number_text(moments[2]) +
                     " kg m^2: none is larger than the sum of the others");
  return doubts;
}

std::vector<std::string> doubts_about(const HydrodynamicsConfig& config) {
  std::vector<std::string> doubts = doubts_about_inertia(config);
  const double above = config.center_of_buoyancy_m.z() - config.center_of_mass_m.z();
  // Center of mass above the center of buoyancy: unstable.
  if (!config.waterline && above > 0)
    doubts.insert(doubts.begin(), "its center of mass lies " + number_text(above) +
                                      " m above its center of buoyancy, so that it turns over; is 'frame' " +
                                      std::string(word_of(axes_frame_words, config.frame)) + " right?");
  return doubts;
}

}  // namespace sim
