// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>

#include "sim/acoustics/transducer.hpp"
#include "sim/vehicle/device_context.hpp"

namespace devices {

/// Noise source in the water that interferes with modems and transponders: an engine, a pile driver, a jammer, the
/// sonar of another vehicle.  `continuous` noise has no travel time and is added to the ambient noise; pulses propagate
/// as signals.
class NoiseSource final : public sim::Actuator, public sim::AcousticListener {
 public:
  static constexpr const char* meaning = "Makes noise under water: an engine, a jammer, another vehicle's sonar.";
  static constexpr sim::SafeState safe_states[] = {sim::SafeState::stop, sim::SafeState::hold};
  static constexpr const char* fixed_keys[] = {"kind", "frequency_Hz", "bandwidth_Hz"};
  enum class Kind { continuous, pulses };
  struct Params {
    Kind kind = Kind::continuous;
    bool on = true;
    double level_dB = 150;
    double frequency_Hz = 25000;
    double bandwidth_Hz = 4000;
    std::optional<double> period_s;
    double sound_s = 0.1;
    void read(sim::ParamReader& in);
  };

  NoiseSource(const Params& params, const sim::DeviceContext& context);
  void change(const Params& params);
  void set_command(double value) { on_ = value != 0; }
  void act(const sim::ActContext& context) override;
  void make_safe(sim::SafeState safe) override;
  void visit_state(sim::StateArchive& archive) override;
  bool sounding() const { return sound_ && sound_->on(); }

  bool listens_to(const sim::Signal&) const override { return false; }
  void receive(const sim::Reception&) override {}

 private:
  void send_pulses(const sim::ActContext& context);

  Params params_;
  std::optional<sim::ContinuousSound> sound_;
  std::optional<sim::Transducer> transducer_;
  bool on_;
};

}  // namespace devices
