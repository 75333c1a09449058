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

/// A wheel as the vehicle file describes it, at the start, in the frame of the vehicle.
struct WheelGeometry {
  const sim::BodyConfig* body = nullptr;             ///< that turns; null: neither body of the joint is round
  sim::Vector3d center_V_m = sim::Vector3d::Zero();  ///< of its largest round part, else the anchor of the joint
  sim::Vector3d axis_V = sim::Vector3d::UnitY();     ///< that it turns about, of unit length
  std::optional<double> radius_m;                    ///< of that part
  /// It rolls on the ground: something round turns about a level axis.
  bool rolls() const { return body != nullptr && std::abs(axis_V.z()) < 0.7; }
};

/// Of a joint that is a hinge or hinge2.
WheelGeometry wheel_geometry(const sim::VehicleConfig& vehicle, const std::string& joint);

/// The distance along the axle between the mean places of the wheels of both sides.
double track_m_of(const sim::VehicleConfig& vehicle, const std::vector<std::string>& left_joints,
                  const std::vector<std::string>& right_joints);

/// The track of a vehicle that turns by slip, when its wheels carry alike under Coulomb friction: 2 (b + a^2 / b) with
/// wheels at (+-a, +-b) from their middle.  There the friction of the slips (b w - v, a w) has no moment.
double scrubbing_track_m_of(const sim::VehicleConfig& vehicle, const std::vector<std::string>& left_joints,
                            const std::vector<std::string>& right_joints);

/// The mean radius; nothing when a wheel is not round.
std::optional<double> wheel_radius_m_of(const sim::VehicleConfig& vehicle, const std::vector<std::string>& joints);

/// From the rear axle to the steered wheels: the rear axle has the hindmost of the other wheels on hinges.  Nothing
/// when there are no wheels behind the steered ones.
std::optional<double> wheelbase_m_of(const sim::VehicleConfig& vehicle, const std::vector<std::string>& steered_joints);

/// A length that a device was given, or has from the joints.
struct LengthOfDevice {
  const char* key;
  std::optional<double> given_m, real_m;
  double usual_m = 0;  ///< where neither is known
  double value_m() const { return given_m ? *given_m : real_m.value_or(usual_m); }
};

/// How far a length that was given may be off before it is worth a warning.
struct AllowedRatio {
  double low = 0.97, high = 1.03;  ///< of given / real
};

/// Warns of a length that is not that of the joints.  `effect`: the consequence, such as `it turns {} times as fast
/// as commanded`, where {} becomes `factor(given / real)`.
void check_length(const sim::DeviceContext& context, const LengthOfDevice& length, const AllowedRatio& allowed,
                  const std::string& effect, double (*factor)(double ratio));

inline double as_it_is(double ratio) {
  return ratio;
}
inline double inverse(double ratio) {
  return 1 / ratio;
}

}  // namespace devices
