// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <chrono>
#include <cstdint>
#include <deque>
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
  std::int64_t wall_utime = 0;  ///< when it arrived, by the wall clock
};

/// LCM for a program with one thread: what was subscribed to, in the order of arrival.  The thread that calls next()
/// receives while it waits; while it does other things a thread of the listener does, so that the kernel's buffer does
/// not overflow.  Only what waits beyond `max_waiting_bytes` is dropped, the oldest first.
class LcmListener {
 public:
  static constexpr std::size_t max_waiting_bytes = std::size_t{256} << 20;

  explicit LcmListener(const std::string& url = {});
  ~LcmListener();

  void listen(const std::string& channel);
  /// To all channels but that of LCM's own self test.
  void listen_to_all();
  /// The next message, waiting for it.  Empty on time-out, or when a signal came.
  std::optional<Received> next(std::chrono::milliseconds timeout);
  /// At once.  False when LCM refused it.
  bool publish(std::string_view channel, std::span<const std::byte> payload);
  const std::string& url() const { return connection_.url(); }

 private:
  static void keep(const LcmMessage& message, void* listener);
  std::optional<Received> take();
  /// Throws BusError when the connection is lost.
  void receive();
  void receive_in_background();

  std::mutex mutex_;  // of what has arrived
  std::deque<Received> arrived_;
  std::size_t arrived_bytes_ = 0;
  bool waiting_ = false;
  LcmConnection connection_;
  std::mutex receive_mutex_;
  FileDescriptor wake_, stop_;
  PollSet readable_, readable_by_thread_;
  std::thread thread_;  // not over memq and tcpq, where liblcm has one
};

}  // namespace bridges
