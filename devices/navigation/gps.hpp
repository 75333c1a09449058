// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>

#include "sim/base/geodesy.hpp"
#include "sim/clock/vehicle_clock.hpp"
#include "sim/random/noise.hpp"
#include "sim/vehicle/device_context.hpp"

namespace devices {

/// Satellite receiver: position on the WGS84 ellipsoid, from the geodetic origin of the world, and velocity over
/// ground.  It has no fix while its antenna, the origin of its frame, is below the instantaneous water surface.  It may
/// discipline the clock of its vehicle (docs/models/clocks.md): each fix measures the clock error with the jitter of
/// the pulse per second.
class Gps final : public sim::Sensor {
 public:
  static constexpr const char* meaning = "Satellite positioning: WGS84 position, velocity over ground, fix quality.";
  static constexpr double default_rate_hz = 1;
  struct Params {
    sim::NoiseParams horizontal_noise;  ///< error of east and north, m
    sim::NoiseParams vertical_noise;    ///< error of the height, m
    sim::NoiseParams velocity_noise;    ///< error of each component of the velocity, m/s
    int fix_quality = 1;
    int satellites = 9;
    std::optional<double> min_height_m;  ///< minimum height of the antenna for a fix
    double reacquisition_s = 0;          ///< time to the next fix after a denied zone or submersion
    bool disciplines_clock = false;
    sim::DisciplineParams discipline;  ///< its interval is ignored; the sample period applies
    void read(sim::ParamReader& in);
  };
  struct Reading {
    int fix_quality = 0;  ///< 0: no fix; the other fields are NaN
    sim::GeodeticPosition position;
    sim::Vector3d p_W = sim::Vector3d::Zero();
    sim::Vector3d v_W = sim::Vector3d::Zero();
    double speed_mps = 0;   ///< over ground: of the horizontal velocity at the place of the antenna
    double course_rad = 0;  ///< of that velocity, clockwise from the meridian; the last one when slower than 1 mm/s
    void visit_state(sim::StateArchive& archive) {
      archive(fix_quality, position.latitude_deg, position.longitude_deg, position.height_m, p_W, v_W, speed_mps,
              course_rad);
    }
  };

  Gps(const Params& params, const sim::DeviceContext& context);
  void change(const Params& params) { params_ = params; }
  auto noises() { return std::tie(horizontal_noise_, vertical_noise_, velocity_noise_); }
  void measure(const sim::SenseContext& context) override;
  void disturb(double dt_s, sim::Random& random) override;
  void visit_state(sim::StateArchive& archive) override {
    archive(horizontal_noise_, vertical_noise_, velocity_noise_, reading_, true_course_rad_, sampled_at_, denied_at_);
  }
  std::string_view lacks() const override { return reading_.fix_quality > 0 ? "" : no_fix_; }
  const Reading& reading() const { return reading_; }
  const Params& params() const { return params_; }
  /// Returns the reported standard deviation for a noise model, m.
  static double accuracy_m(const sim::NoiseParams& noise);

 private:
  /// Sets speed and course from the velocity; `held_rad`: course of a receiver that does not move.
  void find_course(double held_rad);
  void discipline(sim::Random& random);

  Params params_;
  const sim::Geodesy& geodesy_;
  sim::VehicleClock& clock_;
  const sim::DeviceFaults& faults_;
  const sim::DeviceConfig& config_;
  double step_s_;
  sim::NoiseOf<&Params::horizontal_noise> horizontal_noise_;
  sim::NoiseOf<&Params::vertical_noise> vertical_noise_;
  sim::NoiseOf<&Params::velocity_noise> velocity_noise_;
  Reading reading_;
  double true_course_rad_ = 0;       ///< held by the truth channel
  std::string_view no_fix_ = "fix";  ///< what the last sample lacked, and why
  sim::Time sampled_at_{0};
  std::optional<sim::Time> denied_at_;  ///< last time under water or in a denied zone
};

/// Publishes shoal.gps_data_t, equal on the wire to bot_core's.
class GpsReporter final : public sim::Reporter {
 public:
  static constexpr const char* report_message = "shoal.gps_data_t";
  explicit GpsReporter(const Gps& gps) : gps_(gps) {}
  void report(sim::Time sampled_at, sim::Publisher& out) const override;

 private:
  const Gps& gps_;
};

}  // namespace devices
