// SPDX-License-Identifier: BSD-3-Clause
#include "messages/reporter/message_reporter.hpp"
#include "sim/device/plugin.hpp"
#include "sim/random/noise.hpp"
#include "sim/vehicle/device_context.hpp"
#include "thermometer/array_lengths.hpp"
#include "thermometer/temperature_t.hpp"

namespace {

/// Temperature of a field with a constant gradient along each axis of the world.
class Thermometer final : public sim::Sensor {
 public:
  static constexpr const char* meaning = "Temperature of a linear field.";
  static constexpr double default_rate_hz = 1;
  struct Params {
    double origin_degc = 15;
    sim::Vector3d slope_degcpm = {0, 0, -0.0065};
    sim::NoiseParams noise;
    void read(sim::ParamReader& in) {
      in.read("origin_degc", origin_degc, sim::at_least(-273.15), "temperature at the origin of the world");
      in.read("slope_degcpm", slope_degcpm, sim::any_number(), "its change per meter along x, y and z");
      in.read("noise", noise, "error of the temperature, degrees");
    }
  };

  Thermometer(const Params& params, const sim::DeviceContext& context) : params_(params), noise_(context, params) {}
  auto noises() { return std::tie(noise_); }

  void measure(const sim::SenseContext& context) override {
    temperature_degc_ = params_.origin_degc + params_.slope_degcpm.dot(context.X_WS.translation());
  }
  void disturb(double dt_s, sim::Random& random) override { noise_.apply(temperature_degc_, dt_s, random); }
  void visit_state(sim::StateArchive& archive) override { archive(noise_, temperature_degc_); }

  double temperature_degc() const { return temperature_degc_; }

 private:
  Params params_;
  sim::NoiseOf<&Params::noise> noise_;
  double temperature_degc_ = 0;
};

void fill(const Thermometer& thermometer, thermometer::temperature_t& message) {
  message.temperature_degc = thermometer.temperature_degc();
}

SHOAL_SENSOR("thermometer", Thermometer, thermometer::temperature_t);

}  // namespace

SHOAL_PLUGIN("thermometer", "1.0");
