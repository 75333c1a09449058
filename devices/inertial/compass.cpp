// SPDX-License-Identifier: BSD-3-Clause
#include "devices/inertial/compass.hpp"

#include <cmath>
#include <numbers>

#include "messages/reporter/message_reporter.hpp"
#include "shoal/compass_t.hpp"

namespace devices {

namespace {

/// Wraps an angle to [0, 2 pi).
double compass_angle(double angle_rad) {
  const double turn = 2 * std::numbers::pi;
  const double wrapped = angle_rad - turn * std::floor(angle_rad / turn);
  return wrapped < turn ? wrapped : 0;
}

/// Returns the magnetic field of the earth in the world axes (east, north, up).
sim::Vector3d field_W_uT(const Compass::Params& p) {
  const double horizontal_uT = p.field_uT * std::cos(p.inclination_rad);
  return {horizontal_uT * std::sin(p.declination_rad), horizontal_uT * std::cos(p.declination_rad),
          -p.field_uT * std::sin(p.inclination_rad)};
}

}  // namespace

void Compass::Params::read(sim::ParamReader& in) {
  in.read_deg("declination_deg", declination_rad, sim::between(-180, 180),
              "magnetic north from true north, + is east; the default is that of the default origin");
  in.read_deg("inclination_deg", inclination_rad, sim::between(-90, 90),
              "inclination of the earth's field, + is downwards");
  in.read("field_uT", field_uT, sim::above(0), "strength of the earth's field, microtesla");
  in.read_deg("declination_correction_deg", declination_correction_rad, sim::between(-180, 180),
              "configured declination, added to the heading for heading_true; 0: not configured");
  in.read("hard_iron_uT", hard_iron_uT, sim::any_number(),
          "field of magnetized parts that move with the sensor, in its axes");
  in.read("soft_iron", soft_iron, sim::any_number(), "3x3 matrix on the field, 9 numbers by rows");
  if (!in.describing() && soft_iron.size() != 9) {
    in.error("soft_iron", "'soft_iron' must have 9 numbers, got " + std::to_string(soft_iron.size()));
    // The error is reported; measuring continues with the identity, which expects nine numbers.
    soft_iron = {1, 0, 0, 0, 1, 0, 0, 0, 1};
  }
  in.read_choice("tilt_compensation", tilt_compensation,
                 {{"none", TiltCompensation::none},
                  {"ideal", TiltCompensation::ideal},
                  {"accelerometer", TiltCompensation::accelerometer}},
                 "source of its tilt compensation: none, the truth, or the specific force");
  in.read("tilt_time_s", tilt_time_s, sim::at_least(0), "accelerometer: time constant of a low pass; 0: none");
  in.read("field_noise", field_noise, "error of each axis, microtesla");
  in.read("heading_noise", heading_noise, "further error of the heading, rad");
}

Compass::Compass(const Params& params, const sim::DeviceContext& context)
    : params_(params),
      strapdown_(context),
      tilt_filter_(params.tilt_time_s),
      field_noise_(context, params, 3),
      heading_noise_(context, params) {}

void Compass::change(const Params& params) {
  params_ = params;
  tilt_filter_.change(params.tilt_time_s);
}

double Compass::heading_of(const sim::Vector3d& field_S, const sim::Vector3d& up_S) {
  // Magnetic north is the horizontal component of the field, and west is perpendicular to it.  The heading follows from
  // the components of x_S along both; it is undefined for vertical x_S and in free fall, where atan2(0, 0) gives 0.
  const sim::Vector3d west_S = up_S.cross(field_S);
  const sim::Vector3d north_S = west_S.cross(up_S);  // longer than west_S by the length of up_S
  return compass_angle(std::atan2(-west_S.x() * up_S.norm(), north_S.x()));
}

void Compass::measure(const sim::SenseContext& context) {
  strapdown_.measure(context);
  const sim::Matrix3d& R_WS = context.X_WS.linear();
  up_S_ = R_WS.row(2).transpose();
  reading_.field_S_uT = R_WS.transpose() * field_W_uT(params_);
  const double azimuth_rad = std::atan2(R_WS(0, 0), R_WS(1, 0));  // x_S from north, clockwise
  reading_.heading_rad = compass_angle(azimuth_rad - params_.declination_rad);
  reading_.heading_true_rad = compass_angle(azimuth_rad);
}

void Compass::disturb(double dt_s, sim::Random& random) {
  // The filter runs in any mode, so that a change of the mode finds it settled.
  const sim::Vector3d by_force_S = tilt_filter_.apply(strapdown_.f_S(), dt_s);
  if (params_.tilt_compensation == TiltCompensation::none) up_S_ = sim::Vector3d::UnitZ();
  if (params_.tilt_compensation == TiltCompensation::accelerometer) up_S_ = by_force_S;
  const Eigen::Map<const Eigen::Matrix<double, 3, 3, Eigen::RowMajor>> soft_iron(params_.soft_iron.data());
  // Soft iron distorts the earth's field, hard iron adds to it.
  reading_.field_S_uT = soft_iron * reading_.field_S_uT + params_.hard_iron_uT;
  field_noise_.apply(std::span<double>(reading_.field_S_uT.data(), 3), dt_s, random);
  double heading_rad = heading_of(reading_.field_S_uT, up_S_);
  heading_noise_.apply(heading_rad, dt_s, random);
  reading_.heading_rad = compass_angle(heading_rad);
  reading_.heading_true_rad = compass_angle(heading_rad + params_.declination_correction_rad);
}

void fill(const Compass& compass, shoal::compass_t& message) {
  const Compass::Reading& reading = compass.reading();
  message.heading_rad = reading.heading_rad;
  message.heading_true_rad = reading.heading_true_rad;
  for (int i = 0; i < 3; ++i) message.field_uT[i] = reading.field_S_uT[i];
}

SHOAL_SENSOR("compass", Compass, shoal::compass_t);

}  // namespace devices
