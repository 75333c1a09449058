// SPDX-License-Identifier: BSD-3-Clause
#include "bridges/signing/signed_message.hpp"

#include <algorithm>
#include <array>
#include <chrono>
#include <cstring>
#include <random>

#include "shoal/message_codec.hpp"
#include "shoal/sim_signed_t.hpp"

namespace bridges {

namespace {

constexpr std::size_t max_sender_length = 60;

}  // namespace

bool is_control_channel(std::string_view channel) {
  static constexpr std::array<std::string_view, 4> names{"sim.ack", "sim.control", "sim.resend", "sim.resent"};
  return std::find(names.begin(), names.end(), channel) != names.end();
}

bool is_signed(std::span<const std::byte> payload) {
  return payload.size() >= 8 && shoal::fingerprint(payload) == shoal::fingerprint_of<shoal::sim_signed_t>();
}

SignedMessage read_signed(std::span<const std::byte> payload) {
  const auto message = shoal::decode<shoal::sim_signed_t>(payload, shoal::Finite::any);
  if (message.sender.empty() || message.sender.size() > max_sender_length)
    throw shoal::MessageError("a signed message names a sender of 1 to 60 characters, got " +
                              std::to_string(message.sender.size()));
  SignedMessage read;
  read.session = message.session;
  read.sender = message.sender;
  read.counter = message.counter;
  const auto* data = reinterpret_cast<const std::byte*>(message.content.data());
  read.content.assign(data, data + message.content.size());
  std::copy(std::begin(message.mac), std::end(message.mac), read.mac.begin());
  return read;
}

sim::Bytes content_of(std::span<const std::byte> payload) {
  if (is_signed(payload)) return read_signed(payload).content;
  return {payload.begin(), payload.end()};
}

bool has_mac_of(const RunKey& key, std::string_view channel, std::span<const std::byte> payload) {
  Mac mac{};
  if (payload.size() < mac.size()) return false;
  const auto before = payload.first(payload.size() - mac.size());
  std::memcpy(mac.data(), payload.data() + before.size(), mac.size());
  return equal_in_constant_time(mac, key.mac(channel, before));
}

MessageSigner::MessageSigner(const RunKey& key, std::string_view sender)
    : key_(key), sender_(sender.substr(0, max_sender_length)) {
  if (sender_.empty()) sender_ = "?";
  std::random_device device;
  session_ = static_cast<std::int64_t>((std::uint64_t{device()} << 31 ^ device()) & 0x7fffffffffffffff);
  // A later start has a higher initial counter, so that the simulator may discard its oldest sessions.
  const auto now = std::chrono::system_clock::now().time_since_epoch();
  counter_ = std::chrono::duration_cast<std::chrono::microseconds>(now).count();
}

sim::Bytes MessageSigner::sign(std::string_view channel, std::span<const std::byte> content) {
  shoal::sim_signed_t message{};
  message.session = session_;
  message.sender = sender_;
  message.counter = ++counter_;
  message.size = static_cast<std::int32_t>(content.size());
  const auto* data = reinterpret_cast<const std::uint8_t*>(content.data());
  message.content.assign(data, data + content.size());
  sim::Bytes payload = shoal::encode(message);
  // The MAC is the last field: all bytes before it are covered, counter and session included.
  const std::size_t before = payload.size() - Mac{}.size();
  const Mac mac = key_.mac(channel, std::span(payload).first(before));
  std::memcpy(payload.data() + before, mac.data(), mac.size());
  return payload;
}

}  // namespace bridges
