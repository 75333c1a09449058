// SPDX-License-Identifier: BSD-3-Clause
// Sends garbage to a multicast group, for flood.py; ends by itself.
//   flood PORT KIND MESSAGES_PER_SECOND SECONDS [CHANNEL]
// Kinds: unwanted (channels without a reader), malformed (100 bytes of 0xff on CHANNEL), fragments (of messages that
// are never completed, on CHANNEL), noise (not LCM's).
#include <arpa/inet.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <sys/uio.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <string>
#include <thread>
#include <vector>

namespace {

using Clock = std::chrono::steady_clock;

constexpr std::size_t payload_bytes = 100;
constexpr std::size_t max_batch = 64;

void append(std::string& bytes, std::uint64_t value, int size) {
  for (int shift = 8 * (size - 1); shift >= 0; shift -= 8) bytes += static_cast<char>(value >> shift);
}

std::string datagram(const std::string& kind, const std::string& channel, std::uint32_t number) {
  std::string bytes;
  if (kind == "noise") return std::string(payload_bytes, static_cast<char>(number));
  append(bytes, kind == "fragments" ? 0x4c433033 : 0x4c433032, 4);
  append(bytes, number, 4);
  if (kind == "fragments") {
    append(bytes, std::uint64_t{16} << 20, 4);
    append(bytes, 0, 4);
    append(bytes, 0, 2);
    append(bytes, 300, 2);
  }
  bytes += kind == "unwanted" ? "garbage." + std::to_string(number % 1000) : channel;
  bytes += '\0';
  return bytes + std::string(payload_bytes, '\xff');
}

}  // namespace

int main(int argc, char** argv) {
  if (argc < 5) {
    std::fputs("usage: flood PORT unwanted|malformed|fragments|noise MESSAGES_PER_SECOND SECONDS [CHANNEL]\n", stderr);
    return 2;
  }
  const std::string kind = argv[2], channel = argc > 5 ? argv[5] : "sim.control";
  const double rate = std::atof(argv[3]), seconds = std::atof(argv[4]);
  const int fd = socket(AF_INET, SOCK_DGRAM, 0);
  const unsigned char ttl = 0;
  setsockopt(fd, IPPROTO_IP, IP_MULTICAST_TTL, &ttl, sizeof ttl);
  sockaddr_in to{};
  to.sin_family = AF_INET;
  to.sin_port = htons(static_cast<std::uint16_t>(std::atoi(argv[1])));
  inet_pton(AF_INET, "239.255.76.67", &to.sin_addr);

  std::vector<std::string> datagrams;
  for (std::uint32_t i = 0; i < 4096; ++i) datagrams.push_back(datagram(kind, channel, i));
  std::array<iovec, max_batch> parts{};
  std::array<mmsghdr, max_batch> headers{};
  const auto begin = Clock::now();
  std::uint64_t sent = 0;
  while (true) {
    const double elapsed = std::chrono::duration<double>(Clock::now() - begin).count();
    if (elapsed > seconds) break;
    const auto due = static_cast<std::uint64_t>(elapsed * rate);
    if (due <= sent) {
      std::this_thread::sleep_for(std::chrono::microseconds(500));
      continue;
    }
    const std::size_t count = std::min<std::uint64_t>(due - sent, max_batch);
    for (std::size_t i = 0; i < count; ++i) {
      std::string& bytes = datagrams[(sent + i) % datagrams.size()];
      parts[i] = {bytes.data(), bytes.size()};
      headers[i].msg_hdr = {};
      headers[i].msg_hdr.msg_name = &to;
      headers[i].msg_hdr.msg_namelen = sizeof to;
      headers[i].msg_hdr.msg_iov = &parts[i];
      headers[i].msg_hdr.msg_iovlen = 1;
    }
    const int done = sendmmsg(fd, headers.data(), static_cast<unsigned>(count), 0);
    if (done <= 0) {
      std::perror("flood");
      return 1;
    }
    sent += static_cast<std::uint64_t>(done);
  }
  std::printf("%.0f messages/s\n", static_cast<double>(sent) / seconds);
}
