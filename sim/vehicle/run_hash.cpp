// SPDX-License-Identifier: BSD-3-Clause
#include "sim/vehicle/run_hash.hpp"

#include <mutex>
#include <string>
#include <utility>

#include "sim/base/state_hash.hpp"

namespace sim {

namespace {

thread_local DeferredMessages* deferred = nullptr;

}  // namespace

DeferredMessages::InThread::InThread(DeferredMessages& messages) {
  deferred = &messages;
}

DeferredMessages::InThread::~InThread() {
  deferred = nullptr;
}

void DeferredMessages::add(OpenChannel& channel, std::span<const std::byte> payload, Time at) {
  bytes_.insert(bytes_.end(), payload.begin(), payload.end());
  entries_.push_back({&channel, at, bytes_.size()});
}

void DeferredMessages::publish() {
  std::size_t begin = 0;
  for (const Entry& entry : entries_) {
    entry.channel->publish(std::span(bytes_).subspan(begin, entry.end - begin), entry.at);
    begin = entry.end;
  }
  entries_.clear();
  bytes_.clear();
}

class RunHash::CountedChannel final : public OpenChannel {
 public:
  CountedChannel(RunHash& hash, const std::string& name, std::unique_ptr<OpenChannel> inner)
      : hash_(hash), inner_(std::move(inner)), name_(name) {}

  void publish(std::span<const std::byte> payload, Time at) override {
    if (deferred != nullptr) return deferred->add(*this, payload, at);
    hash_.add_message(name_, payload);
    inner_->publish(payload, at);
  }

 private:
  RunHash& hash_;
  const std::unique_ptr<OpenChannel> inner_;
  const std::string name_;
};

class RunHash::CountedBus final : public Bus {
 public:
  CountedBus(RunHash& hash, Bus& inner) : hash_(hash), inner_(inner) {}

  void publish(std::string_view channel, std::span<const std::byte> payload, Time at) override {
    hash_.add_message(channel, payload);
    inner_.publish(channel, payload, at);
  }
  std::unique_ptr<OpenChannel> open_channel(const std::string& channel) override {
    const std::lock_guard lock(opening_);  // devices that threads share may open channels
    return std::make_unique<CountedChannel>(hash_, channel, inner_.open_channel(channel));
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
  std::mutex opening_;
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
