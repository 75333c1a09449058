// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>

#include "sim/acoustics/channel.hpp"
#include "sim/vehicle/device_context.hpp"
#include "sim/vehicle/vehicle.hpp"
#include "tests/devices/world_fixture.hpp"

namespace test {

/// A transducer on a vehicle that is not a device: it listens to everything and keeps what it receives.  Ends before
/// the world.
class AcousticProbe final : public sim::AcousticListener {
 public:
  struct Received {
    sim::Signal signal;
    std::string source;
    sim::Time sent{0}, started{0}, ended{0};
    double travel_time_s = 0, closing_mps = 0;
    sim::Vector3d p_sent_W = sim::Vector3d::Zero(), p_started_W = sim::Vector3d::Zero();
    double level_dB = 0, snr_dB = 0, sinr_dB = 0;
    sim::SignalLoss loss = sim::SignalLoss::none;
  };

  AcousticProbe(LoadedTestWorld& test, const std::string& vehicle, const sim::ReceiverConfig& receiver = {})
      : world_(test.world), transducer(*this, receiver, site(vehicle)) {}

  bool listens_to(const sim::Signal&) const override { return listening; }
  void receive(const sim::Reception& received) override {
    all.push_back({received.signal, received.source, received.sent, received.started, received.ended,
                   received.travel_time_s, received.closing_mps, received.p_sent_W, received.p_started_W,
                   received.level.dB(), received.snr.dB(), received.sinr.dB(), received.loss});
  }
  /// A signal to be noticed, from now on.
  static sim::Signal tone(double source_level_dB = 180, double duration_s = 0.01) {
    sim::Signal signal;
    signal.source_level = sim::Decibels{source_level_dB};
    signal.duration = sim::from_seconds(duration_s);
    return signal;
  }
  void send(const sim::Signal& signal) { transducer.transmit(signal, world_.now()); }
  std::size_t understood() const {
    return static_cast<std::size_t>(
        std::count_if(all.begin(), all.end(), [](const Received& each) { return each.loss == sim::SignalLoss::none; }));
  }

 private:
  sim::SoundSite site(const std::string& vehicle) {
    for (const auto& each : world_.vehicles())
      if (each->name() == vehicle)
        return {world_.acoustics(), each->body("hull"),      sim::Pose::Identity(),
                each->group(),      each->systems().powered, faults_,
                vehicle + "/probe"};
    throw std::runtime_error("no vehicle '" + vehicle + "'");
  }

  sim::World& world_;
  sim::DeviceFaults faults_;

 public:
  sim::Transducer transducer;
  bool listening = true;
  std::vector<Received> all;
};

/// A vehicle that only is in the water: a box of 0.2 m.  An entry of the list of vehicles, indented by two spaces.
inline std::string float_at(const std::string& name, const std::string& position_m, const std::string& devices = "",
                            const std::string& entry = "") {
  return "  - {name: " + name + ", position_m: " + position_m + entry +
         ", model: {shoal: 1, vehicle: float, bodies: [{name: hull, hydrodynamics: {model: none}, parts: [{shape: "
         "box, size_m: [0.2, 0.2, 0.2], mass_kg: 1}]}], devices: [" +
         devices + "]}}\n";
}

/// Water of one speed of sound without absorption, and spherical spreading: 20 dB for each factor of ten.
inline std::string sound_world(const std::string& vehicles, const std::string& acoustics = "",
                               const std::string& objects = "[]") {
  return "shoal: 1\nphysics: {step_s: 0.01, gravity_mps2: 0}\n"
         "medium: {water: {surface_m: 0, sound_speed_mps: 1500}}\n"
         "acoustics: {spreading: {factor: 2}, absorption: {model: constant, dBpkm: 0}" +
         acoustics + "}\nobjects: " + objects + "\nvehicles:\n" + vehicles;
}

}  // namespace test
