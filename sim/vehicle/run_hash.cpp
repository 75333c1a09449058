// SPDX-License-Identifier: BSD-3-Clause
#include "sim/vehicle/run_hash.hpp"

#include <string>

#include "sim/base/state_hash.hpp"

namespace sim {

class RunHash::CountedBus final : public Bus {
 public:
  CountedBus(RunHash& hash, Bus& inner) : hash_(hash), inner_(inner) {}

  void publish(std::string_view channel, std::span<const std::byte> payload, Time at) override {
    hash_.add_message(channel, payload);
    inner_.publish(channel, payload, at);
  }
  std::unique_ptr<Mailbox> open_mailbox(const std::string& channel, std::size_t capacity) override {
    return inner_.open_mailbox(channel, capacity);
  }
  void end_of_step() override { inner_.end_of_step(); }
  BusCounts counts() const override { return inner_.counts(); }
  Bus& inner() const { return inner_; }

 private:
  RunHash& hash_;
  Bus& inner_;
};

RunHash::RunHash() = default;
RunHash::~RunHash() = default;

Bus& RunHash::counted(Bus& bus) {
  std::unique_ptr<CountedBus>& slot = counted_[&bus];
  if (!slot) slot = std::make_unique<CountedBus>(*this, bus);
  return *slot;
}

Bus& RunHash::uncounted(Bus& bus) {
  const auto* counted = dynamic_cast<const CountedBus*>(&bus);
  return counted != nullptr ? counted->inner() : bus;
}

void RunHash::add_message(std::string_view channel, std::span<const std::byte> payload) {
  StateHash hash;
  hash.add(chain_);
  hash.add(channel);
  hash.add_bytes(payload.data(), payload.size());
  chain_ = hash.value();
}

void RunHash::add_state(std::uint64_t state_hash) {
  StateHash hash;
  hash.add(chain_);
  hash.add(state_hash);
  chain_ = hash.value();
}

}  // namespace sim
