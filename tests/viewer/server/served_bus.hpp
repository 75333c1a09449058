// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <chrono>
#include <cstdint>
#include <mutex>
#include <span>
#include <string>
#include <thread>

#include "tests/viewer/server/log_page.hpp"
#include "viewer/server/bus_view.hpp"

namespace served_bus {

/// The page of a bus, served in another thread.  The test puts messages on the bus.
class ServedBus {
 public:
  ServedBus() : view_(test::LogPage::options(), "test", "udpm://bus") {
    thread_ = std::thread([this] {
      while (!end_) {
        {
          const std::lock_guard lock(mutex_);
          view_.flush();
        }
        std::this_thread::sleep_for(std::chrono::milliseconds(1));
      }
    });
  }
  ~ServedBus() {
    end_ = true;
    thread_.join();
  }
  std::string url() const { return view_.url(); }
  void publish(const std::string& channel, std::span<const std::byte> payload) {
    const std::lock_guard lock(mutex_);
    view_.message(channel, payload);
  }
  /// Puts the messages of a log on the bus, as fast as possible.  Returns the number of those on `ball.pose`.
  std::int64_t play(const std::string& log) {
    bridges::EventLogReader reader(log);
    std::int64_t poses = 0;
    while (const auto event = reader.next()) {
      publish(event->channel, event->payload);
      poses += event->channel == "ball.pose";
    }
    return poses;
  }

 private:
  std::mutex mutex_;
  viewer::BusView view_;
  std::atomic<bool> end_ = false;
  std::thread thread_;
};

}  // namespace served_bus
