// SPDX-License-Identifier: BSD-3-Clause
#include "devices/comms/micromodem_packet.hpp"
#include "sim/nmea/nmea.hpp"
#include "tests/fuzz/fuzz_input.hpp"

// Sentences of NMEA 0183, hexadecimal data, and what a Micro-Modem takes from the water.

SHOAL_FUZZ_TARGET(nmea) {
  sim::NmeaLines lines;
  std::size_t bytes = 0;
  for (const auto& line : lines.add(input)) {
    bytes += line.text.size();
    fuzz::require(line.text.size() <= sim::NmeaLines::longest, "lines are bounded");
    sim::NmeaSentence sentence;
    if (sim::parse_nmea(line.text, sentence) != sim::NmeaError::none) continue;
    for (std::size_t i = 0; i <= sentence.count(); ++i) {
      sentence.number(i, 0, 255);
      if (const auto data = sim::from_hex(sentence.at(i)))
        fuzz::require(sim::to_hex(*data).size() == sentence.at(i).size(), "to_hex() is as long as what was read");
    }
  }
  fuzz::require(bytes <= input.size(), "lines do not overlap");
  const std::string_view text = fuzz::text_of(input);
  const std::size_t end = std::min(text.find('\0'), text.size());
  const fuzz::Input rest = input.subspan(std::min(end + 1, input.size()));
  const auto packet = devices::MicromodemPacket::read(std::string(text.substr(0, end)), {rest.begin(), rest.end()});
  if (!packet) return;
  const auto again = devices::MicromodemPacket::read(packet->code(), packet->payload());
  fuzz::require(again && again->code() == packet->code(), "a packet is sent as it was received");
}
