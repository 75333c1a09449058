// SPDX-License-Identifier: BSD-3-Clause
#include "sim/bus/bus.hpp"

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

}  // namespace sim
