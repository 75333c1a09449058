// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <atomic>
#include <chrono>
#include <condition_variable>
#include <functional>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "bridges/base/file_descriptor.hpp"
#include "bridges/base/wake_event.hpp"
#include "bridges/moos/moos_session.hpp"

namespace bridges {

/// Connects to HOST:PORT over TCP, without delay of small packets; the descriptor does not block.  Throws MoosError
/// with the reason, also after 5 s without an answer, and when `wake` becomes readable.
FileDescriptor connect_tcp(const std::string& host, int port, int wake);

/// Client of a MOOSDB that may be absent, die and come back: a thread connects, subscribes, and tries again each second
/// after it has lost the connection.  notify() writes to the socket itself, which saves waking that thread.
class MoosConnection {
 public:
  struct Options {
    std::string host = "localhost";
    int port = 9000;
    MoosClientTerms terms;
    /// Called in the thread of the connection with the messages of one reading.
    std::function<void(const std::vector<MoosMessage>&)> on_received;
    /// Called in the same thread with a sentence when the connection opens, is lost, or cannot be made; once for
    /// the same reason.
    std::function<void(const std::string&)> report;
  };

  explicit MoosConnection(Options options);
  ~MoosConnection();
  MoosConnection(const MoosConnection&) = delete;
  MoosConnection& operator=(const MoosConnection&) = delete;

  /// Sends values of variables.  Without a connection they are dropped, since others soon replace them.
  void notify(const std::vector<MoosValue>& values);
  /// Waits until the connection is open; returns whether it is.
  bool await_open(std::chrono::milliseconds timeout);
  bool is_open() const { return open_; }

 private:
  void run();
  /// Serves one connection until it is lost, which throws MoosError, or the end.
  void serve();
  /// Reads once; returns the messages that came for the variables.
  std::vector<MoosMessage> read();
  /// Gives the socket what it takes; the rest waits until poll() says that it takes more.
  void write();
  void wait_for_next_try();
  void set_open(bool open);
  void report_once(const std::string& sentence);

  const Options options_;
  const WakeEvent wake_;
  std::mutex mutex_;  // of the session and of writing
  std::condition_variable opened_;
  std::optional<MoosSession> session_;
  FileDescriptor socket_;
  std::atomic<bool> open_ = false, stopping_ = false;
  std::string last_report_;
  std::thread thread_;
};

}  // namespace bridges
