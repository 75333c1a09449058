// SPDX-License-Identifier: BSD-3-Clause
#include "bridges/lcm/udp_receiver.hpp"

#include <arpa/inet.h>
#include <ifaddrs.h>
#include <linux/filter.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <sys/time.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <chrono>
#include <cstring>

#include "bridges/base/bus_error.hpp"

namespace bridges {
namespace {

/// Buffer for a datagram, larger than any payload of UDP over IPv4.
constexpr std::size_t max_datagram_bytes = 65536;

[[noreturn]] void fail_with_errno(const std::string& what) {
  throw BusError(what + " (" + std::strerror(errno) + ")");
}

void set_option(int fd, int level, int name, int value, const char* what) {
  if (setsockopt(fd, level, name, &value, sizeof value) != 0) fail_with_errno(what);
}

FileDescriptor open_socket(const UdpReceiver::Options& options) {
  FileDescriptor opened(socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC | SOCK_NONBLOCK, 0));
  const int fd = opened.number();
  if (fd < 0) fail_with_errno("no socket can be opened");
  // lcm-spy, lcm-logger and other runs use the same port.
  set_option(fd, SOL_SOCKET, SO_REUSEADDR, 1, "the port cannot be shared");
  set_option(fd, SOL_SOCKET, SO_TIMESTAMP, 1, "the kernel provides no timestamps for messages");
  if (options.buffer_bytes > 0)
    set_option(fd, SOL_SOCKET, SO_RCVBUF, options.buffer_bytes, "the receive buffer cannot be set");
  // Bind to the group and port, and join the group.
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_port = htons(static_cast<std::uint16_t>(options.port));
  ip_mreq membership{};
  if (inet_pton(AF_INET, options.group.c_str(), &address.sin_addr) != 1)
    throw BusError("'" + options.group + "' is not an IPv4 address");
  membership.imr_multiaddr = address.sin_addr;
  membership.imr_interface.s_addr = htonl(INADDR_ANY);
  if (bind(fd, reinterpret_cast<const sockaddr*>(&address), sizeof address) != 0)
    fail_with_errno("port " + std::to_string(options.port) + " cannot be used");
  if (setsockopt(fd, IPPROTO_IP, IP_ADD_MEMBERSHIP, &membership, sizeof membership) != 0)
    fail_with_errno("the multicast group " + options.group + " cannot be joined");
  return opened;
}

/// Returns the time of reception of the datagram by the kernel; the present time if it is not given.
std::int64_t received_at_us(msghdr& header) {
  for (cmsghdr* part = CMSG_FIRSTHDR(&header); part != nullptr; part = CMSG_NXTHDR(&header, part)) {
    if (part->cmsg_level != SOL_SOCKET || part->cmsg_type != SCM_TIMESTAMP) continue;
    timeval time{};
    std::memcpy(&time, CMSG_DATA(part), sizeof time);
    return std::int64_t{time.tv_sec} * 1'000'000 + time.tv_usec;
  }
  using namespace std::chrono;
  return duration_cast<microseconds>(system_clock::now().time_since_epoch()).count();
}

}  // namespace

/// Buffers for recvmmsg.  Pages of `bytes` beyond the largest datagram are never touched.
struct UdpReceiver::Batch {
  struct alignas(cmsghdr) Control {
    std::array<std::byte, CMSG_SPACE(sizeof(timeval))> bytes;
  };

  Batch() : bytes(std::make_unique_for_overwrite<std::byte[]>(max_batch * max_datagram_bytes)) {
    for (std::size_t i = 0; i < max_batch; ++i) parts[i] = {bytes.get() + i * max_datagram_bytes, max_datagram_bytes};
  }

  /// Resets the sizes, which the kernel overwrites.
  void prepare() {
    for (std::size_t i = 0; i < max_batch; ++i) {
      msghdr& header = headers[i].msg_hdr;
      header.msg_name = &senders[i];
      header.msg_namelen = sizeof senders[i];
      header.msg_iov = &parts[i];
      header.msg_iovlen = 1;
      header.msg_control = &controls[i];
      header.msg_controllen = sizeof controls[i];
      header.msg_flags = 0;
    }
  }

  std::unique_ptr<std::byte[]> bytes;
  std::array<iovec, max_batch> parts{};
  std::array<sockaddr_in, max_batch> senders{};
  std::array<Control, max_batch> controls{};
  std::array<mmsghdr, max_batch> headers{};
};

void UdpReceiver::BatchDeleter::operator()(Batch* batch) const {
  delete batch;
}

UdpReceiver::UdpReceiver(const Options& options)
    : options_(options),
      is_group_of_link_(options.group.starts_with("224.0.0.")),
      socket_(open_socket(options)),
      batch_(new Batch) {}

bool UdpReceiver::receive(const Accepts& accepts, const Sink& sink) {
  batch_->prepare();
  // One system call for many datagrams: at tens of thousands of messages per second the calls dominate the cost.
  const int count = recvmmsg(fd(), batch_->headers.data(), max_batch, MSG_DONTWAIT, nullptr);
  if (count <= 0) return false;
  const auto received = static_cast<std::size_t>(count);
  for (std::size_t i = 0; i < received; ++i) {
    mmsghdr& header = batch_->headers[i];
    const DatagramSender from{ntohl(batch_->senders[i].sin_addr.s_addr), ntohs(batch_->senders[i].sin_port)};
    ++counts_.datagrams;
    counts_.bytes += header.msg_len;
    // With ttl=0 the group is local to the machine, but another machine can still send to its port by unicast. Such
    // datagrams are counted and dropped.
    if (options_.this_machine_only && !is_own(from.address)) {
      ++counts_.foreign;
      continue;
    }
    const auto* data = static_cast<const std::byte*>(batch_->parts[i].iov_base);
    if (const auto message = reassembly_.add({data, header.msg_len}, from, accepts))
      sink(*message, received_at_us(header.msg_hdr));
  }
  return received == max_batch;
}

bool UdpReceiver::is_own(std::uint32_t address) {
  // The source is 0.0.0.0 when the route to the group uses lo.  The kernel does not accept such datagrams from other
  // machines, nor those with an address of this machine, except for link-local groups (224.0.0.0/24).
  if (address == INADDR_ANY) return !is_group_of_link_;
  return own_.contain(address);
}

bool UdpReceiver::set_filter(std::vector<sock_filter> program) {
  if (!program.empty()) {
    const sock_fprog attached{static_cast<unsigned short>(program.size()), program.data()};
    if (setsockopt(fd(), SOL_SOCKET, SO_ATTACH_FILTER, &attached, sizeof attached) == 0) return true;
  }
  const int unused = 0;
  setsockopt(fd(), SOL_SOCKET, SO_DETACH_FILTER, &unused, sizeof unused);
  return program.empty();
}

OwnAddresses::OwnAddresses() {
  read();
}

bool OwnAddresses::contain(std::uint32_t address) {
  if (address >> 24 == IN_LOOPBACKNET) return true;
  const auto known = [&] { return std::find(addresses_.begin(), addresses_.end(), address) != addresses_.end(); };
  if (known()) return true;
  if (std::chrono::steady_clock::now() - read_at_ < std::chrono::seconds(1)) return false;
  read();
  return known();
}

void OwnAddresses::read() {
  read_at_ = std::chrono::steady_clock::now();
  addresses_.clear();
  ifaddrs* list = nullptr;
  if (getifaddrs(&list) != 0) return;
  for (const ifaddrs* entry = list; entry != nullptr; entry = entry->ifa_next)
    if (entry->ifa_addr != nullptr && entry->ifa_addr->sa_family == AF_INET)
      addresses_.push_back(ntohl(reinterpret_cast<const sockaddr_in*>(entry->ifa_addr)->sin_addr.s_addr));
  freeifaddrs(list);
}

}  // namespace bridges
