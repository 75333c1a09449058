// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "bridges/base/file_descriptor.hpp"
#include "bridges/lcm/lcm_reassembly.hpp"

struct sock_filter;

namespace bridges {

/// IPv4 addresses of this machine.
class OwnAddresses {
 public:
  OwnAddresses();

  /// Returns whether `address` (host byte order) belongs to this machine, as all of 127.0.0.0/8 do.  For an unknown
  /// address the list is read again, at most once a second, because interfaces can change.
  bool contain(std::uint32_t address);

 private:
  void read();

  std::vector<std::uint32_t> addresses_;
  std::chrono::steady_clock::time_point read_at_;
};

/// Receiving socket of a udpm bus, used instead of that of liblcm, because liblcm 1.3.1 does not validate the fields of
/// datagrams.  It is bound to the multicast group: datagrams to the address of this machine, or to another group on
/// this port, are not received.
class UdpReceiver {
 public:
  struct Options {
    std::string group;              ///< "239.255.76.67"
    int port = 7667;                ///< 1 to 65535
    int buffer_bytes = 0;           ///< size of the kernel buffer, which may be granted in part; 0: default
    bool this_machine_only = true;  ///< drop datagrams from other machines
  };
  using Accepts = std::function<bool(std::string_view channel)>;
  /// Callback for a message.  `received_at_us`: wall time of reception of its last datagram by the kernel, in
  /// microseconds since 1970.
  using Sink = std::function<void(const LcmReassembly::Message&, std::int64_t received_at_us)>;

  static constexpr std::size_t max_batch = 32;

  /// Throws BusError with the operation that failed, without the URL.
  explicit UdpReceiver(const Options& options);

  /// Returns a descriptor that is readable when receive() has data.
  int fd() const { return socket_.number(); }
  /// Receives at most `max_batch` datagrams without waiting, and passes complete messages to `sink`.  `accepts` filters
  /// fragmented messages by channel.  Returns true when there may be more.
  bool receive(const Accepts& accepts, const Sink& sink);
  /// Sets the kernel filter (classic BPF); empty: no filter.  Returns false when the kernel rejects it; then nothing is
  /// filtered.
  bool set_filter(std::vector<sock_filter> program);

  struct Counts {
    std::uint64_t datagrams = 0, bytes = 0;
    std::uint64_t foreign = 0;  ///< dropped datagrams from other machines
  };
  const Counts& counts() const { return counts_; }
  const LcmReassembly::Counts& reassembly_counts() const { return reassembly_.counts(); }

 private:
  struct Batch;
  struct BatchDeleter {
    void operator()(Batch* batch) const;
  };

  bool is_own(std::uint32_t address);

  Options options_;
  bool is_group_of_link_;
  FileDescriptor socket_;
  std::unique_ptr<Batch, BatchDeleter> batch_;
  OwnAddresses own_;
  LcmReassembly reassembly_;
  Counts counts_;
};

}  // namespace bridges
