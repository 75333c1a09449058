// SPDX-License-Identifier: BSD-3-Clause
#include "devices/comms/acoustic_modem.hpp"

#include <algorithm>
#include <charconv>
#include <stdexcept>

#include "devices/comms/micromodem_rates.hpp"
#include "devices/comms/modem.hpp"
#include "shoal/acoustic_received_t.hpp"
#include "shoal/message_codec.hpp"
#include "shoal/modem_send_t.hpp"
#include "sim/config/message_text.hpp"
#include "sim/config/presets.hpp"
#include "sim/world/world.hpp"

namespace devices {

const sim::Presets& acoustic_modem_presets();  // acoustic_modem_presets.yaml

namespace {

std::string preset_of(const MicromodemRate& rate) {
  return "micromodem_rate" + std::to_string(rate.number);
}

/// Sets the values of a preset that is a packet type of the Micro-Modem.
void use_packet_type(AcousticModem::Params& params) {
  for (const MicromodemRate& rate : micromodem_rates()) {
    if (params.preset != preset_of(rate)) continue;
    params.modulation = rate.modulation;
    params.bandwidth_Hz = rate.bandwidth_Hz;
    params.bit_rate_bps = rate.bit_rate_bps;
    params.frames = rate.frames;
    params.frame_bytes = rate.frame_bytes;
    params.preamble_s = micromodem_probe_s;
  }
}

constexpr std::string_view message_mark = "msg ";

/// Returns the group of modems that can decode each other.
std::string group_of(const AcousticModem::Params& params) {
  return "acoustic_modem " + params.network;
}

/// Header of the frame in Signal::code: the sending time by the clock of the sender, and the destination.
std::string code_of(sim::Time sent, const std::string& destination) {
  return std::string(message_mark) + std::to_string(sent.count()) + " " + destination;
}

/// Decodes a header; returns false for a frame of another type of modem.
bool read_code(std::string_view code, sim::Time& sent, std::string& destination) {
  if (!code.starts_with(message_mark)) return false;
  code.remove_prefix(message_mark.size());
  const std::size_t space = code.find(' ');
  std::int64_t sent_us = 0;
  if (space == std::string_view::npos ||
      std::from_chars(code.data(), code.data() + space, sent_us).ptr != code.data() + space)
    return false;
  sent = sim::Time{sent_us};
  destination = code.substr(space + 1);
  return true;
}

}  // namespace

void AcousticModem::Params::read(sim::ParamReader& in) {
  // Preset.
  std::vector<std::string> packet_types;
  for (const MicromodemRate& rate : micromodem_rates()) packet_types.push_back(preset_of(rate));
  acoustic_modem_presets().read(in, *this, std::move(packet_types),
                                "preset of a packet type or modem; the keys below override it");
  if (!in.describing()) use_packet_type(*this);
  // Signal.
  in.read("network", network, "only modems of the same network understand each other; others act as noise");
  in.read("source_level_dB", source_level_dB, sim::between(0, 300), "re 1 uPa at 1 m, on its axis");
  in.read("frequency_Hz", frequency_Hz, sim::between(100, 1e6), "middle of its band");
  in.read("bandwidth_Hz", bandwidth_Hz, sim::between(1, 1e6), "bandwidth");
  in.read_choice("modulation", modulation,
                 {{"fsk", sim::Modulation::fsk}, {"psk", sim::Modulation::psk}, {"dpsk", sim::Modulation::dpsk}},
                 "frequency shift keying, non-coherent; phase shift keying, coherent; differential phase shift keying");
  in.read("bit_rate_bps", bit_rate_bps, sim::between(1e-3, 1e9), "bits per second while it sends");
  in.read("coding_gain_dB", coding_gain_dB, sim::between(0, 60), "coding gain on Eb/N0");
  // Packets.
  in.read("frame_bytes", frame_bytes, sim::between(1, 1 << 16), "bytes of a frame");
  in.read("frames", frames, sim::between(1, 256), "maximum number of frames of a packet");
  in.read("whole_frames", whole_frames, "a packet always takes the time of full frames, also with fewer bytes");
  in.read_or_word("max_message_bytes", max_message_bytes, sim::between(1, 1 << 20), {"all_frames"},
                  "longer messages are refused; all_frames: frames x frame_bytes");
  in.read("preamble_s", preamble_s, sim::between(0, 100), "preamble of each packet, before its bits");
  in.read("header_bits", header_bits, sim::between(0, 1 << 16),
          "header bits of each packet, beside those of the message");
  in.read("queue_messages", queue_messages, sim::at_least(1), "messages waiting to be sent; the oldest is dropped");
  in.read_or_word("synchronous_s", synchronous_s, sim::between(1e-3, 3600), {"at_once"},
                  "sending begins at a whole multiple of this (in UTC) by the vehicle's clock");
  in.read("listen_before_sending", listen_before_sending, "it does not transmit while it is receiving a signal");
  in.read("promiscuous", promiscuous, "also reports messages addressed to others");
  in.read("transmit_power_W", transmit_power_W, sim::at_least(0), "power drawn from the battery while it transmits");
  in.read("receiver", receiver, "properties of its receiver");
  in.read("serial", serial, "pseudo-terminal or FIFO for programs that use no LCM");
  if (in.describing()) return;
  // Check combinations of keys.
  if (bandwidth_Hz >= 2 * frequency_Hz)
    in.error("bandwidth_Hz", "'bandwidth_Hz' must be < 2 x frequency_Hz, got " + sim::number_text(bandwidth_Hz));
  if (max_message_bytes > frames * frame_bytes)
    in.error("max_message_bytes", "'max_message_bytes' must be <= frames x frame_bytes, that is " +
                                      std::to_string(frames * frame_bytes) + ", got " +
                                      std::to_string(max_message_bytes));
}

AcousticModem::AcousticModem(const Params& params, const sim::DeviceContext& context)
    : params_(params),
      world_(context.world),
      host_(context.host),
      vehicle_(context.vehicle),
      transducer_(*this, params.receiver, context.sound_site()),
      wake_flag_(context.wake_flag()) {
  if (params.serial) serial_ = std::make_unique<SerialMessages>(*params.serial, context);
  transducer_.set_address({group_of(params), vehicle_.name()});
  host_.shared.of(message_modems).join(transducer_.full_name(), *this);
}

AcousticModem::~AcousticModem() {
  host_.shared.of(message_modems).leave(transducer_.full_name());
}

void AcousticModem::change(const Params& params) {
  params_ = params;
  transducer_.change(params.receiver);
}

std::size_t AcousticModem::message_limit_bytes() const {
  const int bytes = params_.max_message_bytes > 0 ? params_.max_message_bytes : params_.frames * params_.frame_bytes;
  return static_cast<std::size_t>(bytes);
}

std::int64_t AcousticModem::bits(std::size_t bytes) const {
  std::int64_t sent_bytes = static_cast<std::int64_t>(bytes);
  if (params_.whole_frames)
    sent_bytes = (sent_bytes + params_.frame_bytes - 1) / params_.frame_bytes * params_.frame_bytes;
  return params_.header_bits + 8 * sent_bytes;
}

double AcousticModem::duration_s(std::size_t bytes) const {
  return params_.preamble_s + sim::packet_duration_s(bits(bytes), params_.bit_rate_bps);
}

void AcousticModem::send(sim::Time, std::string destination, sim::Bytes data) {
  if (data.empty()) throw std::runtime_error("a message must have at least 1 byte");
  if (data.size() > message_limit_bytes())
    throw std::runtime_error("a message must have at most " + std::to_string(message_limit_bytes()) + " bytes, got " +
                             std::to_string(data.size()));
  if (!destination.empty() && world_.find_vehicle(destination) == nullptr)
    throw std::runtime_error("'destination' names no vehicle: '" + sim::shortened(sim::printable(destination)) + "'");
  if (destination == vehicle_.name()) throw std::runtime_error("'destination' is the sending vehicle itself");
  if (queue_.size() >= static_cast<std::size_t>(params_.queue_messages)) {
    queue_.pop_front();
    ++dropped_;
  }
  queue_.push_back({std::move(destination), std::move(data)});
  wake_flag_->store(true, std::memory_order_relaxed);  // for other callers than its controller
}

void AcousticModem::act(const sim::ActContext& context) {
  if (serial_) read_serial(context.now);
  // Several short messages may be sent in a step, each when the previous one has ended.
  const sim::Time end = context.now + sim::from_seconds(context.step_s);
  while (!queue_.empty() && transducer_.works()) {
    sim::Time start = std::max(context.now, transducer_.busy_until());
    if (params_.synchronous_s > 0)
      start = next_whole(vehicle_, world_.epoch_us(), start, sim::from_seconds(params_.synchronous_s));
    if (start >= end || (params_.listen_before_sending && transducer_.receiving())) return;
    Outgoing message = std::move(queue_.front());
    queue_.pop_front();
    transmit(start, std::move(message));
  }
}

double AcousticModem::power_W() const {
  return transducer_.busy_until() > world_.now() ? params_.transmit_power_W : 0;
}

/// A modem is not idle while it transmits, because of the power that this takes.
bool AcousticModem::idle() const {
  return queue_.empty() && arrived_.empty() && received_.empty() && !serial_ &&
         transducer_.busy_until() <= world_.now();
}

void AcousticModem::transmit(sim::Time at, Outgoing message) {
  sim::Signal signal;
  signal.kind = sim::Signal::Kind::message;
  signal.source_level = sim::Decibels{params_.source_level_dB};
  signal.centre_Hz = params_.frequency_Hz;
  signal.bandwidth_Hz = params_.bandwidth_Hz;
  signal.duration = std::max(sim::from_seconds(duration_s(message.data.size())), sim::Time{1});
  signal.modulation = params_.modulation;
  signal.bit_rate_bps = params_.bit_rate_bps;
  signal.bits = bits(message.data.size());
  signal.coding_gain_dB = params_.coding_gain_dB;
  signal.network = params_.network;
  signal.code = code_of(vehicle_.clock().reading(at), message.destination);
  signal.payload = std::move(message.data);
  signal.to = {group_of(params_), message.destination};
  transducer_.transmit(std::move(signal), at);
}

bool AcousticModem::listens_to(const sim::Signal& signal) const {
  return signal.kind == sim::Signal::Kind::message && signal.network == params_.network;
}

void AcousticModem::receive(const sim::Reception& reception) {
  if (!reception.understood()) return;
  Packet packet;
  if (!read_code(reception.signal.code, packet.sent_reading, packet.destination)) return;
  packet.source = reception.source.substr(0, reception.source.find('/'));
  if (!packet.destination.empty() && packet.destination != vehicle_.name() && !params_.promiscuous) return;
  packet.sent = reception.sent;
  packet.arrived = reception.started;
  // Both times are read by the clocks of their vehicles: the travel time of a one-way range has the errors of both.
  packet.arrived_reading = vehicle_.clock().reading(reception.started);
  packet.snr_dB = reception.sinr.dB();
  packet.level_dB = reception.level.dB();
  packet.closing_mps = reception.closing_mps;
  packet.data = reception.signal.payload;
  if (serial_) serial_->write(packet.data);
  report_to_tap(reception.ended, packet.source, packet.data);
  arrived_.push_back(std::move(packet));
  wake_flag_->store(true, std::memory_order_relaxed);
}

void AcousticModem::measure(const sim::SenseContext&) {
  received_.clear();
  std::swap(received_, arrived_);
}

void AcousticModem::visit_state(sim::StateArchive& archive) {
  archive(queue_, arrived_, received_);
  archive.unhashed(dropped_);
  if (serial_) archive(*serial_);
}

void AcousticModem::read_serial(sim::Time now) {
  for (sim::Bytes& data : serial_->take(message_limit_bytes()))
    if (data.size() > message_limit_bytes())
      warn_of_length(host_.warnings, transducer_.full_name(), message_limit_bytes());
    else
      send(now, "", std::move(data));
}

void AcousticModemReporter::report(sim::Time, sim::Publisher& out) const {
  for (const AcousticModem::Packet& packet : modem_.received()) {
    shoal::acoustic_received_t message{};
    message.utime = out.utime_elsewhere(packet.arrived, packet.arrived_reading);
    message.sent_utime = out.utime_elsewhere(packet.sent, packet.sent_reading);
    // From the stamps, as a real modem computes it, and not the true travel time.
    message.travel_time_s = static_cast<double>(message.utime - message.sent_utime) * 1e-6;
    message.source = packet.source;
    message.destination = packet.destination;
    message.snr_db = packet.snr_dB;
    message.level_db = packet.level_dB;
    message.doppler_mps = packet.closing_mps;
    message.size = static_cast<std::int32_t>(packet.data.size());
    const auto* data = reinterpret_cast<const std::uint8_t*>(packet.data.data());
    message.data.assign(data, data + packet.data.size());
    shoal::encode_into(message, out.buffer());
    out.publish(out.buffer());
  }
}

void AcousticModemController::receive(sim::Time now, std::span<const std::byte> payload) {
  const auto command = shoal::decode<shoal::modem_send_t>(payload, shoal::Finite::required);
  const auto* data = reinterpret_cast<const std::byte*>(command.data.data());
  modem_.send(now, command.destination, sim::Bytes(data, data + command.data.size()));
}

SHOAL_TRANSCEIVER("acoustic_modem", AcousticModem, AcousticModemReporter, AcousticModemController);

}  // namespace devices
