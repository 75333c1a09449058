// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <functional>
#include <memory>
#include <string>
#include <string_view>
#include <utility>

#include "sim/bus/bus.hpp"

namespace experiment {

/// Bus that also passes what is published to a listener.
class TapBus final : public sim::Bus {
 public:
  using Listener = std::function<void(std::string_view channel, std::span<const std::byte> payload, sim::Time at)>;

  /// `inner` must outlive this.
  TapBus(sim::Bus& inner, Listener listener) : inner_(inner), listener_(std::move(listener)) {}

  void publish(std::string_view channel, std::span<const std::byte> payload, sim::Time at) override {
    listener_(channel, payload, at);
    inner_.publish(channel, payload, at);
  }
  std::unique_ptr<sim::OpenChannel> open_channel(const std::string& channel) override {
    return std::make_unique<TappedChannel>(listener_, channel, inner_.open_channel(channel));
  }
  std::unique_ptr<sim::Mailbox> open_mailbox(const std::string& channel,
                                             std::size_t capacity = default_mailbox_capacity) override {
    return inner_.open_mailbox(channel, capacity);
  }
  void end_of_step() override { inner_.end_of_step(); }
  sim::BusCounts counts() const override { return inner_.counts(); }

 private:
  class TappedChannel final : public sim::OpenChannel {
   public:
    TappedChannel(const Listener& listener, const std::string& name, std::unique_ptr<sim::OpenChannel> inner)
        : listener_(listener), name_(name), inner_(std::move(inner)) {}
    void publish(std::span<const std::byte> payload, sim::Time at) override {
      listener_(name_, payload, at);
      inner_->publish(payload, at);
    }

   private:
    const Listener& listener_;
    const std::string name_;
    const std::unique_ptr<sim::OpenChannel> inner_;
  };

  sim::Bus& inner_;
  const Listener listener_;
};

}  // namespace experiment
