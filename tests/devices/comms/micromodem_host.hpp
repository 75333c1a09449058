// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "devices/comms/micromodem_protocol.hpp"

namespace test {

using devices::MicromodemPacket;
using devices::MicromodemProtocol;

/// Keeps what is said and sent; a sound begins when it is asked for.
class MicromodemRecorder final : public devices::MicromodemSide {
 public:
  void emit(const std::string& body) override { reported.push_back(body); }
  Sound transmit(const MicromodemPacket& packet, sim::Time at, bool on_the_second) override {
    sent.push_back(packet);
    seconds.push_back(on_the_second);
    return {at, at + sim::from_seconds(1)};
  }
  Sound interrogate_beacons(sim::Time at, bool on_the_second) override {
    beacons_on_the_second.push_back(on_the_second);
    return {at, at + sim::from_seconds(0.005)};
  }
  sim::Time cancel_pending() override {
    ++called_back;
    return sim::Time{0};
  }
  /// The run began at 2026-03-04 05:06:07 UTC.
  std::int64_t utc_us(sim::Time at) const override { return 1'772'600'767'000'000 + stepped_us + at.count(); }
  double elapsed_s(sim::Time from, sim::Time to) const override { return sim::to_seconds(to - from); }

  std::vector<std::string> take() { return std::exchange(reported, {}); }

  std::vector<std::string> reported;
  std::vector<MicromodemPacket> sent;
  std::vector<bool> seconds, beacons_on_the_second;
  int called_back = 0;
  std::int64_t stepped_us = 0;  // of the clock
};

/// A Micro-Modem without water, and its host.
class HostedMicromodem {
 public:
  explicit HostedMicromodem(MicromodemProtocol::Config config = at_address(1)) : protocol(config, recorder) {
    protocol.tick(now);
    recorder.take();
  }
  static MicromodemProtocol::Config at_address(int address) {
    MicromodemProtocol::Config config;
    config.address = address;
    return config;
  }
  std::vector<std::string> host(const std::string& line) {
    protocol.take_line({line, false}, now);
    return recorder.take();
  }
  std::vector<std::string> wait(double time_s) {
    now += sim::from_seconds(time_s);
    protocol.tick(now);
    return recorder.take();
  }

  MicromodemRecorder recorder;
  MicromodemProtocol protocol;
  sim::Time now{0};
};

}  // namespace test
