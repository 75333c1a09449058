// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <string>

#include "devices/sound_positioning/acoustic_positioning.hpp"
#include "sim/acoustics/transducer.hpp"

namespace devices {

/// Acoustic transponder: answers the pings of other vehicles in its network on its own frequency.
/// The answer starts `turnaround_s` after the start of the ping, but not before the ping has ended.  A ping received
/// while an answer is pending is not answered.
class Transponder final : public sim::Sensor, public sim::AcousticListener {
 public:
  static constexpr const char* meaning = "Acoustic transponder: answers USBL and LBL devices of its network.";
  static constexpr double default_rate_hz = 1;
  struct Params {
    std::string network = "usbl";
    std::string code;
    double turnaround_s = 0.02;
    double source_level_dB = 185;
    double frequency_Hz = 26000;
    std::optional<double> answer_frequency_Hz;
    double bandwidth_Hz = 1000;
    double ping_s = 0.01;
    sim::ReceiverConfig receiver = receiver_of_tones();
    void read(sim::ParamReader& in);
  };

  Transponder(const Params& params, const sim::DeviceContext& context);
  ~Transponder() override;
  Transponder(const Transponder&) = delete;
  Transponder& operator=(const Transponder&) = delete;

  void measure(const sim::SenseContext&) override {}
  void disturb(double, sim::Random&) override {}
  void visit_state(sim::StateArchive& archive) override;
  bool listens_to(const sim::Signal& signal) const override;
  void receive(const sim::Reception& received) override;
  bool wants_undetected() const override { return false; }

  const Params& params() const { return params_; }
  double answer_Hz() const { return answer_Hz_; }
  const sim::Vehicle& vehicle() const { return vehicle_; }
  const std::string& full_name() const { return transducer_.full_name(); }
  std::int64_t answers() const { return answers_; }
  const std::string& asked_by() const { return asked_by_; }

 private:
  Params params_;
  const sim::Vehicle& vehicle_;
  TransponderNetwork& network_;
  double answer_Hz_;
  sim::Transducer transducer_;
  std::int64_t answers_ = 0;
  std::string asked_by_;
};

}  // namespace devices
