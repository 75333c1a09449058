// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>

#include "sim/base/geodesy.hpp"
#include "sim/clock/vehicle_clock.hpp"
#include "sim/random/noise.hpp"
#include "sim/vehicle/device_context.hpp"

namespace devices {

/// Satellite receiver: position on the WGS84 ellipsoid by the world's origin, and velocity over ground.  No fix while
/// its antenna, the origin of its frame, is under the momentary surface of the water.  It may steer the clock of its
/// vehicle (docs/models/clocks.md): a fix tells the clock's error except for the jitter of its pulse.
class Gps final : public sim::Sensor {
 public:
  static constexpr const char* meaning = "Satellite positioning: WGS84 position, velocity over ground, fix quality.";
  static constexpr double default_rate_hz = 1;
  struct Params {
    sim::NoiseParams horizontal_noise;  ///< of east and of north, m
    sim::NoiseParams vertical_noise;    ///< of the height, m
    sim::NoiseParams velocity_noise;    ///< of each component of the velocity, m/s
    int fix_quality = 1;
    int satellites = 9;
    std::optional<double> min_height_m;  ///< below this height of the antenna there is no fix
    double reacquisition_s = 0;  ///< after a zone that denies it or water over the antenna, until there is a fix again
    bool disciplines_clock = false;
    sim::DisciplineParams discipline;  ///< its interval is not used: it is the period of the samples
    void read(sim::ParamReader& in);
  };
  struct Reading {
    int fix_quality = 0;  ///< 0: no fix, and the rest is NaN
    sim::GeodeticPosition position;
    sim::Vector3d p_W = sim::Vector3d::Zero();
    sim::Vector3d v_W = sim::Vector3d::Zero();
    void visit_state(sim::StateArchive& archive) {
      archive(fix_quality, position.latitude_deg, position.longitude_deg, position.height_m, p_W, v_W);
    }
  };

  Gps(const Params& params, const sim::DeviceContext& context);
  void change(const Params& params) { params_ = params; }
  auto noises() { return std::tie(horizontal_noise_, vertical_noise_, velocity_noise_); }
  void measure(const sim::SenseContext& context) override;
  void disturb(double dt_s, sim::Random& random) override;
  void visit_state(sim::StateArchive& archive) override {
    archive(horizontal_noise_, vertical_noise_, velocity_noise_, reading_, sampled_at_, denied_at_);
  }
  const Reading& reading() const { return reading_; }
  const Params& params() const { return params_; }
  /// The standard deviation it claims, from its noise, m.
  static double accuracy_m(const sim::NoiseParams& noise);

 private:
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
  sim::Time sampled_at_{0};
  std::optional<sim::Time> denied_at_;  ///< when it was last under water or in a zone that denies it
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
