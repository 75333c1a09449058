// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include "sim/acoustics/channel.hpp"
#include "tests/devices/sound_positioning/acoustic_probe.hpp"

namespace test {

/// The objects of an acoustic channel without its events: a test calls those that it is about.  There are two
/// transducers, a and b, in the same depth, in water with 1500 m/s and a loss of 20 dB for each factor of ten.
struct SoundObjects {
  /// `acoustics`: more keys, such as ", range_max_m: 50".
  explicit SoundObjects(const std::string& acoustics = "", int apart_m = 100)
      : test(sound_world(float_at("a", "[0, 0, -50]") + float_at("b", "[" + std::to_string(apart_m) + ", 0, -50]"),
                         acoustics)) {
    // The numbers are those in the channel of the world.
    transducers.add(a.transducer);
    transducers.add(b.transducer);
  }

  /// A transmission from `a` at time 0.
  sim::TransmissionId transmit(const sim::Signal& signal) {
    const sim::TransmissionId id = transmissions.add(a.transducer, 1, signal, sim::Time{0});
    transmissions[id].p_W = a.transducer.p_W(sim::Time{0});
    return id;
  }
  /// A flight to `b`.
  sim::FlightId fly(sim::TransmissionId transmission) {
    const sim::FlightId id = flights.add();
    flights[id].transmission = transmission;
    flights[id].set_receiver(&b.transducer);
    ++transmissions[transmission].users;
    flights.update_hash(id);
    return id;
  }
  /// A site on the hull of `a`.
  sim::SoundSite site(const std::string& name) {
    const sim::Vehicle& vehicle = *test.world.find_vehicle("a");
    return {
        test.world.acoustics(), vehicle.body("hull"), sim::Pose::Identity(), vehicle.group(), powered, faults, name};
  }
  std::uint64_t hash_of_flights() {
    sim::StateArchive hash = sim::StateArchive::quick_hasher();
    flights.add_content(hash);
    return hash.hash();
  }

  TestWorld test;
  AcousticProbe a{test, "a"}, b{test, "b"};
  bool powered = true;
  sim::DeviceFaults faults;
  const sim::AcousticsConfig& config = test.world.acoustics().config();
  const sim::Medium& medium = test.world.medium();
  sim::Transducers transducers;
  sim::MotionClock clock;
  sim::Transmissions transmissions;
  sim::Flights flights{transducers};
  sim::SonarEquation sonar{config, medium, test.world.physics(), test.world.seed()};
  sim::Receptions receptions{config, medium, sonar, clock, transmissions, flights};
  sim::ReceiverSearch search{config, medium, sonar.propagation(), transducers};
  sim::SoundReports reports{medium, transducers};
};

}  // namespace test
