// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <functional>
#include <list>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "bridges/base/file_descriptor.hpp"
#include "bridges/base/wake_event.hpp"
#include "sim/nmea/nmea.hpp"

namespace bridges::nmea {

/// A host, by name or number, and a port.
struct Endpoint {
  std::string host;
  std::uint16_t port = 0;
};

/// Reads `HOST:PORT`; an IPv6 address is in brackets.  Throws std::invalid_argument with the rule and the text.
Endpoint read_endpoint(const std::string& text);

/// Sockets of NMEA 0183 over a network, in their own thread: a TCP server, whose clients all receive the same lines and
/// may send some, and one UDP peer.
///
/// Limits: 32 clients; 64 KiB that a client has not taken yet, beyond which it is cut; of what clients send, 64 lines
/// until take_lines(), beyond which the oldest are dropped, and 64 KiB a second from each, beyond which it is cut.
class NmeaServer {
 public:
  static constexpr std::size_t max_clients = 32, max_waiting_bytes = 64 << 10, max_lines = 64,
                               max_bytes_per_s = 64 << 10;
  struct Options {
    std::optional<Endpoint> listen;  ///< of the TCP server; port 0: any free one
    std::optional<Endpoint> udp;     ///< each line is sent there in a datagram; lines are taken from this peer only
    std::function<void(const std::string&)>
        log;  ///< called in the thread, a line for each client that connects or leaves
  };
  /// A line from a client.
  struct Line {
    std::string from;  ///< address and port
    std::string text;
  };

  /// Opens the sockets and starts the thread.  Throws BusError.
  explicit NmeaServer(Options options);
  ~NmeaServer();
  NmeaServer(const NmeaServer&) = delete;
  NmeaServer& operator=(const NmeaServer&) = delete;

  /// Returns the port of the TCP server; 0: none.
  std::uint16_t port() const { return port_; }
  /// Sends lines, given without their ends, to all clients.  Never blocks.  Thread-safe.
  void send(const std::vector<std::string>& lines);
  /// Returns what clients have sent since the last call.  Thread-safe.
  std::vector<Line> take_lines();

 private:
  struct Client;
  void run();
  void accept_client();
  /// Return why the client is to be closed; empty: it stays.
  std::string receive(Client& client);
  std::string flush(Client& client);
  void receive_datagrams();
  void keep(const std::string& from, std::vector<sim::NmeaLines::Line> lines);
  void distribute();

  Options options_;
  FileDescriptor listener_, udp_;
  const WakeEvent wake_;
  std::uint16_t port_ = 0;
  std::mutex mutex_;                  // of the next three
  std::vector<std::string> to_send_;  // lines with their ends
  std::vector<Line> received_;
  bool stop_ = false;
  std::list<Client> clients_;  // of the thread
  std::thread thread_;
};

}  // namespace bridges::nmea
