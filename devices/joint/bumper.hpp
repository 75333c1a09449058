// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "sim/random/noise.hpp"
#include "sim/vehicle/device_context.hpp"
#include "sim/world/world.hpp"

namespace devices {

/// Contact sensor of parts of the vehicle.  It is updated at every step: a contact that ends before the next sample is
/// reported, with the contact points of the step with the largest force.
class Bumper final : public sim::Sensor {
 public:
  static constexpr const char* meaning = "Contacts of parts of the vehicle: where, with whom and how hard.";
  static constexpr const char* without_effect[] = {"position_m", "rpy_deg"};
  static constexpr double default_rate_hz = 0;
  static constexpr const char* fixed_keys[] = {"parts"};
  enum class When { changes, always };
  struct Params {
    std::vector<std::string> parts;
    double min_force_N = 0;
    When report = When::changes;
    sim::NoiseParams force_noise;
    void read(sim::ParamReader& in);
  };
  struct Place {
    std::string part;
    std::string other;
    sim::Vector3d position_V = sim::Vector3d::Zero();
    sim::Vector3d normal_V = sim::Vector3d::Zero();  ///< points from the other entity into this vehicle
    double force_N = 0;
    void visit_state(sim::StateArchive& archive) { archive(part, other, position_V, normal_V, force_N); }
  };

  Bumper(const Params& params, const sim::DeviceContext& context);
  ~Bumper() override;
  /// Evaluates the contacts of the last step; called by the framework before each step.
  void act(const sim::ActContext& context);
  void measure(const sim::SenseContext& context) override;
  void disturb(double dt_s, sim::Random& random) override;
  /// Applies changed parameters, except the parts.
  void change(const Params& params);
  auto noises() { return std::tie(force_noise_); }
  void visit_state(sim::StateArchive& archive) override {
    archive(force_noise_, looked_, pressed_, max_force_N_, touching_, changed_, sampled_, places_);
  }

  bool touching() const { return touching_; }
  /// Returns whether there is something to report.
  bool is_update() const { return params_.report == When::always || changed_; }
  const std::vector<Place>& places() const { return places_; }

 private:
  void look();
  void add_place(const sim::ContactReport& contact, int own, std::vector<Place>& places) const;
  bool is_own(int part) const;

  Params params_;
  sim::PhysicsWorld& physics_;
  const sim::Vehicle& vehicle_;
  std::vector<int> parts_;  ///< their numbers, sorted
  sim::NoiseOf<&Params::force_noise> force_noise_;
  bool looked_ = true;          ///< whether the last step was evaluated
  std::vector<Place> pressed_;  ///< contacts of the step with the largest force since the last sample
  double max_force_N_ = -1;
  bool touching_ = false;
  bool changed_ = false;
  bool sampled_ = false;
  std::vector<Place> places_;  ///< the reading
};

}  // namespace devices
