// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <atomic>
#include <chrono>
#include <cstdint>
#include <vector>

#include "bridges/base/poll_set.hpp"

namespace bridges {

/// Lets one thread sleep until a message comes on any of the buses that share this.  That thread sends what the buses
/// have queued before it sleeps, and receives for them: no other thread delays the answer.  A bus that
/// may block does both itself, and is only told when to send.
class Arrivals {
 public:
  /// A bus, as the thread that waits sees it.
  class Port {
   public:
    /// Sends, or begins to.
    virtual void send_queued() = 0;
    /// Delivers what has arrived to the mailboxes.  False: no further messages will arrive.
    virtual bool receive() = 0;

   protected:
    ~Port() = default;
  };

  /// Throws BusError when no file descriptor is left.
  Arrivals();
  ~Arrivals();
  Arrivals(const Arrivals&) = delete;
  Arrivals& operator=(const Arrivals&) = delete;

  /// While it lives the thread that waits serves `port`, which can receive when `fd` is readable; negative: it receives
  /// by itself.  Made and destroyed by that thread.
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

  /// A message is in its mailbox.  From any thread.
  void arrived();
  /// By one thread.  Sleeps until a message arrived after the last call returned; at once if one did already.  False on
  /// time-out.
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
  int wake_fd_;
  std::vector<Watched> ports_;
  std::atomic<std::uint64_t> count_ = 0;
  std::uint64_t seen_ = 0;
  std::atomic<bool> asleep_ = false;
};

}  // namespace bridges
