// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "sim/acoustics/channel.hpp"
#include "sim/vehicle/device_context.hpp"
#include "tests/devices/world_fixture.hpp"

namespace test {

/// What a Hydrophone received, with a copy of the signal.
struct Received {
  sim::Signal signal;
  std::string source;
  sim::Time sent, started, ended;
  double travel_time_s, closing_mps;
  sim::Decibels level, snr, sinr;
  sim::SignalLoss loss;
  bool understood() const { return loss == sim::SignalLoss::none; }
};

/// A device of type `test_hydrophone`: sends what a test tells it to, keeps what it receives.
class Hydrophone final : public sim::Sensor, public sim::AcousticListener {
 public:
  static constexpr const char* meaning = "For tests of the acoustic channel.";
  struct Params {
    sim::ReceiverConfig receiver;
    void read(sim::ParamReader& in) { in.read("receiver", receiver, "of the transducer"); }
  };
  Hydrophone(const Params& params, const sim::DeviceContext& context)
      : transducer_(*this, params.receiver, context.sound_site()) {}

  void measure(const sim::SenseContext&) override {}
  void disturb(double, sim::Random&) override {}
  void visit_state(sim::StateArchive& archive) override {
    auto count = static_cast<std::uint64_t>(received_.size());
    archive(count);
    if (archive.restoring()) received_.resize(count);
  }
  bool listens_to(const sim::Signal& signal) const override { return signal.kind != sim::Signal::Kind::noise; }
  void receive(const sim::Reception& r) override {
    received_.push_back({r.signal, r.source, r.sent, r.started, r.ended, r.travel_time_s, r.closing_mps, r.level, r.snr,
                         r.sinr, r.loss});
    if (answer) answer(r);
  }
  bool wants_undetected() const override { return undetected; }
  sim::Transducer& transducer() { return transducer_; }
  const std::vector<Received>& all() const { return received_; }
  std::function<void(const sim::Reception&)> answer;
  bool undetected = true;

 private:
  sim::Transducer transducer_;
  std::vector<Received> received_;
};

/// The hydrophone `phone` of a vehicle.
inline Hydrophone& phone(LoadedTestWorld& test, const std::string& vehicle) {
  return const_cast<Hydrophone&>(
      dynamic_cast<const Hydrophone&>(*test.world.find_device(vehicle + "/phone")->sensor()));
}

}  // namespace test
