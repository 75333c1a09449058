// SPDX-License-Identifier: BSD-3-Clause
#include "devices/comms/micromodem_protocol.hpp"

#include <spdlog/fmt/fmt.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <initializer_list>

namespace devices {

namespace {

using Kind = MicromodemPacket::Kind;

/// Pause between the cycle init and the data of rate 0, and before an acknowledgement, s.
constexpr double gap_s = 0.1;
constexpr double revision_period_s = 10;

std::string padded(int value, int digits) {
  char text[16];
  std::snprintf(text, sizeof text, "%0*d", digits, value);
  return text;
}

int rounded(double value, int min, int max) {
  return static_cast<int>(std::lround(std::clamp<double>(value, min, max)));
}

/// Returns the number of the packet type in $CACST and $CAXST, as used by Goby and others.
int packet_type(const MicromodemPacket& packet) {
  if (packet.kind == Kind::data) return packet.rate == 0 ? 1 : 3;
  return packet.kind == Kind::cycle_init ? 1 : 2;
}

}  // namespace

std::string nmea_time_of_day(std::int64_t utc_us, int digits) {
  constexpr std::int64_t day_us = 86'400'000'000;
  std::int64_t of_day_us = utc_us % day_us;
  if (of_day_us < 0) of_day_us += day_us;
  const auto seconds = static_cast<int>(of_day_us / 1'000'000);
  std::string text = padded(seconds / 3600, 2) + padded(seconds / 60 % 60, 2) + padded(seconds % 60, 2);
  if (digits > 0)
    text += "." + padded(static_cast<int>(of_day_us % 1'000'000), 6).substr(0, static_cast<std::size_t>(digits));
  return text;
}

std::string nmea_date(std::int64_t utc_us) {
  const std::chrono::sys_time<std::chrono::microseconds> time{std::chrono::microseconds(utc_us)};
  const std::chrono::year_month_day date{std::chrono::floor<std::chrono::days>(time)};
  return padded(static_cast<int>(date.year()), 4) + padded(static_cast<int>(static_cast<unsigned>(date.month())), 2) +
         padded(static_cast<int>(static_cast<unsigned>(date.day())), 2);
}

MicromodemProtocol::MicromodemProtocol(const Config& config, MicromodemSide& side)
    : config_(config), generation_(micromodem_generation(config.revision)), side_(side) {
  settings_.set("SRC", config.address);
  settings_.set("SNV", config.synchronous ? 1 : 0);
  settings_.set("TAT", rounded(config.beacon_turnaround_s * 1e3, 0, 10000));
  clock_set_ = config.synchronous;
}

std::string MicromodemProtocol::time_of_day(sim::Time at, int digits) const {
  return nmea_time_of_day(utc_us(at), digits);
}

void MicromodemProtocol::emit_later(sim::Time at, std::string body) {
  const auto after =
      std::upper_bound(due_.begin(), due_.end(), at, [](sim::Time t, const Due& due) { return t < due.at; });
  due_.insert(after, {at, std::move(body)});
}

void MicromodemProtocol::error(const std::string& module, int number, const std::string& text, sim::Time now) {
  ++errors_;
  side_.emit("CAERR," + time_of_day(now) + "," + module + "," + std::to_string(number) + "," + text);
}

bool MicromodemProtocol::busy(const char* module, sim::Time now) {
  if (!cycle_ && !ping_ && !beacon_ping_ && now >= sending_until_) return false;
  error(module, 4, "busy", now);
  return true;
}

void MicromodemProtocol::restart(sim::Time up) {
  due_.clear();
  sending_until_ = side_.cancel_pending();
  cycle_.reset(), expected_.reset(), ping_.reset(), beacon_ping_.reset();
  clock_offset_us_ = 0, clock_set_ = config_.synchronous;
  pulse_time_.reset();
  next_revision_ = up;
  starting_ = true;
}

void MicromodemProtocol::tick(sim::Time now) {
  detect_pulse(now);
  // Send due sentences and the revision to the host.
  while (!due_.empty() && due_.front().at <= now) {
    const std::string body = std::move(due_.front().body);
    due_.erase(due_.begin());
    side_.emit(body);
  }
  if (now >= next_revision_) {
    const char* event = starting_ ? "INIT" : "AUV";
    if (starting_ || settings_.on("REV"))
      side_.emit("CAREV," + time_of_day(now) + "," + event + "," + config_.revision);
    next_revision_ = now + sim::from_seconds(revision_period_s);
    starting_ = false;
  }
  // Handle time-outs of the host, of packets and of pings.
  if (cycle_ && now >= cycle_->deadline) {
    ++errors_;
    side_.emit("CAERR," + time_of_day(now) + ",DATA_TIMEOUT," + std::to_string(cycle_->gathered.size() + 1));
    if (cycle_->gathered.empty())
      cycle_.reset();
    else
      send_cycle(now);
  }
  if (expected_ && now >= expected_->deadline) {
    side_.emit("CAMSG,PACKET_TIMEOUT," + std::to_string(expected_->rate));
    expected_.reset();
  }
  if (ping_ && now >= ping_->deadline) {
    side_.emit("CAMPR," + std::to_string(ping_->destination) + "," + std::to_string(address()));
    ping_.reset();
  }
  if (beacon_ping_ && now >= beacon_ping_->deadline) report_beacons(now);
}

MicromodemSide::Sound MicromodemProtocol::send(const MicromodemPacket& packet, sim::Time at, bool on_the_second) {
  // Transmit after the previous packet.
  const auto sound = side_.transmit(packet, std::max(at, sending_until_), on_the_second);
  sending_until_ = std::max(sending_until_, sound.end);
  const auto& rate = micromodem_rates()[static_cast<std::size_t>(packet.is_short() ? 0 : packet.rate)];
  const int bytes = packet.kind == Kind::data ? packet.data_bytes() : 2;
  const auto frames = packet.frames.size();
  // Report start and end of the transmission to the host.
  if (settings_.on("TXP")) emit_later(sound.begin, "CATXP," + std::to_string(bytes));
  if (settings_.on("TXF")) emit_later(sound.end, "CATXF," + std::to_string(bytes));
  if (!settings_.on("XST")) return sound;
  std::string body = "CAXST," + nmea_date(utc_us(sound.begin)) + "," + time_of_day(sound.begin, 4) + "," +
                     std::to_string(clock_mode()) + ",0,200";
  for (const int field :
       {rounded(rate.bandwidth_Hz, 0, 1000000), rounded(config_.frequency_Hz, 0, 10000000),
        packet.is_short() ? 0 : packet.rate, packet.source, packet.destination, static_cast<int>(packet.ack),
        packet.frame_count, static_cast<int>(frames), packet_type(packet), bytes})
    body += "," + std::to_string(field);
  emit_later(sound.end, std::move(body));
  return sound;
}

void MicromodemProtocol::gather(Cycle cycle, sim::Time now) {
  cycle_ = std::move(cycle);
  request_frame(now);
}

void MicromodemProtocol::request_frame(sim::Time now) {
  const int room = micromodem_rates()[static_cast<std::size_t>(cycle_->rate)].frame_bytes;
  std::string body = "CADRQ," + time_of_day(now);
  for (const int field : {cycle_->source, cycle_->destination, static_cast<int>(cycle_->ack), room,
                          static_cast<int>(cycle_->gathered.size()) + 1})
    body += "," + std::to_string(field);
  side_.emit(body);
  cycle_->deadline = now + sim::from_seconds(settings_.get("DTO"));
}

void MicromodemProtocol::send_cycle(sim::Time now) {
  MicromodemPacket packet;
  packet.kind = Kind::data;
  packet.source = cycle_->source, packet.destination = cycle_->destination, packet.rate = cycle_->rate;
  packet.ack = cycle_->ack;
  packet.frames = std::move(cycle_->gathered);
  packet.frame_count = static_cast<int>(packet.frames.size());
  const bool announced = cycle_->announced;
  cycle_.reset();
  sim::Time at = now;
  // Announce data of rate 0.
  if (packet.rate == 0 && !announced) {
    MicromodemPacket init = packet;
    init.kind = Kind::cycle_init;
    init.frames.clear();
    at = send(init, at, settings_.on("SNV")).end + sim::from_seconds(gap_s);
  }
  send(packet, at, settings_.on("SNV"));
}

void MicromodemProtocol::receive(const MicromodemPacket& packet, const MicromodemArrival& arrival) {
  if (is_down(arrival.ended)) return;
  if (!arrival.good && packet.is_short()) {
    // The kind of a packet that was not decoded is unknown.
    side_.emit("CAMSG,BAD_CRC,0");
    return;
  }
  switch (packet.kind) {
    case Kind::cycle_init:
      return received_cycle(packet, arrival);
    case Kind::data:
      return received_data(packet, arrival);
    case Kind::ping:
      return received_ping(packet, arrival);
    case Kind::ping_reply:
      return received_reply(packet, arrival);
    case Kind::ack:
      for (int i = 0; i < 8; ++i)
        if ((packet.value >> i & 1) != 0)
          side_.emit("CAACK," + std::to_string(packet.source) + "," + std::to_string(packet.destination) + "," +
                     std::to_string(i + 1) + ",1");
      return emit_statistics(packet, arrival, 0);
    case Kind::mini: {
      char hex[8];
      std::snprintf(hex, sizeof hex, "%04x", static_cast<unsigned>(packet.value));
      side_.emit("CAMUA," + std::to_string(packet.source) + "," + std::to_string(packet.destination) + "," + hex);
      return emit_statistics(packet, arrival, 0);
    }
  }
}

void MicromodemProtocol::received_cycle(const MicromodemPacket& packet, const MicromodemArrival& arrival) {
  std::string body = "CACYC,0";
  for (const int field :
       {packet.source, packet.destination, packet.rate, static_cast<int>(packet.ack), packet.frame_count})
    body += "," + std::to_string(field);
  side_.emit(body);
  if (packet.kind == Kind::data) return;
  emit_statistics(packet, arrival, 0);
  // The cycle asks this modem to send: it gathers the data from its host first.
  if (packet.source == address()) {
    if (cycle_ || arrival.ended < sending_until_) return;
    return gather({packet.source, packet.destination, packet.rate, packet.frame_count, packet.ack, true, {}, {}},
                  arrival.ended);
  }
  expected_ = Expected{packet.source, packet.destination, packet.rate, packet.frame_count,
                       arrival.ended + sim::from_seconds(settings_.get("PTO"))};
}

void MicromodemProtocol::received_data(const MicromodemPacket& packet, const MicromodemArrival& arrival) {
  // Match the packet with its cycle init.
  const bool announced = expected_ && expected_->source == packet.source && expected_->rate == packet.rate;
  if (packet.rate == 0 && !announced) return;  // without its cycle init its meaning is unknown
  if (packet.rate > 0 && !config_.psk) return;
  if (!announced) received_cycle(packet, arrival);
  expected_.reset();
  if (settings_.on("RXP")) side_.emit(packet.rate == 0 ? "CARXP,0" : "CARXP,1");
  // Report the frames to the host.
  int bad_frames = 0, acknowledged = 0;
  for (std::size_t i = 0; i < packet.frames.size(); ++i) {
    const auto& frame = packet.frames[i];
    if (!arrival.good) {
      ++bad_frames;
      side_.emit("CAMSG,BAD_CRC," + std::to_string(packet.rate));
      continue;
    }
    if (frame.ack) acknowledged |= 1 << i;
    if (settings_.on("RXD"))
      side_.emit("CARXD," + std::to_string(packet.source) + "," + std::to_string(packet.destination) + "," +
                 std::to_string(static_cast<int>(frame.ack)) + "," + std::to_string(i + 1) + "," +
                 sim::to_hex(frame.data));
  }
  emit_statistics(packet, arrival, bad_frames);
  // Acknowledge the frames that request it.
  if (acknowledged == 0 || packet.destination != address()) return;
  MicromodemPacket ack;
  ack.kind = Kind::ack;
  ack.source = address(), ack.destination = packet.source, ack.value = acknowledged;
  send(ack, arrival.ended + sim::from_seconds(gap_s), false);
}

void MicromodemProtocol::received_ping(const MicromodemPacket& packet, const MicromodemArrival& arrival) {
  side_.emit("CAMPA," + std::to_string(packet.source) + "," + std::to_string(packet.destination));
  emit_statistics(packet, arrival, 0);
  if (packet.destination != address()) return;
  const sim::Time at = std::max(arrival.started + sim::from_seconds(micromodem_turnaround_s), arrival.ended);
  if (at < sending_until_) return;  // another transmission is in progress, and the time would be wrong
  MicromodemPacket reply;
  reply.kind = Kind::ping_reply;
  reply.source = address(), reply.destination = packet.source;
  send(reply, at, false);
}

void MicromodemProtocol::received_reply(const MicromodemPacket& packet, const MicromodemArrival& arrival) {
  const std::string who = "CAMPR," + std::to_string(packet.source) + "," + std::to_string(packet.destination);
  if (packet.destination != address() || !ping_ || ping_->destination != packet.source) {
    // The time of a ping sent by another modem is unknown.
    side_.emit(who);
    return emit_statistics(packet, arrival, 0);
  }
  const double one_way_s = (side_.elapsed_s(ping_->sent, arrival.started) - micromodem_turnaround_s) / 2;
  ping_.reset();
  side_.emit(fmt::format("{},{:.4f}", who, one_way_s));
  emit_statistics(packet, arrival, 0);
}

void MicromodemProtocol::beacon_answered(int beacon, sim::Time started) {
  if (!beacon_ping_ || beacon < 0 || beacon >= micromodem_beacons) return;
  auto& answered = beacon_ping_->answered[static_cast<std::size_t>(beacon)];
  if (!answered && started <= beacon_ping_->deadline) answered = started;
}

void MicromodemProtocol::report_beacons(sim::Time now) {
  std::string body = "SNTTA";
  for (std::size_t i = 0; i < micromodem_beacons; ++i) {
    body += ",";
    if (!beacon_ping_->is_requested[i] || !beacon_ping_->answered[i]) continue;
    const double both_s = side_.elapsed_s(beacon_ping_->sent, *beacon_ping_->answered[i]);
    // The travel time of one way, as the modem reports it; the turnaround is the user's setting and may be wrong.
    body += fmt::format("{:.4f}", (both_s - beacon_ping_->turnaround_s) / 2);
  }
  side_.emit(body + "," + time_of_day(beacon_ping_->sent, 2));
  beacon_ping_.reset();
  (void)now;
}

void MicromodemProtocol::emit_statistics(const MicromodemPacket& packet, const MicromodemArrival& arrival,
                                         int bad_frames) {
  if (!settings_.on("CST")) return;
  const auto& rate = micromodem_rates()[static_cast<std::size_t>(packet.is_short() ? 0 : packet.rate)];
  const int snr = rounded(arrival.snr_dB, -99, 99);
  const int peak = rounded(100 * std::pow(10, arrival.snr_dB / 20), 0, 32767);
  const int level = rounded(arrival.level_dB, 0, 999);
  const bool psk = packet_type(packet) == 3;
  const int frames = packet.kind == Kind::data ? static_cast<int>(packet.frames.size()) : 1;
  // mode (0: good; 1: bad), time of arrival, clock mode, matched filter, level, five gains, then the packet.
  std::string body = "CACST," + std::to_string(bad_frames > 0 ? 1 : 0) + "," + time_of_day(arrival.started, 4) + "," +
                     std::to_string(clock_mode());
  for (const int field : {peak,
                          30,
                          rounded(peak / 30.0, 0, 9999),
                          level,
                          250,
                          0,
                          0,
                          0,
                          0,
                          packet.is_short() ? 0 : packet.rate,
                          packet.source,
                          packet.destination,
                          psk && bad_frames > 0 ? 1 : 0,
                          packet_type(packet),
                          frames,
                          bad_frames,
                          level,
                          snr,
                          psk ? snr : 0,
                          psk ? snr : 0,
                          psk ? -snr : 0,
                          psk ? 0 : rounded(4 * arrival.snr_dB + 100, 0, 255)})
    body += "," + std::to_string(field);
  body += fmt::format(",{:.1f},", arrival.closing_mps) + std::to_string(rounded(arrival.noise_dB, 0, 999)) + "," +
          std::to_string(rounded(config_.frequency_Hz, 0, 10000000)) + "," +
          std::to_string(rounded(rate.bandwidth_Hz, 0, 1000000));
  side_.emit(body);
}

void MicromodemProtocol::visit_state(sim::StateArchive& archive) {
  archive(settings_, clock_offset_us_, clock_set_, pulse_time_, due_, sending_until_, next_revision_, starting_);
  // Limits for valid dates: three centuries.
  constexpr std::int64_t max_us = 10'000'000'000'000'000;
  archive.require(clock_offset_us_, -max_us, max_us, "an offset of a modem's clock");
  if (pulse_time_) {
    archive.require(pulse_time_->second, -max_us, max_us, "a time of a modem's pulse");
    archive.require(pulse_time_->set_us, -max_us, max_us, "a time of a modem's pulse");
  }
  archive(cycle_, expected_, ping_, beacon_ping_);
  archive.unhashed(errors_);
}

void MicromodemPending::Cycle::visit_state(sim::StateArchive& archive) {
  archive(source, destination, rate, frames, ack, announced, gathered, deadline);
  const bool known = rate >= 0 && static_cast<std::size_t>(rate) < micromodem_rates().size();
  if (archive.restoring() && !known) archive.fail("unknown rate " + std::to_string(rate));
}

}  // namespace devices
