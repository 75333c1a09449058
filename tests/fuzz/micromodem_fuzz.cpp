// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>

#include "devices/comms/micromodem_protocol.hpp"
#include "tests/fuzz/fuzz_input.hpp"

// What a program writes to the serial port of a Micro-Modem, and what comes through the water meanwhile.

namespace {

using devices::MicromodemPacket;

/// The modem around the protocol, and water that carries everything at once.
class Side final : public devices::MicromodemSide {
 public:
  std::size_t reported = 0;

  void emit(const std::string& body) override { reported += body.size(); }
  Sound transmit(const MicromodemPacket& packet, sim::Time at, bool) override {
    fuzz::require(MicromodemPacket::read(packet.code(), packet.payload()).has_value(),
                  "what a modem sends another one can read");
    return {at, at + sim::Time{1'000'000}};
  }
  Sound interrogate_beacons(sim::Time at, bool) override { return {at, at + sim::Time{5'000}}; }
  sim::Time cancel_pending() override { return sim::Time{0}; }
  std::int64_t utc_us(sim::Time at) const override { return 1'767'225'600'000'000 + at.count(); }
  double elapsed_s(sim::Time from, sim::Time to) const override { return sim::to_seconds(to - from); }
};

}  // namespace

/// Control characters steer the world; all else is from the host.
SHOAL_FUZZ_TARGET(micromodem) {
  enum Control : char { tick = 1, wait = 2, packet = 3, beacon = 4, restart = 5, modem_2 = 6 };
  Side side;
  devices::MicromodemProtocol::Config config;
  if (!input.empty() && input.front() == std::byte{modem_2}) config.revision = "2.0.30000";
  devices::MicromodemProtocol protocol(config, side);
  sim::NmeaLines lines;
  sim::Time now{0};
  fuzz::Reader reader(input);
  while (!reader.ended()) {
    const char next = static_cast<char>(reader.byte());
    now += sim::Time{100};
    switch (next) {
      case tick:
        now += sim::Time{100'000};
        break;
      case wait:
        now += sim::Time{10'000'000};
        break;
      case packet: {
        const std::string code = reader.text();
        const fuzz::Input payload = reader.bytes(reader.byte());
        const auto received = MicromodemPacket::read(code, sim::Bytes(payload.begin(), payload.end()));
        if (received)
          protocol.receive(*received, {now, now + sim::Time{900'000}, 80, 20, 0.5, 60, reader.below(2) == 0});
        break;
      }
      case beacon:
        protocol.beacon_answered(static_cast<int>(reader.below(devices::micromodem_beacons)), now);
        break;
      case restart:
        protocol.restart(now + sim::Time{500'000});
        break;
      default: {
        const std::byte byte{static_cast<unsigned char>(next)};
        for (const auto& line : lines.add({&byte, 1})) protocol.take_line(line, now);
      }
    }
    protocol.tick(now);
  }
}
