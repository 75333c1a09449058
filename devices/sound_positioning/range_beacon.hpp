// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include "devices/sound_positioning/signal_carrier.hpp"
#include "sim/random/noise.hpp"
#include "sim/vehicle/device_context.hpp"

namespace devices {

/// Sensor of ranges, and directions if configured, to the beacons of its network: range_beacon devices of other
/// vehicles and beacons at fixed positions.  The signal propagates instantaneously.
class RangeBeacon final : public sim::Sensor {
 public:
  static constexpr const char* meaning = "Ranges and directions to beacons: other vehicles' devices or fixed places.";
  static constexpr double default_rate_hz = 1;
  struct FixedBeacon {
    std::string name;
    sim::Vector3d position_m = sim::Vector3d::Zero();  ///< in W
    void read(sim::ParamReader& in);
  };
  struct Params {
    std::string network = "beacons";
    std::vector<FixedBeacon> beacons;
    bool beacon_only = false;  ///< serves only as a beacon for others, and measures nothing
    bool bearing = false;
    bool elevation = false;
    SignalCarrier through = SignalCarrier::radio;
    double range_max_m = 100;
    bool occlusion = true;
    double beacon_dropout = 0;
    sim::NoiseParams range_noise;      ///< m
    sim::NoiseParams bearing_noise;    ///< rad
    sim::NoiseParams elevation_noise;  ///< rad
    void read(sim::ParamReader& in);
  };
  struct Sighting {
    std::string beacon;
    double range_m = 0, bearing_rad = 0, elevation_rad = 0;
    void visit_state(sim::StateArchive& archive) { archive(beacon, range_m, bearing_rad, elevation_rad); }
  };

  RangeBeacon(const Params& params, const sim::DeviceContext& context);
  ~RangeBeacon() override;
  RangeBeacon(const RangeBeacon&) = delete;
  RangeBeacon& operator=(const RangeBeacon&) = delete;

  void change(const Params& params);
  void measure(const sim::SenseContext& context) override;
  void disturb(double dt_s, sim::Random& random) override;
  void visit_state(sim::StateArchive& archive) override;
  std::string_view lacks() const override {
    return params_.beacon_only || !sightings_.empty() ? "" : "beacon in range";
  }
  const std::vector<Sighting>& sightings() const { return sightings_; }
  const Params& params() const { return params_; }

 private:
  class Network;
  static const sim::SharedKind<Network> network_of_world;
  /// Errors of one beacon, independent of those of the others.
  struct Errors {
    std::string beacon;
    sim::Noise range, bearing, elevation;
    double seen_at_s;
  };
  /// Measures one beacon.  `group`: group of the vehicle that carries it; -1: fixed beacon.
  void look_at(const sim::SenseContext& context, const std::string& beacon, const sim::Vector3d& p_W, int group);
  bool answers() const;
  sim::Vector3d p_WS() const;
  Errors& errors_of(const std::string& beacon);
  void discard(const std::string& beacon);

  Params params_;
  Network& network_;
  const sim::Vehicle& vehicle_;
  const sim::Body& body_;
  sim::Vector3d p_BS_;
  std::string full_name_;
  const sim::DeviceFaults& faults_;
  sim::NoisesOf<&Params::range_noise> range_noises_;
  sim::NoisesOf<&Params::bearing_noise> bearing_noises_;
  sim::NoisesOf<&Params::elevation_noise> elevation_noises_;
  double now_s_ = 0;
  std::vector<Sighting> sightings_;
  std::vector<Errors> errors_;
};

}  // namespace devices
