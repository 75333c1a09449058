// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cmath>
#include <optional>
#include <string>
#include <vector>

#include "sim/model/physics_config.hpp"
#include "sim/vehicle/device_context.hpp"

namespace sim {
class Vehicle;
struct VehicleConfig;
}  // namespace sim

namespace devices {

/// Geometry of a wheel from the vehicle file, in the initial configuration and the vehicle frame.
struct WheelGeometry {
  const sim::BodyConfig* body = nullptr;             ///< rotating body; null: neither body of the joint is round
  sim::Vector3d center_V_m = sim::Vector3d::Zero();  ///< center of its largest round part, else the anchor of the joint
  sim::Vector3d axis_V = sim::Vector3d::UnitY();     ///< axis of rotation, of unit length
  std::optional<double> radius_m;                    ///< radius of that part
  /// Returns whether it rolls on the ground: a round part that rotates about a nearly horizontal axis.
  bool rolls() const { return body != nullptr && std::abs(axis_V.z()) < 0.7; }
};

/// Returns the wheel geometry of a joint that is a hinge or hinge2.
WheelGeometry wheel_geometry(const sim::VehicleConfig& vehicle, const std::string& joint);

/// Returns the distance along the axle between the mean positions of the wheels of both sides.
double track_m_of(const sim::VehicleConfig& vehicle, const std::vector<std::string>& left_joints,
                  const std::vector<std::string>& right_joints);

/// Returns the effective track of a skid-steer vehicle with equal loads on its wheels and Coulomb friction: 2 (b + a^2
/// / b) with wheels at (+-a, +-b) from their center, for which the friction of the slip velocities (b w - v, a w) has
/// no moment.
double scrubbing_track_m_of(const sim::VehicleConfig& vehicle, const std::vector<std::string>& left_joints,
                            const std::vector<std::string>& right_joints);

/// Returns the mean radius; none when a wheel is not round.
std::optional<double> wheel_radius_m_of(const sim::VehicleConfig& vehicle, const std::vector<std::string>& joints);

/// Returns the distance from the rear axle to the steered wheels; the rear axle is that of the rearmost of the other
/// wheels on hinges.  std::nullopt when there are no wheels behind the steered ones.
std::optional<double> wheelbase_m_of(const sim::VehicleConfig& vehicle, const std::vector<std::string>& steered_joints);

/// Length of a device, configured or derived from the joints.
struct LengthOfDevice {
  const char* key;
  std::optional<double> given_m, real_m;
  double usual_m = 0;  ///< default when both are unset
  double value_m() const { return given_m ? *given_m : real_m.value_or(usual_m); }
};

/// Range of the ratio of configured to actual length without a warning.
struct AllowedRatio {
  double low = 0.97, high = 1.03;  ///< limits of given / real
};

/// Warns of a length that does not match the joints.  `effect`: the consequence, such as `it turns {} times as fast
/// as commanded`, where {} becomes `factor(given / real)`.
void check_length(const sim::DeviceContext& context, const LengthOfDevice& length, const AllowedRatio& allowed,
                  const std::string& effect, double (*factor)(double ratio));

inline double as_it_is(double ratio) {
  return ratio;
}
inline double inverse(double ratio) {
  return 1 / ratio;
}

/// Warns when the load on the driven wheels is statically indeterminate.
/// A rigid vehicle on flat ground rests on points (x_i, y_i) with forces f_i that balance its weight and its moments:
/// three equations, for sum f_i, sum x_i f_i and sum y_i f_i.  The total load on the driven wheels follows from them
/// only if there are a, b, c with a + b x_i + c y_i = 1 at each driven wheel and 0 at each other point.  This holds
/// with up to three points, with wheels on one axle and casters on one line beside it, and when all wheels are driven.
/// This fails with casters in front of and behind the axle: the load then depends on rounding, and may be close to
/// zero.  Excluded: vehicles with a suspension or compliant joints, soft contacts, no gravity, wheels of other shapes.
void warn_of_shared_weight(const sim::DeviceContext& context, const std::vector<std::string>& driven_joints);

}  // namespace devices
