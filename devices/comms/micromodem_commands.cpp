// SPDX-License-Identifier: BSD-3-Clause
// Commands of the host of a Micro-Modem.  Those of its clock are in micromodem_clock.cpp.
#include <algorithm>
#include <map>

#include "devices/comms/micromodem_protocol.hpp"

namespace devices {

namespace {

/// Parses a sequence of a generic transponder: up to 64 bits in hexadecimal digits; none for any other text.
std::optional<bool> is_sequence_set(const std::string& text) {
  constexpr std::size_t max_digits = 20;  // some drivers write 64 bits as a decimal number
  const bool good = !text.empty() && text.size() <= max_digits &&
                    text.find_first_not_of("0123456789abcdefABCDEF") == std::string::npos;
  if (!good) return {};
  return text.find_first_not_of('0') != std::string::npos;
}

}  // namespace

MicromodemProtocol::Command MicromodemProtocol::command_of(const std::string& name) const {
  static const std::map<std::string, Command> commands{
      {"CCCFG", &MicromodemProtocol::configure},
      {"CCCFQ", &MicromodemProtocol::query},
      {"CCCLK", &MicromodemProtocol::set_clock},
      {"CCMSC", &MicromodemProtocol::reset},
      {"CCCYC", &MicromodemProtocol::start_cycle},
      {"CCTXD", &MicromodemProtocol::take_data},
      {"CCMPC", &MicromodemProtocol::send_ping},
      {"CCMUC", &MicromodemProtocol::send_mini},
      {"CCPDT", &MicromodemProtocol::interrogate_remus_beacons},
      {"CCPNT", &MicromodemProtocol::interrogate_narrowband_beacons},
      {"CCPGT", &MicromodemProtocol::interrogate_generic_beacons},
  };
  // A Micro-Modem-1 does not support them.
  static const std::map<std::string, Command> of_second_generation{
      {"CCTMS", &MicromodemProtocol::set_time},
      {"CCTMQ", &MicromodemProtocol::query_time},
  };
  if (const auto found = commands.find(name); found != commands.end()) return found->second;
  const auto found = of_second_generation.find(name);
  const bool known = found != of_second_generation.end() && generation_ >= micromodem_2;
  return known ? found->second : nullptr;
}

std::string MicromodemProtocol::echo(const sim::NmeaSentence& in, const std::string& name) {
  std::string text = name;
  for (std::size_t i = 1; i < in.fields.size(); ++i) text += "," + in.fields[i];
  return text;
}

void MicromodemProtocol::take_line(const sim::NmeaLines::Line& line, sim::Time now) {
  if (is_down(now)) return;
  sim::NmeaSentence in;
  if (line.too_long) {
    error("NMEA", unknown_sentence, "line too long", now);
    return;
  }
  // Parse the sentence.
  switch (sim::parse_nmea(line.text, in)) {
    case sim::NmeaError::no_sentence:
      return;  // noise
    case sim::NmeaError::bad_checksum:
      error("NMEA", 2, "bad checksum", now);
      return;
    case sim::NmeaError::none:
      break;
  }
  // Ignore own sentences echoed by a terminal: an answer would loop forever.
  if (in.name().starts_with("CA") || in.name().starts_with("SN")) return;
  // Execute the command.
  if (const Command command = command_of(in.name()))
    (this->*command)(in, now);
  else
    error("NMEA", unknown_sentence, "unknown sentence " + in.name().substr(0, 16), now);
}

std::optional<std::pair<int, int>> MicromodemProtocol::addresses(const sim::NmeaSentence& in, std::size_t first,
                                                                 sim::Time now) {
  const auto source = in.number(first, 0, micromodem_broadcast - 1);
  const auto destination = in.number(first + 1, 0, micromodem_broadcast);
  if (source && destination) return std::pair{*source, *destination};
  error("NMEA", bad_field, "address must be 0 to 126, or 127 as destination", now);
  return {};
}

void MicromodemProtocol::configure(const sim::NmeaSentence& in, sim::Time now) {
  const auto value = in.number(2, -1000000, 1000000);
  if (!value || in.count() != 2) return error("NMEA", bad_field, "CFG needs a name and a number", now);
  if (in.at(1) == "ALL") {
    if (*value != 0) return error("NMEA", bad_field, "CFG of ALL takes 0 only: factory settings", now);
    settings_.reset();
    return side_.emit("CACFG,ALL,0");
  }
  switch (settings_.set(in.at(1), *value)) {
    case MicromodemSettings::Outcome::unknown:
      return error("NMEA", bad_field, "unknown setting " + in.at(1).substr(0, 16), now);
    case MicromodemSettings::Outcome::out_of_range:
      return error("NMEA", bad_field, "value of " + in.at(1) + " out of range", now);
    case MicromodemSettings::Outcome::done:
      side_.emit("CACFG," + in.at(1) + "," + std::to_string(*value));
  }
}

void MicromodemProtocol::query(const sim::NmeaSentence& in, sim::Time now) {
  if (in.at(1) == "ALL") {
    for (const auto& [name, value] : settings_.all()) side_.emit("CACFG," + name + "," + std::to_string(value));
    return;
  }
  const auto value = settings_.find(in.at(1));
  if (!value) return error("NMEA", bad_field, "unknown setting " + in.at(1).substr(0, 16), now);
  side_.emit("CACFG," + in.at(1) + "," + std::to_string(*value));
}

void MicromodemProtocol::reset(const sim::NmeaSentence& in, sim::Time now) {
  const auto who = addresses(in, 1, now);
  if (!who) return;
  if (who->first != address() || who->second != address())
    return error("MSC", bad_field, "only this modem can be restarted", now);
  if (in.number(3, -1000000, 1000000) != 0)
    return error("MSC", bad_field, "the time to sleep must be 0: there is no sleep", now);
  side_.emit(echo(in, "CAMSC"));
  restart(now + sim::from_seconds(1));
}

void MicromodemProtocol::start_cycle(const sim::NmeaSentence& in, sim::Time now) {
  const auto who = addresses(in, 2, now);
  if (!who) return;
  // Check the fields.
  const int highest_rate = config_.psk ? static_cast<int>(micromodem_rates().size()) - 1 : 0;
  const auto rate = in.number(4, 0, highest_rate);
  if (!rate) return error("CYC", bad_field, "rate must be 0 to " + std::to_string(highest_rate), now);
  const int max = micromodem_rates()[static_cast<std::size_t>(*rate)].frames;
  const auto ack = in.number(5, 0, 1), frames = in.number(6, 1, max);
  if (!ack) return error("CYC", bad_field, "ack must be 0 or 1", now);
  if (!frames) return error("CYC", bad_field, "frames must be 1 to " + std::to_string(max), now);
  if (busy("CYC", now)) return;
  // Confirm, and gather the data of an own cycle.
  side_.emit(echo(in, "CACYC"));
  Cycle cycle{who->first, who->second, *rate, *frames, *ack != 0, false, {}, sim::Time{0}};
  if (cycle.source == address()) return gather(std::move(cycle), now);
  // Requests another modem to send.
  MicromodemPacket packet;
  packet.kind = MicromodemPacket::Kind::cycle_init;
  packet.source = cycle.source, packet.destination = cycle.destination, packet.rate = cycle.rate;
  packet.ack = cycle.ack, packet.frame_count = cycle.frames;
  const auto sound = send(packet, now, settings_.on("SNV"));
  expected_ = Expected{cycle.source, cycle.destination, cycle.rate, cycle.frames,
                       sound.end + sim::from_seconds(settings_.get("CTO"))};
}

void MicromodemProtocol::take_data(const sim::NmeaSentence& in, sim::Time now) {
  const auto who = addresses(in, 1, now);
  if (!who) return;
  // Check that the data were requested.
  if (!cycle_ || who->first != address()) return error("TXD", no_request, "no data was requested", now);
  if (who->second != cycle_->destination)
    return error(
        "TXD", bad_field,
        "the cycle is for " + std::to_string(cycle_->destination) + " and the data for " + std::to_string(who->second),
        now);
  // Decode the data.
  const auto data = sim::from_hex(in.at(4));
  const auto ack = in.number(3, 0, 1);
  if (!data || !ack) return error("TXD", bad_field, "data must be bytes in hexadecimal", now);
  const int room = micromodem_rates()[static_cast<std::size_t>(cycle_->rate)].frame_bytes;
  if (data->size() > static_cast<std::size_t>(room))
    return error("TXD", too_long_data,
                 "data too long: " + std::to_string(data->size()) + " bytes and room for " + std::to_string(room), now);
  side_.emit("CATXD," + in.at(1) + "," + in.at(2) + "," + in.at(3) + "," + std::to_string(data->size()));
  // Add the frame; send the packet when it is complete.
  const bool last = data->empty();
  if (!last || cycle_->gathered.empty()) cycle_->gathered.push_back({*ack != 0, *data});
  if (last || static_cast<int>(cycle_->gathered.size()) == cycle_->frames)
    send_cycle(now);
  else
    request_frame(now);
}

void MicromodemProtocol::send_ping(const sim::NmeaSentence& in, sim::Time now) {
  const auto who = addresses(in, 1, now);
  if (!who) return;
  if (who->first != address() || who->second == address() || who->second == micromodem_broadcast)
    return error("MPC", bad_field, "a ping must be sent from this modem to another", now);
  if (busy("MPC", now)) return;
  side_.emit(echo(in, "CAMPC"));
  MicromodemPacket packet;
  packet.kind = MicromodemPacket::Kind::ping;
  packet.source = who->first, packet.destination = who->second;
  const auto sound = send(packet, now, settings_.on("SNV"));
  // The modem gives up on an answer after the turnaround and the travel times of the maximum range, there and back.
  ping_ = Ping{who->second, sound.begin, sound.begin + sim::from_seconds(micromodem_turnaround_s + 6)};
}

void MicromodemProtocol::send_mini(const sim::NmeaSentence& in, sim::Time now) {
  const auto who = addresses(in, 1, now);
  if (!who) return;
  const std::string& hex = in.at(3);
  // A mini packet carries 13 bits.
  const bool good = !hex.empty() && hex.size() <= 4 &&
                    hex.find_first_not_of("0123456789abcdefABCDEF") == std::string::npos &&
                    std::stoi(hex, nullptr, 16) <= 0x1fff;
  if (!good) return error("MUC", bad_field, "data must be 0000 to 1fff", now);
  if (who->first != address()) return error("MUC", bad_field, "the source is not this modem", now);
  if (busy("MUC", now)) return;
  side_.emit(echo(in, "CAMUC"));
  MicromodemPacket packet;
  packet.kind = MicromodemPacket::Kind::mini;
  packet.source = who->first, packet.destination = who->second, packet.value = std::stoi(hex, nullptr, 16);
  send(packet, now, settings_.on("SNV"));
}

/// $CCPDT,group,channel,synchronous,sync timeout,timeout,A,B,C,D: flags.
void MicromodemProtocol::interrogate_remus_beacons(const sim::NmeaSentence& in, sim::Time now) {
  const auto on_the_second = in.number(3, 0, 1);
  BeaconPing ping;
  bool good = on_the_second.has_value();
  for (std::size_t i = 0; i < micromodem_beacons; ++i) {
    const auto requested = in.number(6 + i, 0, 1);
    good = good && requested;
    ping.is_requested[i] = requested.value_or(0) != 0;
  }
  interrogate_beacons(in, good, in.number(5, 1, max_beacon_ms), ping, on_the_second.value_or(0) != 0, now);
}

/// $CCPNT,frequency,length,length of the answers,timeout,A,B,C,D: frequencies,flag: 1 at once, 0 by the pulse.
void MicromodemProtocol::interrogate_narrowband_beacons(const sim::NmeaSentence& in, sim::Time now) {
  const auto at_once = in.number(9, 0, 1);
  BeaconPing ping;
  bool good = at_once.has_value();
  for (std::size_t i = 0; i < micromodem_beacons; ++i) {
    const auto frequency_Hz = in.number(5 + i, 0, 1000000);
    good = good && frequency_Hz;
    ping.is_requested[i] = frequency_Hz.value_or(0) != 0;
  }
  interrogate_beacons(in, good, in.number(4, 1, max_beacon_ms), ping, at_once.value_or(1) == 0, now);
}

/// $CCPGT,frequency,bits,sequence,timeout,frequency of the answers,A,B,C,D: sequences,bandwidth,reserved.
void MicromodemProtocol::interrogate_generic_beacons(const sim::NmeaSentence& in, sim::Time now) {
  BeaconPing ping;
  bool good = is_sequence_set(in.at(3)).has_value();
  for (const std::size_t frequency : {1, 5}) good = good && in.number(frequency, 1, 1000000);
  good = good && in.number(2, 1, 64) && in.number(10, 0, 1000000);
  for (std::size_t i = 0; i < micromodem_beacons; ++i) {
    const auto requested = is_sequence_set(in.at(6 + i));
    good = good && requested;
    ping.is_requested[i] = requested.value_or(false);
  }
  interrogate_beacons(in, good, in.number(4, 1, max_beacon_ms), ping, false, now);
}

/// The frequencies and sequences are those of the configured transponders; the host only selects which of them are
/// interrogated.
void MicromodemProtocol::interrogate_beacons(const sim::NmeaSentence& in, bool good, std::optional<int> timeout_ms,
                                             BeaconPing ping, bool on_the_second, sim::Time now) {
  const std::string name = in.name().substr(2);
  if (!good || !timeout_ms) return error("NMEA", bad_field, name + " has a field out of range", now);
  if (busy("LBL", now)) return;
  side_.emit(echo(in, "SN" + name));
  const auto sound = side_.interrogate_beacons(now, on_the_second);
  sending_until_ = std::max(sending_until_, sound.end);
  ping.sent = sound.begin;
  ping.deadline = sound.begin + sim::from_seconds(*timeout_ms * 1e-3);
  ping.turnaround_s = settings_.get("TAT") * 1e-3;
  beacon_ping_ = ping;
}

}  // namespace devices
