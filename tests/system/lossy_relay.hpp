// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <atomic>
#include <map>
#include <optional>
#include <random>
#include <string>
#include <thread>
#include <utility>

#include "bridges/lcm/lcm_connection.hpp"
#include "sim/base/crc32.hpp"
#include "sim/bus/bus.hpp"

namespace system_test {

/// Passes messages between two LCM URLs, both ways, over a network that is bad: each message is lost with some
/// probability, sent twice with half of it, and with half of it changes places with the next one.
class LossyRelay {
 public:
  LossyRelay(const std::string& one, const std::string& other, double probability, unsigned seed)
      : one_(one), other_(other), probability_(probability), random_(seed) {
    one_.twin = &other_;
    other_.twin = &one_;
    for (Side* side : {&one_, &other_}) {
      side->relay = this;
      side->lcm.subscribe_to_all(on_message, side);
    }
    thread_ = std::thread([this] { run(); });
  }
  ~LossyRelay() {
    stop_ = true;
    thread_.join();
  }
  LossyRelay(const LossyRelay&) = delete;
  LossyRelay& operator=(const LossyRelay&) = delete;

  int lost() const { return lost_; }
  int repeated() const { return repeated_; }
  int swapped() const { return swapped_; }

 private:
  using Sent = std::pair<std::string, std::uint32_t>;
  struct Side {
    explicit Side(const std::string& url) : lcm(url) {}
    bridges::LcmConnection lcm;
    Side* twin = nullptr;
    LossyRelay* relay = nullptr;
    std::map<Sent, int> echoes;  ///< what we sent here, and receive again
    std::optional<std::pair<std::string, sim::Bytes>> held;
  };

  static void on_message(const bridges::LcmMessage& message, void* user) {
    auto& side = *static_cast<Side*>(user);
    side.relay->pass(side, std::string(message.channel), {message.payload.begin(), message.payload.end()});
  }

  bool happens(double probability) { return std::uniform_real_distribution<>(0, 1)(random_) < probability; }

  void pass(Side& from, const std::string& channel, sim::Bytes payload) {
    if (channel == "LCM_SELF_TEST") return;
    const auto echo = from.echoes.find({channel, sim::crc32(payload)});
    if (echo != from.echoes.end()) {
      if (--echo->second == 0) from.echoes.erase(echo);
      return;
    }
    Side& to = *from.twin;
    if (happens(probability_)) {
      ++lost_;
    } else if (!to.held && happens(probability_ / 2)) {
      ++swapped_;
      to.held.emplace(channel, std::move(payload));
      return;
    } else {
      send(to, channel, payload);
      if (happens(probability_ / 2)) {
        ++repeated_;
        send(to, channel, payload);
      }
    }
    release(to);
  }

  void send(Side& to, const std::string& channel, const sim::Bytes& payload) {
    ++to.echoes[{channel, sim::crc32(payload)}];
    to.lcm.publish(channel.c_str(), payload);
  }

  void release(Side& to) {
    if (!to.held) return;
    const auto [channel, payload] = *std::exchange(to.held, std::nullopt);
    send(to, channel, payload);
  }

  void run() {
    while (!stop_) {
      const bool some = bridges::wait_readable(one_.lcm.fd(), other_.lcm.fd(), std::chrono::milliseconds(5));
      if (!some) {
        release(one_);
        release(other_);
        continue;
      }
      for (Side* side : {&one_, &other_})
        while (bridges::wait_readable(side->lcm.fd(), -1, std::chrono::milliseconds(0))) side->lcm.handle();
    }
  }

  Side one_, other_;
  const double probability_;
  std::mt19937 random_;
  std::atomic<int> lost_ = 0, repeated_ = 0, swapped_ = 0;
  std::atomic<bool> stop_ = false;
  std::thread thread_;
};

}  // namespace system_test
