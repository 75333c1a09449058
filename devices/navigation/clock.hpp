// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "sim/clock/vehicle_clock.hpp"
#include "sim/vehicle/device_context.hpp"

namespace devices {

/// State of the clock of the vehicle, as reported by an onboard time server.  The true error is published on the truth
/// channel only.
class Clock final : public sim::Sensor {
 public:
  static constexpr const char* meaning = "State of the vehicle's clock: when it was disciplined, how good it may be.";
  static constexpr const char* without_effect[] = {"position_m", "rpy_deg"};
  static constexpr double default_rate_hz = 1;
  struct Params {
    void read(sim::ParamReader&) {}
  };
  struct Reading {
    bool disciplined = false;
    double since_fix_s = -1;
    double estimated_std_s = 0;
    double error_s = 0;
    double rate_error = 0;  ///< mean rate error since the last sample
    void visit_state(sim::StateArchive& archive) {
      archive(disciplined, since_fix_s, estimated_std_s);
      archive.not_only_finite(error_s, rate_error);
    }
  };

  Clock(const Params& params, const sim::DeviceContext& context);
  void measure(const sim::SenseContext& context) override;
  void disturb(double dt_s, sim::Random& random) override;
  void visit_state(sim::StateArchive& archive) override { archive(reading_, last_error_s_); }
  const Reading& reading() const { return reading_; }

 private:
  const sim::VehicleClock& clock_;
  Reading reading_;
  double last_error_s_ = 0;
};

}  // namespace devices
