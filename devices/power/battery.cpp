// SPDX-License-Identifier: BSD-3-Clause
#include "devices/power/battery.hpp"

#include <algorithm>
#include <cmath>

#include "devices/joint/joint_of_device.hpp"
#include "messages/reporter/message_reporter.hpp"
#include "shoal/battery_t.hpp"
#include "sim/vehicle/mounted_device.hpp"

namespace devices {

void Battery::Params::read(sim::ParamReader& in) {
  in.read("capacity_Wh", capacity_Wh, sim::above(0), "energy that a full battery gives");
  in.read("initial_charge", initial_charge, sim::between(0, 1), "share of the capacity at the start");
  in.read("open_circuit_V", open_circuit_V, sim::above(0),
          "voltages without a load, from empty to full at even shares of the charge; straight lines between");
  if (!in.describing() && open_circuit_V.empty()) {
    in.error("open_circuit_V", "'open_circuit_V' must have at least one voltage");
    // Reading continues after the error, and a curve needs a point.
    open_circuit_V = {12};
  }
  in.read("internal_resistance_ohm", internal_resistance_ohm, sim::at_least(0), "voltage drop per A");
  in.read("voltage_noise", voltage_noise, "error of the voltage, V");
  in.read("current_noise", current_noise, "error of the current, A");
  in.read("charge_noise", charge_noise, "error of the charge, which is a share from 0 to 1");
}

Battery::Battery(const Params& params, const sim::DeviceContext& context)
    : params_(params),
      vehicle_(context.vehicle),
      voltage_noise_(context, params),
      current_noise_(context, params),
      charge_noise_(context, params),
      energy_J_(capacity_J() * params.initial_charge) {
  if (vehicle_.systems().metered) refuse(context, "the vehicle already has a battery");
  vehicle_.systems().metered = true;
}

double Battery::open_circuit_V() const {
  const std::vector<double>& table = params_.open_circuit_V;
  const double at = std::clamp(energy_J_ / capacity_J(), 0.0, 1.0) * static_cast<double>(table.size() - 1);
  const auto low = static_cast<std::size_t>(at);
  if (low + 1 >= table.size()) return table.back();
  return std::lerp(table[low], table[low + 1], at - static_cast<double>(low));
}

/// Returns the power of the actuators in a step plus the constant power of all devices.
double Battery::drawn_W(double step_s) {
  sim::VehicleSystems& systems = vehicle_.systems();
  double power_W = systems.drawn_J / step_s;
  systems.drawn_J = 0;
  if (!systems.powered) return 0;
  for (const sim::MountedDevice* device : vehicle_.devices()) power_W += device->config().power_W;
  return power_W;
}

void Battery::act(const sim::ActContext& context) {
  const double power_W = drawn_W(context.step_s);
  const double E = open_circuit_V(), R = params_.internal_resistance_ohm;
  // Smaller root of R I^2 - E I + P = 0, in the form that is also valid for R = 0.
  const double root = std::sqrt(std::max(E * E - 4 * R * power_W, 0.0));
  current_A_ = E * E < 4 * R * power_W ? E / (2 * R) : 2 * power_W / (E + root);
  energy_J_ -= E * current_A_ * context.step_s;
  // Treat a remainder due to rounding as empty, to avoid an additional step.
  if (energy_J_ > 1e-6 * E * current_A_ * context.step_s) return;
  energy_J_ = 0;
  current_A_ = 0;
  vehicle_.systems().powered = false;
}

void Battery::measure(const sim::SenseContext&) {
  reading_.current_A = current_A_;
  reading_.voltage_V = open_circuit_V() - params_.internal_resistance_ohm * current_A_;
  reading_.energy_J = energy_J_;
  reading_.charge = energy_J_ / capacity_J();
  reading_.empty = energy_J_ <= 0;
}

void Battery::disturb(double dt_s, sim::Random& random) {
  voltage_noise_.apply(reading_.voltage_V, dt_s, random);
  current_noise_.apply(reading_.current_A, dt_s, random);
  charge_noise_.apply(reading_.charge, dt_s, random);
  reading_.charge = std::clamp(reading_.charge, 0.0, 1.0);
  reading_.energy_J = reading_.charge * capacity_J();  // a fuel gauge derives the energy from the charge
}

void Battery::change(const Params& params) {
  const double charge = energy_J_ / capacity_J();
  params_ = params;
  energy_J_ = charge * capacity_J();
}

void fill(const Battery& battery, shoal::battery_t& message) {
  const Battery::Reading& reading = battery.reading();
  message.voltage_V = reading.voltage_V;
  message.current_A = reading.current_A;
  message.charge = reading.charge;
  message.energy_J = reading.energy_J;
  message.empty = reading.empty;
}

SHOAL_SENSOR("battery", Battery, shoal::battery_t);

}  // namespace devices
