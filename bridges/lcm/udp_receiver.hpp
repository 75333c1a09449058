// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "bridges/base/file_descriptor.hpp"
#include "bridges/lcm/lcm_reassembly.hpp"
#include "bridges/lcm/own_addresses.hpp"

struct sock_filter;

namespace bridges {

/// The socket that a udpm bus receives by, in place of liblcm's: liblcm 1.3.1 believes what a datagram says of itself.
/// It is bound to the multicast group: what was sent to this machine's own address, or to another group on this port,
/// does not arrive.
class UdpReceiver {
 public:
  struct Options {
    std::string group;              ///< "239.255.76.67"
    int port = 7667;                ///< 1 to 65535
    int buffer_bytes = 0;           ///< of the kernel, which may grant less; 0: its default
    bool this_machine_only = true;  ///< drop what other machines send
  };
  using Accepts = std::function<bool(std::string_view channel)>;
  /// `received_at_us`: wall clock when the kernel got the last datagram of it, in microseconds since 1970.
  using Sink = std::function<void(const LcmReassembly::Message&, std::int64_t received_at_us)>;

  static constexpr std::size_t max_batch = 32;

  /// Throws BusError; its text says what failed, without the URL.
  explicit UdpReceiver(const Options& options);

  /// Readable when receive() has something.
  int fd() const { return socket_.number(); }
  /// Receives at most `max_batch` datagrams without waiting, and passes complete messages to `sink`.
  /// `wanted` filters fragmented messages by channel.  True when there may be more.
  bool receive(const Accepts& accepts, const Sink& sink);
  /// Lets the kernel drop what `program` (classic BPF) rejects; empty: nothing.  False when the kernel rejects it;
  /// then nothing is dropped.
  bool set_filter(std::vector<sock_filter> program);

  struct Counts {
    std::uint64_t datagrams = 0, bytes = 0;
    std::uint64_t foreign = 0;  ///< of other machines, dropped
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
