// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <atomic>
#include <functional>
#include <mutex>
#include <string>
#include <thread>

#include "bridges/base/file_descriptor.hpp"
#include "bridges/base/wake_event.hpp"

namespace bridges {

/// TCP server on this machine for one client at a time; others are refused while it is there.  A thread serves it.
class LineServer {
 public:
  struct Handlers {
    std::function<void()> connected;                                ///< a client has come
    std::function<std::string(const std::string& bytes)> received;  ///< returns the answer
  };
  /// Output of a client that does not read: it is disconnected when more waits.
  static constexpr std::size_t max_waiting_bytes = 1 << 20;

  /// Listens on 127.0.0.1 at `port`; 0: any, see port().  Throws BusError.
  LineServer(int port, Handlers handlers);
  ~LineServer();
  LineServer(const LineServer&) = delete;
  LineServer& operator=(const LineServer&) = delete;

  int port() const { return port_; }
  /// Sends text to the client, if there is one.
  void send(const std::string& text);

 private:
  void run();
  void accept_client();
  void serve_client(short events);
  void drop_client();

  const Handlers handlers_;
  const WakeEvent wake_;
  FileDescriptor listener_, client_;
  int port_ = 0;
  std::mutex mutex_;
  std::string output_;
  std::atomic<bool> has_client_ = false, stopping_ = false;
  std::thread thread_;
};

}  // namespace bridges
