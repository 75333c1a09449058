// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "sim/random/noise.hpp"
#include "sim/vehicle/device_context.hpp"
#include "sim/vehicle/vehicle.hpp"

namespace devices {

/// Battery of a vehicle, at most one: an open-circuit voltage E that falls with the charge, in series with an internal
/// resistance R (the Rint model; Plett, Battery Management Systems, vol. I: Battery Modeling, 2015).  The current I
/// follows from the power P drawn by the vehicle: E I - R I^2 = P; the charge decreases by the power E I.  When P
/// exceeds E^2 / 4R, the voltage drops to E / 2, and the power is limited to that value.
class Battery final : public sim::Sensor {
 public:
  static constexpr const char* meaning =
      "Battery of the vehicle: drained by its devices; when it is empty, they are off.";
  static constexpr const char* without_effect[] = {"position_m", "rpy_deg"};
  static constexpr double default_rate_hz = 1;
  static constexpr bool always_on = true;
  static constexpr const char* fixed_keys[] = {"initial_charge"};
  struct Params {
    double capacity_Wh = 100;
    double initial_charge = 1;
    std::vector<double> open_circuit_V = {11, 12.6};
    double internal_resistance_ohm = 0;
    sim::NoiseParams voltage_noise;
    sim::NoiseParams current_noise;
    sim::NoiseParams charge_noise;
    void read(sim::ParamReader& in);
  };
  struct Reading {
    double voltage_V = 0, current_A = 0, charge = 1, energy_J = 0;
    bool empty = false;
    void visit_state(sim::StateArchive& archive) { archive(voltage_V, current_A, charge, energy_J, empty); }
  };

  Battery(const Params& params, const sim::DeviceContext& context);
  /// Discharges it by the energy that the devices have drawn since the last step.
  void act(const sim::ActContext& context);
  void measure(const sim::SenseContext& context) override;
  void disturb(double dt_s, sim::Random& random) override;
  /// Applies changed parameters.  The state of charge, as a share of the capacity, is kept.
  void change(const Params& params);
  auto noises() { return std::tie(voltage_noise_, current_noise_, charge_noise_); }
  void visit_state(sim::StateArchive& archive) override {
    archive(voltage_noise_, current_noise_, charge_noise_, energy_J_, current_A_, reading_);
  }
  const Reading& reading() const { return reading_; }
  double energy_J() const { return energy_J_; }

 private:
  double capacity_J() const { return params_.capacity_Wh * 3600; }
  double open_circuit_V() const;
  double drawn_W(double step_s);

  Params params_;
  sim::Vehicle& vehicle_;
  sim::NoiseOf<&Params::voltage_noise> voltage_noise_;
  sim::NoiseOf<&Params::current_noise> current_noise_;
  sim::NoiseOf<&Params::charge_noise> charge_noise_;
  double energy_J_;
  double current_A_ = 0;
  Reading reading_;
};

}  // namespace devices
