// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include "sim/random/noise.hpp"
#include "sim/vehicle/device_context.hpp"

namespace devices {

/// Positions of the other vehicles within range, relative to the sensor and, if configured, in the world frame.
class SwarmPosition final : public sim::Sensor {
 public:
  static constexpr const char* meaning = "Relative (and absolute) positions of the other vehicles within range.";
  static constexpr double default_rate_hz = 5;
  struct Params {
    double range_max_m = 30;
    bool absolute = false;
    bool occlusion = false;
    std::vector<std::string> see_through;  ///< categories of parts that do not occlude a vehicle
    sim::NoiseParams relative_noise;
    sim::NoiseParams absolute_noise;
    void read(sim::ParamReader& in);
  };
  /// Detection of another vehicle.
  struct Sighting {
    int vehicle = -1;  ///< number of the vehicle in the world
    std::string name;
    sim::Vector3d p_SV_S = sim::Vector3d::Zero();  ///< relative to the sensor, in its frame
    sim::Vector3d p_WV = sim::Vector3d::Zero();
    void visit_state(sim::StateArchive& archive) { archive(vehicle, name, p_SV_S, p_WV); }
  };

  SwarmPosition(const Params& params, const sim::DeviceContext& context);
  void measure(const sim::SenseContext& context) override;
  void disturb(double dt_s, sim::Random& random) override;
  void visit_state(sim::StateArchive& archive) override;
  /// Returns the vehicles detected, in the order of the world.
  const std::vector<Sighting>& sightings() const { return sightings_; }
  bool absolute() const { return params_.absolute; }

 private:
  /// Noise states of the measurements of one vehicle.
  struct Errors {
    int vehicle = -1;
    sim::Noise relative, absolute;
    double seen_at_s = 0;
  };
  bool visible(const sim::SenseContext& context, const sim::Vehicle& other) const;
  Errors& errors_of(const Sighting& sighting);
  Errors new_errors(int vehicle, const std::string& name) const;
  void make_errors_of(const std::vector<int>& seen, const sim::StateArchive& archive);

  Params params_;
  std::uint32_t categories_ = ~0u;
  sim::NoisesOf<&Params::relative_noise> relative_noises_;
  sim::NoisesOf<&Params::absolute_noise> absolute_noises_;
  std::vector<Sighting> sightings_;
  std::vector<Errors> errors_;     ///< of each vehicle detected so far, in the order of detection
  std::vector<int> errors_index_;  ///< index in errors_ by vehicle number; -1: not detected yet
  double now_s_ = 0;
};

}  // namespace devices
