// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <atomic>
#include <chrono>
#include <cstdint>
#include <vector>

#include "bridges/base/poll_set.hpp"
#include "bridges/base/wake_event.hpp"

namespace bridges {

/// Wait condition of one thread for a message on any of several buses.  Before it sleeps, that thread sends the queued
/// messages of the buses, and it receives for them, so that no other thread delays the answer.  A bus that may block
/// does both itself, and is only notified when to send.
class Arrivals {
 public:
  /// Interface of a bus for the waiting thread.
  class Port {
   public:
    /// Sends the queued messages, or starts to send them.
    virtual void send_queued() = 0;
    /// Delivers received messages to the mailboxes.  Returns false when no further messages will arrive.
    virtual bool receive() = 0;

   protected:
    ~Port() = default;
  };

  /// Throws BusError when no file descriptor is available.
  Arrivals();
  Arrivals(const Arrivals&) = delete;
  Arrivals& operator=(const Arrivals&) = delete;

  /// Registration of a port.  While it exists, the waiting thread serves `port`, which can receive when `fd` is
  /// readable; negative: the port receives by itself.  Must be created and destroyed by that thread.
  class Place {
   public:
    Place(Arrivals& arrivals, Port& port, int fd) : arrivals_(arrivals), port_(port) { arrivals.add(port, fd); }
    ~Place() { arrivals_.remove(port_); }
    Place(const Place&) = delete;
    Place& operator=(const Place&) = delete;

   private:
    Arrivals& arrivals_;
    Port& port_;
  };

  /// Notifies that a message is in its mailbox.  Thread-safe.
  void arrived();
  /// Waits until a message has arrived since the last call returned; returns immediately when one has.  Returns false
  /// on time-out.  For one thread.
  bool wait(std::chrono::milliseconds timeout);

 private:
  struct Watched {
    Port* port;
    int fd;
  };
  void add(Port& port, int fd);
  void remove(Port& port);
  void receive(const PollSet::Readable& readable);

  PollSet readable_;
  const WakeEvent wake_;
  std::vector<Watched> ports_;
  std::atomic<std::uint64_t> count_ = 0;
  std::uint64_t seen_ = 0;
  std::atomic<bool> asleep_ = false;
};

}  // namespace bridges
