// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "sim/bus/bus.hpp"

namespace experiment {

/// Bus between a world and its network: while it is muted, nothing is sent and incoming messages are discarded.
class MuteBus final : public sim::Bus {
 public:
  /// `inner` must outlive this.
  explicit MuteBus(sim::Bus& inner) : inner_(inner) {}

  void set_muted(bool muted) { muted_ = muted; }
  void publish(std::string_view channel, std::span<const std::byte> payload, sim::Time at) override {
    if (!muted_) inner_.publish(channel, payload, at);
  }
  std::unique_ptr<sim::OpenChannel> open_channel(const std::string& channel) override {
    return std::make_unique<MuteChannel>(*this, inner_.open_channel(channel));
  }
  std::unique_ptr<sim::Mailbox> open_mailbox(const std::string& channel,
                                             std::size_t capacity = default_mailbox_capacity) override {
    return std::make_unique<MuteMailbox>(*this, inner_.open_mailbox(channel, capacity));
  }
  void end_of_step() override {
    if (!muted_) inner_.end_of_step();
  }
  sim::BusCounts counts() const override { return inner_.counts(); }

 private:
  class MuteChannel final : public sim::OpenChannel {
   public:
    MuteChannel(const MuteBus& bus, std::unique_ptr<sim::OpenChannel> inner) : bus_(bus), inner_(std::move(inner)) {}
    void publish(std::span<const std::byte> payload, sim::Time at) override {
      if (!bus_.muted_) inner_->publish(payload, at);
    }

   private:
    const MuteBus& bus_;
    const std::unique_ptr<sim::OpenChannel> inner_;
  };

  class MuteMailbox final : public sim::Mailbox {
   public:
    MuteMailbox(const MuteBus& bus, std::unique_ptr<sim::Mailbox> inner) : bus_(bus), inner_(std::move(inner)) {}
    std::optional<sim::Message> take() override {
      if (bus_.muted_)
        while (inner_->take()) {
        }
      return bus_.muted_ ? std::nullopt : inner_->take();
    }
    std::uint64_t dropped() const override { return inner_->dropped(); }
    void raise_on_arrival(std::shared_ptr<std::atomic<bool>> flag) override {
      inner_->raise_on_arrival(std::move(flag));
    }

   private:
    const MuteBus& bus_;
    std::unique_ptr<sim::Mailbox> inner_;
  };

  sim::Bus& inner_;
  bool muted_ = false;
};

}  // namespace experiment
