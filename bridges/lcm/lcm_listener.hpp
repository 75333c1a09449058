// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <chrono>
#include <cstdint>
#include <deque>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <thread>

#include "bridges/base/file_descriptor.hpp"
#include "bridges/base/poll_set.hpp"
#include "bridges/lcm/lcm_connection.hpp"
#include "sim/bus/bus.hpp"

namespace bridges {

struct Received {
  std::string channel;
  sim::Bytes payload;
  std::int64_t wall_utime = 0;  ///< arrival by the wall clock
};

/// LCM subscriber for a program with one thread: returns messages of the subscribed channels in the order of arrival.
/// The thread that calls next() receives while it waits; at other times a background thread receives, so that the
/// kernel buffer does not overflow.  Only messages beyond `max_waiting_bytes` are dropped, the oldest first.
class LcmListener {
 public:
  static constexpr std::size_t max_waiting_bytes = std::size_t{256} << 20;

  explicit LcmListener(const std::string& url = {});
  ~LcmListener();

  void listen(const std::string& channel);
  /// Subscribes to all channels except that of the self test of LCM.
  void listen_to_all();
  /// Calls `before_wait` in next() whenever all that have arrived were returned.  Ends the background thread, which
  /// costs a program wake-ups that takes messages at once.
  void take_in_batches(std::function<void()> before_wait);
  /// Waits for and returns the next message; none on time-out or signal.
  std::optional<Received> next(std::chrono::milliseconds timeout);
  /// Publishes a message immediately; returns false when LCM refused it.
  bool publish(std::string_view channel, std::span<const std::byte> payload);
  const std::string& url() const { return connection_.url(); }

 private:
  static void keep(const LcmMessage& message, void* listener);
  std::optional<Received> take();
  /// Throws BusError when the connection is lost.
  void receive();
  void receive_in_background();

  std::mutex mutex_;  // protects the received messages
  std::deque<Received> arrived_;
  std::size_t arrived_bytes_ = 0;
  bool waiting_ = false;
  std::function<void()> before_wait_;
  LcmConnection connection_;
  std::mutex receive_mutex_;
  FileDescriptor wake_, stop_;
  PollSet readable_, readable_by_thread_;
  std::thread thread_;  // not over memq and tcpq, where liblcm has one
};

}  // namespace bridges
