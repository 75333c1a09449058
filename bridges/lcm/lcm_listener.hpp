#pragma once

#include <chrono>
#include <cstdint>
#include <deque>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>

#include "bridges/lcm/lcm_connection.hpp"
#include "sim/bus/bus.hpp"

namespace bridges {

struct Received {
  std::string channel;
  sim::Bytes payload;
  std::int64_t wall_utime = 0;  ///< when it arrived, by the wall clock
};

/// LCM for one thread, without own threads: what was subscribed to, in the order of arrival.  Nothing is
/// dropped.
class LcmListener {
 public:
  explicit LcmListener(const std::string& url = {});

  void listen(const std::string& channel);
  /// To all channels but that of LCM's own self test.
  void listen_to_all();
  /// The next message, waiting for it.  Empty on time-out, or when a signal came.
  std::optional<Received> next(std::chrono::milliseconds timeout);
  /// At once.  False when LCM refused it.
  bool publish(std::string_view channel, std::span<const std::byte> payload);
  const std::string& url() const { return connection_.url(); }

 private:
  std::deque<Received> arrived_;
  LcmConnection connection_;
};

}  // namespace bridges
