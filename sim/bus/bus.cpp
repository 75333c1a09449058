// SPDX-License-Identifier: BSD-3-Clause
#include "sim/bus/bus.hpp"

#include <cassert>
#include <utility>

namespace sim {
namespace {

/// Channel of a bus that looks names up in each publication.
class NamedChannel final : public OpenChannel {
 public:
  NamedChannel(Bus& bus, std::string name) : bus_(bus), name_(std::move(name)) {}
  void publish(std::span<const std::byte> payload, Time at) override { bus_.publish(name_, payload, at); }

 private:
  Bus& bus_;
  const std::string name_;
};

}  // namespace

std::unique_ptr<OpenChannel> Bus::open_channel(const std::string& channel) {
  return std::make_unique<NamedChannel>(*this, channel);
}

namespace {

constexpr std::size_t begin = 8, size = 8;

}  // namespace

std::optional<std::int64_t> utime_of(std::span<const std::byte> payload) {
  if (payload.size() < begin + size) return std::nullopt;
  std::uint64_t utime = 0;
  for (std::size_t i = 0; i < size; ++i) utime = utime << 8 | std::to_integer<std::uint64_t>(payload[begin + i]);
  return static_cast<std::int64_t>(utime);
}

void set_utime(Bytes& payload, std::int64_t utime) {
  assert(payload.size() >= begin + size);
  for (std::size_t i = 0; i < size; ++i) payload[begin + i] = static_cast<std::byte>(utime >> (56 - 8 * i) & 0xff);
}

}  // namespace sim
