// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "devices/sound_positioning/acoustic_positioning.hpp"
#include "devices/sound_positioning/interrogator.hpp"
#include "sim/random/noise.hpp"

namespace devices {

/// Long-baseline positioning (LBL): interrogates a net of transponders with one ping, and reports the travel times of
/// all answers together, when they are complete or no more can arrive from within range.  The next ping is sent at a
/// later sample, at least `ping_period_s` after the last one.
class Lbl final : public sim::Sensor {
 public:
  static constexpr const char* meaning = "LBL: ranges to a net of acoustic transponders, by the time of sound.";
  static constexpr double default_rate_hz = 10;
  struct Params {
    InterrogatorParams interrogator{.network = "lbl", .range_max_m = 3000};
    double ping_period_s = 5;
    std::optional<double> assumed_sound_speed_mps;
    std::optional<sim::WaterConfig> assumed_water;  ///< first arrivals through it give ranges from times
    double answer_dropout = 0;
    sim::NoiseParams time_noise;  ///< s
    void read(sim::ParamReader& in);
  };
  /// Range to one transponder.
  struct Range {
    std::string transponder;
    double travel_time_s = 0, range_m = 0;  ///< NaN: no answer
    double depth_m = 0;                     ///< of the transponder; the user knows where it is moored
    void visit_state(sim::StateArchive& archive) {
      archive(transponder);
      archive.not_only_finite(travel_time_s, range_m);
      archive.unhashed(depth_m);
    }
  };

  Lbl(const Params& params, const sim::DeviceContext& context);
  void change(const Params& params);
  auto noises() { return std::tie(time_noise_); }
  void measure(const sim::SenseContext& context) override;
  void disturb(double dt_s, sim::Random& random) override;
  void visit_state(sim::StateArchive& archive) override;
  std::string_view lacks() const override;
  /// Returns the answers to the ping completed at this sample; empty: none is completed, or no transponder was
  /// interrogated.
  const std::vector<Range>& ranges() const { return ranges_; }

 private:
  void collect();
  void assume();

  Params params_;
  Interrogator interrogator_;
  std::optional<AssumedWater> assumed_;  ///< of `assumed_water`
  sim::NoiseOf<&Params::time_noise> time_noise_;
  bool asking_ = false;
  sim::Time next_ping_{0};
  std::vector<Range> ranges_;
  double assumed_mps_ = 0;                          ///< sound speed used for the ranges of this sample
  sim::Matrix3d R_WS_ = sim::Matrix3d::Identity();  ///< attitude at this sample
  double depth_m_ = 0;                              ///< of the sensor at this sample
  double since_ping_s_ = 0;                         ///< interval for the slowly varying errors
};

}  // namespace devices
