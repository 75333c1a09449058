// SPDX-License-Identifier: BSD-3-Clause
#include "devices/comms/micromodem.hpp"

#include <algorithm>
#include <map>
#include <utility>

#include "devices/common/named_vehicle.hpp"
#include "devices/comms/modem.hpp"
#include "shoal/message_codec.hpp"
#include "shoal/nmea_sentence_t.hpp"
#include "sim/base/log.hpp"
#include "sim/config/message_text.hpp"
#include "sim/world/world.hpp"

namespace devices {

namespace {

MicromodemProtocol::Config protocol_config(const Micromodem::Params& params) {
  MicromodemProtocol::Config config;
  config.address = params.address;
  config.psk = params.psk;
  config.synchronous = params.synchronous;
  config.revision = params.revision;
  config.frequency_Hz = params.frequency_Hz;
  if (params.lbl) config.beacon_turnaround_s = params.lbl->turnaround_s;
  return config;
}

}  // namespace

/// Names of the modems of a world by network and address.
struct Micromodem::Addresses {
  std::map<std::pair<std::string, int>, std::vector<std::string>> names;
};

const sim::SharedKind<Micromodem::Addresses> Micromodem::addresses_of_world;

void MicromodemBeaconParams::read(sim::ParamReader& in) {
  in.read("network", network, "network of the transponders");
  in.read("transponders", transponders, "up to four, distinguished by their answers: vehicle, or vehicle/device");
  in.read("turnaround_s", turnaround_s, sim::between(0, 10),
          "turnaround time of the transponders, subtracted from the travel times");
  in.read("ping_s", ping_s, sim::between(1e-4, 1), "duration of the interrogation ping");
  in.read("frequency_Hz", frequency_Hz, sim::between(100, 1e6), "frequency of the interrogation ping");
  in.read("bandwidth_Hz", bandwidth_Hz, sim::between(1, 1e6), "bandwidth of the interrogation ping");
  if (!in.describing() && transponders.size() > micromodem_beacons)
    in.error("transponders", "'transponders' must be at most 4, got " + std::to_string(transponders.size()));
}

void Micromodem::Params::read(sim::ParamReader& in) {
  in.read("address", address, sim::between(0, micromodem_broadcast - 1), "its own address; 127 means broadcast");
  in.read("psk", psk, "whether it has the co-processor that rates 1 to 6 need");
  in.read("synchronous", synchronous,
          "sends at whole seconds of the vehicle's clock from the start (setting SNV), for one-way travel times");
  in.read("network", network, "only modems of the same network understand each other; others act as noise");
  in.read("revision", revision, "revision of its software, in $CAREV; from 2 on it takes $CCTMS beside $CCCLK");
  in.read("source_level_dB", source_level_dB, sim::between(0, 300), "re 1 uPa at 1 m, on its axis");
  in.read("frequency_Hz", frequency_Hz, sim::between(2500, 1e6), "middle of its band");
  in.read("coding_gain_dB", coding_gain_dB, sim::between(0, 60), "coding gain on Eb/N0");
  in.read("transmit_power_W", transmit_power_W, sim::at_least(0), "power drawn from the battery while it transmits");
  in.read("receiver", receiver, "properties of its receiver");
  in.read("lbl", lbl, "transponders that $CCPDT, $CCPNT and $CCPGT ask");
  in.read("serial", serial, "pseudo-terminal or FIFO for programs that use no LCM");
  // The revision is sent in a sentence, where these characters separate fields or begin the checksum.
  const auto is_plain = [](char c) { return c > ' ' && c < 127 && c != ',' && c != '*' && c != '$'; };
  if (!in.describing() && (revision.empty() || !std::all_of(revision.begin(), revision.end(), is_plain)))
    in.error("revision",
             "'revision' is a field of a sentence and must have letters, digits and points, no ',', '*', "
             "'$' or space, got '" +
                 sim::shortened(sim::printable(revision)) + "'");
}

Micromodem::Micromodem(const Params& params, const sim::DeviceContext& context)
    : params_(params),
      world_(context.world),
      vehicle_(context.vehicle),
      epoch_us_(context.world.epoch_us()),
      addresses_(context.shared(addresses_of_world)),
      transducer_(*this, params.receiver, context.sound_site()),
      protocol_(protocol_config(params), *this),
      now_(context.world.now()) {
  check_beacons(context);
  if (params.serial) serial_ = std::make_unique<SerialPort>(*params.serial, context);
  take_address();  // last, because the destructor removes it
  warn_of_address();
}

Micromodem::~Micromodem() {
  unlist();
}

void Micromodem::check_beacons(const sim::DeviceContext& context) const {
  if (!params_.lbl) return;
  for (const std::string& name : params_.lbl->transponders) {
    const std::size_t slash = name.find('/');
    const sim::VehicleConfig* vehicle = named_vehicle(context.world, name.substr(0, slash));
    const auto is_meant = [&](const sim::DeviceConfig& device) {
      return device.type == "transponder" && (slash == std::string::npos || device.name == name.substr(slash + 1));
    };
    if (vehicle != nullptr && std::any_of(vehicle->devices.begin(), vehicle->devices.end(), is_meant)) continue;
    sim::throw_config_error(context.config.place,
                            "vehicle '" + context.vehicle.name() + "': device '" + context.config.name + "'",
                            "'transponders' names no transponder of the world '" + name + "'");
  }
}

/// Warns of two modems with one address: both answer, and the others cannot distinguish them.
void Micromodem::warn_of_address() const {
  const auto& names = addresses_.names[{params_.network, address_}];
  if (names.size() == 2 && names[0] != names[1])
    sim::log_warn("micromodems '{}' and '{}' have the same address {} in network '{}'", names[0], names[1], address_,
                  params_.network);
}

void Micromodem::list(int address) {
  unlist();
  address_ = address;
  addresses_.names[{params_.network, address_}].push_back(transducer_.full_name());
}

void Micromodem::unlist() {
  const auto names = addresses_.names.find({params_.network, address_});
  if (names == addresses_.names.end()) return;
  const auto own = std::find(names->second.begin(), names->second.end(), transducer_.full_name());
  if (own != names->second.end()) names->second.erase(own);
  if (names->second.empty()) addresses_.names.erase(names);
}

void Micromodem::take(const std::string& sentence, sim::Time now) {
  now_ = now;
  sim::NmeaLines lines;  // sentences over the bus are complete
  const std::string ended = sentence + "\n";
  for (const auto& line : lines.add(std::as_bytes(std::span(ended.data(), ended.size())))) take_line(line, now);
}

void Micromodem::take_line(const sim::NmeaLines::Line& line, sim::Time now) {
  protocol_.take_line(line, now);
  if (protocol_.address() == address_) return;
  take_address();
  warn_of_address();
}

void Micromodem::take_address() {
  list(protocol_.address());
  transducer_.set_address({group(), std::to_string(address_)});
}

void Micromodem::act(const sim::ActContext& context) {
  now_ = context.now;
  if (!transducer_.works()) {
    if (serial_) serial_->read();  // the modem is off
    off_ = true;
    return;
  }
  if (std::exchange(off_, false)) {
    lines_ = {};
    protocol_.restart(context.now);
  }
  protocol_.tick(context.now);
  if (!serial_) return;
  for (const auto& line : lines_.add(serial_->read())) take_line(line, context.now);
}

double Micromodem::power_W() const {
  return transducer_.busy_until() > now_ ? params_.transmit_power_W : 0;
}

void Micromodem::emit(const std::string& body) {
  std::string sentence = sim::nmea_sentence(body);
  if (serial_) serial_->write(sentence + "\r\n");
  if (saying_.size() >= max_sentences) saying_.pop_front();
  saying_.push_back({now_, vehicle_.clock().reading(now_), std::move(sentence)});
}

MicromodemSide::Sound Micromodem::send(sim::Signal signal, sim::Time at, bool on_the_second) {
  sim::Time begin = std::max({at, now_, transducer_.busy_until()});
  if (on_the_second) begin = next_whole(vehicle_, epoch_us_, begin, sim::from_seconds(1));
  const Sound sound{begin, begin + signal.duration};
  transducer_.transmit(std::move(signal), begin);
  return sound;
}

MicromodemSide::Sound Micromodem::transmit(const MicromodemPacket& packet, sim::Time at, bool on_the_second) {
  const auto& rate = micromodem_rates()[static_cast<std::size_t>(packet.is_short() ? 0 : packet.rate)];
  sim::Signal signal;
  signal.kind = sim::Signal::Kind::message;
  signal.source_level = sim::Decibels{params_.source_level_dB};
  signal.centre_Hz = params_.frequency_Hz;
  signal.bandwidth_Hz = rate.bandwidth_Hz;
  signal.modulation = rate.modulation;
  signal.bit_rate_bps = rate.bit_rate_bps;
  signal.coding_gain_dB = params_.coding_gain_dB;
  const auto frames = static_cast<int>(packet.frames.size());
  signal.bits = packet.is_short() ? micromodem_short_bits : 8 * std::int64_t{frames} * rate.frame_bytes;
  signal.duration = sim::from_seconds(packet.is_short() ? micromodem_short_s() : micromodem_packet_s(rate, frames));
  signal.network = params_.network;
  signal.code = packet.code();
  signal.payload = packet.payload();
  // A third modem that initiates a cycle addresses its source, which then sends the data.
  const int to = packet.kind == MicromodemPacket::Kind::cycle_init && packet.source != address_ ? packet.source
                                                                                                : packet.destination;
  signal.to = {group(), to == micromodem_broadcast ? "" : std::to_string(to)};
  return send(std::move(signal), at, on_the_second);
}

MicromodemSide::Sound Micromodem::interrogate_beacons(sim::Time at, bool on_the_second) {
  const MicromodemBeaconParams beacons = params_.lbl.value_or(MicromodemBeaconParams{});
  sim::Signal signal;
  signal.kind = sim::Signal::Kind::ping;
  signal.source_level = sim::Decibels{params_.source_level_dB};
  signal.centre_Hz = beacons.frequency_Hz;
  signal.bandwidth_Hz = beacons.bandwidth_Hz;
  signal.duration = sim::from_seconds(beacons.ping_s);
  signal.network = beacons.network;
  return send(std::move(signal), at, on_the_second);
}

sim::Time Micromodem::cancel_pending() {
  transducer_.cancel_pending();
  return transducer_.busy_until();
}

double Micromodem::elapsed_s(sim::Time from, sim::Time to) const {
  return sim::to_seconds(to - from) * (1 + vehicle_.clock().rate_error(world_.now()));
}

std::int64_t Micromodem::utc_us(sim::Time at) const {
  return epoch_us_ + vehicle_.clock().reading(at).count();
}

bool Micromodem::listens_to(const sim::Signal& signal) const {
  if (signal.kind == sim::Signal::Kind::message) return signal.network == params_.network;
  return signal.kind == sim::Signal::Kind::answer && params_.lbl && signal.network == params_.lbl->network &&
         (signal.code.empty() || signal.code == transducer_.full_name());
}

void Micromodem::receive(const sim::Reception& received) {
  now_ = std::max(now_, received.ended);
  if (received.signal.kind == sim::Signal::Kind::answer) return received_beacon(received);
  // Ignore receptions that were not detected.  Out of the water applies to the sender: this modem would not receive
  // there.
  const bool has_errors = received.loss == sim::SignalLoss::noise || received.loss == sim::SignalLoss::interference ||
                          received.loss == sim::SignalLoss::sender_off ||
                          received.loss == sim::SignalLoss::out_of_water;
  if (!received.understood() && !(received.detected && has_errors)) return;
  const auto packet = MicromodemPacket::read(received.signal.code, received.signal.payload);
  if (!packet) return;
  MicromodemArrival arrival;
  arrival.started = received.started, arrival.ended = received.ended;
  arrival.level_dB = received.level.dB();
  arrival.snr_dB = received.sinr.dB();
  arrival.noise_dB = (received.level - received.snr).dB();
  arrival.closing_mps = received.closing_mps;
  arrival.good = received.understood();
  protocol_.receive(*packet, arrival);
}

void Micromodem::received_beacon(const sim::Reception& received) {
  if (!received.understood()) return;
  for (std::size_t i = 0; i < params_.lbl->transponders.size(); ++i) {
    const std::string& name = params_.lbl->transponders[i];
    if (received.source == name || received.source.starts_with(name + "/"))
      return protocol_.beacon_answered(static_cast<int>(i), received.started);
  }
}

void Micromodem::measure(const sim::SenseContext&) {
  sentences_.assign(std::make_move_iterator(saying_.begin()), std::make_move_iterator(saying_.end()));
  saying_.clear();
}

void Micromodem::visit_state(sim::StateArchive& archive) {
  archive(protocol_, lines_, off_, now_, saying_, sentences_);
  if (archive.restoring()) list(protocol_.address());
}

void MicromodemReporter::report(sim::Time, sim::Publisher& out) const {
  for (const Micromodem::Sentence& sentences : modem_.sentences()) {
    shoal::nmea_sentence_t message{};
    message.utime = out.utime_elsewhere(sentences.at, sentences.reading);
    message.sentence = sentences.sentence;
    shoal::encode_into(message, out.buffer());
    out.publish(out.buffer());
  }
}

void MicromodemController::receive(sim::Time now, std::span<const std::byte> payload) {
  modem_.take(shoal::decode<shoal::nmea_sentence_t>(payload, shoal::Finite::required).sentence, now);
}

SHOAL_TRANSCEIVER("micromodem", Micromodem, MicromodemReporter, MicromodemController);

}  // namespace devices
