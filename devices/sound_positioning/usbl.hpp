// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "devices/sound_positioning/acoustic_positioning.hpp"
#include "devices/sound_positioning/interrogator.hpp"
#include "devices/sound_positioning/usbl_array.hpp"
#include "sim/medium/medium_config.hpp"
#include "sim/random/noise.hpp"

namespace devices {

/// Ultra-short-baseline positioning (USBL): range and direction to the transponders of its network.  A ping is sent at
/// a sample, every `ping_period_s`, but not before the answers to the last one are complete.  The travel time is that
/// from the position of this device at the ping to the transponder, and from there to the position of this device at
/// the arrival of the answer; the direction is that to the transponder at its answer.  Answers are reported at the next
/// sample.
class Usbl final : public sim::Sensor {
 public:
  static constexpr const char* meaning = "USBL: range and direction to acoustic transponders, by the time of sound.";
  static constexpr double default_rate_hz = 10;
  struct Params {
    InterrogatorParams interrogator{.network = "usbl"};
    double ping_period_s = 1;
    std::optional<double> assumed_sound_speed_mps;
    std::optional<sim::WaterConfig> assumed_water;  ///< rays through it give position from time and direction
    double answer_dropout = 0;
    sim::NoiseParams range_noise;  ///< m
    std::optional<UsblArrayParams> array;
    sim::NoiseParams azimuth_noise;    ///< rad, across the direction
    sim::NoiseParams elevation_noise;  ///< rad
    void read(sim::ParamReader& in);
  };
  /// Measurement of one transponder.
  struct Fix {
    std::string target;
    double travel_time_s = 0, range_m = 0, azimuth_rad = 0, elevation_rad = 0;
    double sound_azimuth_rad = 0, sound_elevation_rad = 0;  ///< from where the sound came
    double cosine_std = 0;                                  ///< of the direction, by `array`
    sim::Vector3d position_S() const;
    void point_at(const sim::Vector3d& direction_S);  ///< sets azimuth and elevation
    void visit_state(sim::StateArchive& archive) {
      archive(target, travel_time_s, range_m, azimuth_rad, elevation_rad);
      archive.unhashed(sound_azimuth_rad, sound_elevation_rad, cosine_std);  // of the same places
    }
  };

  Usbl(const Params& params, const sim::DeviceContext& context);
  void change(const Params& params);
  auto noises() { return std::tie(range_noise_, azimuth_noise_, elevation_noise_); }
  void measure(const sim::SenseContext& context) override;
  void disturb(double dt_s, sim::Random& random) override;
  void visit_state(sim::StateArchive& archive) override;
  std::string_view lacks() const override { return fixes_.empty() ? "answer of a transponder" : ""; }
  const std::vector<Fix>& fixes() const { return fixes_; }

 private:
  void assume();
  void follow_ray(Fix& fix) const;
  /// Direction with its errors.
  void disturb_direction(Fix& fix, sim::Random& random);

  Params params_;
  Interrogator interrogator_;
  std::optional<AssumedWater> assumed_;  ///< of `assumed_water`
  sim::NoiseOf<&Params::range_noise> range_noise_;
  sim::NoiseOf<&Params::azimuth_noise> azimuth_noise_;
  sim::NoiseOf<&Params::elevation_noise> elevation_noise_;
  const sim::NoiseFault& fault_;  ///< of the azimuth, also for the errors of the array
  sim::Time next_ping_{0};
  std::vector<Fix> fixes_;
  double assumed_mps_ = 0;                          ///< sound speed used for the ranges of this sample
  sim::Matrix3d R_WS_ = sim::Matrix3d::Identity();  ///< attitude at this sample
  double depth_m_ = 0;                              ///< of the sensor at this sample
  double since_fix_s_ = 0;                          ///< interval for the slowly varying errors
};

/// Publishes one shoal.usbl_t for each answer since the last sample.
class UsblReporter final : public sim::Reporter {
 public:
  static constexpr const char* report_message = "shoal.usbl_t";
  explicit UsblReporter(const Usbl& usbl) : usbl_(usbl) {}
  void report(sim::Time sampled_at, sim::Publisher& out) const override;

 private:
  const Usbl& usbl_;
};

}  // namespace devices
