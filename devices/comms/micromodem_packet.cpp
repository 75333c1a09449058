// SPDX-License-Identifier: BSD-3-Clause
#include "devices/comms/micromodem_packet.hpp"

#include <sstream>

namespace devices {

namespace {

constexpr const char* packet_mark = "micromodem";

}  // namespace

int MicromodemPacket::data_bytes() const {
  std::size_t bytes = 0;
  for (const Frame& frame : frames) bytes += frame.data.size();
  return static_cast<int>(bytes);
}

std::string MicromodemPacket::code() const {
  std::ostringstream text;
  text << packet_mark << ' ' << static_cast<int>(kind) << ' ' << source << ' ' << destination << ' ' << rate << ' '
       << ack << ' ' << frame_count << ' ' << value << ' ' << frames.size();
  for (const Frame& frame : frames) text << ' ' << frame.ack << ' ' << frame.data.size();
  return text.str();
}

sim::Bytes MicromodemPacket::payload() const {
  sim::Bytes bytes;
  for (const Frame& frame : frames) bytes.insert(bytes.end(), frame.data.begin(), frame.data.end());
  return bytes;
}

std::optional<MicromodemPacket> MicromodemPacket::read(const std::string& code, const sim::Bytes& payload) {
  // Header of the code.
  std::istringstream text(code);
  std::string word;
  int kind = 0;
  std::size_t frames = 0;
  MicromodemPacket packet;
  text >> word >> kind >> packet.source >> packet.destination >> packet.rate >> packet.ack >> packet.frame_count >>
      packet.value >> frames;
  if (!text || word != packet_mark || kind < 0 || kind > static_cast<int>(Kind::mini)) return {};
  packet.kind = static_cast<Kind>(kind);
  // Frames, whose bytes follow each other in the payload.
  std::size_t at = 0;
  for (std::size_t i = 0; i < frames; ++i) {
    Frame frame;
    std::size_t size = 0;
    text >> frame.ack >> size;
    if (!text || size > payload.size() - at) return {};
    const auto begin = payload.begin() + static_cast<std::ptrdiff_t>(at);
    frame.data.assign(begin, begin + static_cast<std::ptrdiff_t>(size));
    at += size;
    packet.frames.push_back(std::move(frame));
  }
  return packet;
}

}  // namespace devices
