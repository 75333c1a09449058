// SPDX-License-Identifier: BSD-3-Clause
#include <cmath>

#include "bridges/nmea/ais_payload.hpp"
#include "bridges/nmea/steering.hpp"
#include "tests/fuzz/fuzz_input.hpp"

// What a client sends to shoal-nmea; each sentence also as every other type, and as the payload of an AIS message.

namespace {

template <class Sentence>
void read_and_write(const sim::NmeaSentence& sentence) {
  const auto read = bridges::nmea::read<Sentence>(sentence);
  if (!read) return;
  const std::string text = bridges::nmea::format(*read, "GP");
  sim::NmeaSentence again;
  fuzz::require(sim::parse_nmea(text, again) == sim::NmeaError::none, "what was read is written as a sentence");
}

void read_ais(const std::string& payload) {
  const auto message = bridges::nmea::read_ais_payload(payload);
  if (!message) return;
  const auto again = bridges::nmea::read_ais_payload(bridges::nmea::ais_payload(*message, 0));
  fuzz::require(again && again->mmsi == message->mmsi && again->type == message->type,
                "a message is written as it was read");
}

}  // namespace

SHOAL_FUZZ_TARGET(nmea_client) {
  using namespace bridges::nmea;
  Steering steering(10);
  sim::NmeaLines lines;
  std::int64_t utime = 0;
  for (const auto& line : lines.add(input)) {
    steering.take(line.text, utime += 1'000'000);
    if (const auto command = steering.take_command())
      fuzz::require(std::abs(command->heading_rad) <= 3.15, "a commanded heading is an angle");
    sim::NmeaSentence sentence;
    if (sim::parse_nmea(line.text, sentence, '!') == sim::NmeaError::none) read_ais(sentence.at(5));
    if (sim::parse_nmea(line.text, sentence) != sim::NmeaError::none) continue;
    read_and_write<Rmc>(sentence);
    read_and_write<Gga>(sentence);
    read_and_write<Vtg>(sentence);
    read_and_write<Vhw>(sentence);
    read_and_write<Mwv>(sentence);
    read_and_write<Xdr>(sentence);
    read_and_write<Apb>(sentence);
    read_and_write<Rmb>(sentence);
  }
}
