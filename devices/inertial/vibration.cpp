// SPDX-License-Identifier: BSD-3-Clause
#include "devices/inertial/vibration.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "messages/reporter/message_reporter.hpp"
#include "shoal/vibration_t.hpp"
#include "sim/config/message_text.hpp"
#include "sim/world/world.hpp"

namespace devices {

namespace {

double corner_time_s(double corner_Hz) {
  return 1 / (2 * std::numbers::pi * corner_Hz);
}

}  // namespace

void Vibration::Params::read(sim::ParamReader& in) {
  in.read("low_Hz", low_Hz, sim::above(0), "lower end of the band");
  in.read("high_Hz", high_Hz, sim::above(0), "upper end of the band");
  in.read("noise", noise, "error of the root mean square, m/s^2");
  if (!in.describing() && !(high_Hz > low_Hz))
    in.error("high_Hz",
             "'high_Hz' must be > 'low_Hz', " + sim::number_text(low_Hz) + ", got " + sim::number_text(high_Hz));
}

Vibration::Vibration(const Params& params, const sim::DeviceContext& context)
    : world_(context.world),
      vehicle_(context.vehicle),
      body_(context.body),
      X_BS_(context.config.X_BS()),
      strapdown_(context),
      below_high_(corner_time_s(params.high_Hz)),
      below_low_(corner_time_s(params.low_Hz)),
      noise_(context, params) {}

void Vibration::change(const Params& params) {
  below_high_.change(corner_time_s(params.high_Hz));
  below_low_.change(corner_time_s(params.low_Hz));
}

void Vibration::displaced() {
  strapdown_.restart();
  below_high_.restart();
  below_low_.restart();
}

void Vibration::act(const sim::ActContext& context) {
  const double step_s = context.step_s;
  strapdown_.measure(
      {world_, vehicle_, context.now, step_s, body_.X_WB() * X_BS_, body_.velocity_at_W(X_BS_.translation())});
  const sim::Vector3d below_high = below_high_.apply(strapdown_.f_S(), step_s);
  const double magnitude = (below_high - below_low_.apply(below_high, step_s)).norm();
  squares_ += magnitude * magnitude;
  greatest_ = std::max(greatest_, magnitude);
  ++count_;
}

void Vibration::measure(const sim::SenseContext&) {
  rms_mps2_ = count_ > 0 ? std::sqrt(squares_ / static_cast<double>(count_)) : 0;
  peak_mps2_ = greatest_;
  squares_ = greatest_ = 0;
  count_ = 0;
}

void Vibration::disturb(double dt_s, sim::Random& random) {
  noise_.apply(rms_mps2_, dt_s, random);
  rms_mps2_ = std::max(rms_mps2_, 0.0);
}

void fill(const Vibration& vibration, shoal::vibration_t& message) {
  message.rms_mps2 = vibration.rms_mps2();
  message.peak_mps2 = vibration.peak_mps2();
}

SHOAL_SENSOR("vibration", Vibration, shoal::vibration_t);

}  // namespace devices
