// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <arpa/inet.h>
#include <fcntl.h>
#include <linux/if_tun.h>
#include <net/if.h>
#include <net/route.h>
#include <netinet/in.h>
#include <poll.h>
#include <sys/ioctl.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <chrono>
#include <csignal>
#include <cstdint>
#include <cstring>
#include <deque>
#include <random>
#include <string>
#include <vector>

#include "tests/bridges/lcm/own_network.hpp"

namespace system_test {

/// Two networks of their own, as of two machines, with a relay between them that passes each IP packet on after 20 ms,
/// and drops 1 % of them by a seed.  The relay is a process with an interface in each of them.
class TwoMachines {
 public:
  static constexpr const char* addresses[] = {"10.9.0.1", "10.9.0.2"};

  explicit TwoMachines(unsigned seed) {
    std::array<int, 2> ready{};
    if (pipe2(ready.data(), O_CLOEXEC) != 0) return;
    relay_ = fork();
    if (relay_ == 0) relay(ready[1], seed);
    close(ready[1]);
    // The numbers of the two networks, as descriptors of the relay; nothing if they are not permitted.
    permitted_ = read(ready[0], networks_.data(), sizeof networks_) == static_cast<ssize_t>(sizeof networks_);
    close(ready[0]);
  }
  ~TwoMachines() {
    kill(relay_, SIGKILL);
    waitpid(relay_, nullptr, 0);
  }
  TwoMachines(const TwoMachines&) = delete;
  TwoMachines& operator=(const TwoMachines&) = delete;

  bool permitted() const { return permitted_; }
  /// The arguments that run a program on a machine, 0 or 1.
  std::vector<std::string> on(std::size_t machine, const std::vector<std::string>& program) const {
    const std::string proc = "/proc/" + std::to_string(relay_);
    std::vector<std::string> all{"nsenter", "--preserve-credentials", "--user=" + proc + "/ns/user",
                                 "--net=" + proc + "/fd/" + std::to_string(networks_.at(machine))};
    all.insert(all.end(), program.begin(), program.end());
    return all;
  }

 private:
  using Clock = std::chrono::steady_clock;
  struct Packet {
    Clock::time_point due;
    std::vector<char> bytes;
  };

  static sockaddr address_of(const char* text) {
    sockaddr_in address{};
    address.sin_family = AF_INET;
    inet_pton(AF_INET, text, &address.sin_addr);
    sockaddr result{};
    std::memcpy(&result, &address, sizeof result);
    return result;
  }

  static bool set_up(int socket, ifreq request) {
    request.ifr_flags = IFF_UP | IFF_RUNNING | IFF_MULTICAST;
    return ioctl(socket, SIOCSIFFLAGS, &request) == 0;
  }

  /// Makes the interface of a machine in the network of this process; -1: not permitted.
  static int open_interface(const char* address) {
    const int tunnel = open("/dev/net/tun", O_RDWR);
    const int configures = socket(AF_INET, SOCK_DGRAM, 0);
    ifreq request{};
    request.ifr_flags = IFF_TUN | IFF_NO_PI;
    std::strcpy(request.ifr_name, "peer0");
    bool good = tunnel >= 0 && ioctl(tunnel, TUNSETIFF, &request) == 0;
    request.ifr_addr = address_of(address);
    good = good && ioctl(configures, SIOCSIFADDR, &request) == 0;
    request.ifr_netmask = address_of("255.255.255.0");
    good = good && ioctl(configures, SIOCSIFNETMASK, &request) == 0 && set_up(configures, request);
    ifreq loopback{};
    std::strcpy(loopback.ifr_name, "lo");
    good = good && set_up(configures, loopback);
    rtentry route{};
    route.rt_dst = address_of("224.0.0.0");
    route.rt_genmask = address_of("240.0.0.0");
    route.rt_flags = RTF_UP;
    route.rt_dev = request.ifr_name;
    good = good && ioctl(configures, SIOCADDRT, &route) == 0;
    close(configures);
    return good ? tunnel : -1;
  }

  [[noreturn]] static void relay(int ready, unsigned seed) {
    std::array<int, 2> tunnels{}, networks{};
    bool good = lcm_test::enter_own_network();
    for (std::size_t i = 0; good && i < 2; ++i) {
      if (i == 1) good = unshare(CLONE_NEWNET) == 0;
      tunnels[i] = good ? open_interface(addresses[i]) : -1;
      networks[i] = open("/proc/self/ns/net", O_RDONLY);
      good = good && tunnels[i] >= 0 && networks[i] >= 0;
    }
    if (!good || write(ready, networks.data(), sizeof networks) < 0) _exit(1);
    close(ready);
    pass_packets(tunnels, seed);
  }

  [[noreturn]] static void pass_packets(const std::array<int, 2>& tunnels, unsigned seed) {
    using namespace std::chrono_literals;
    std::mt19937 random(seed);
    std::array<std::deque<Packet>, 2> queues;
    for (;;) {
      std::array<pollfd, 2> polled{{{tunnels[0], POLLIN, 0}, {tunnels[1], POLLIN, 0}}};
      poll(polled.data(), polled.size(), queues[0].empty() && queues[1].empty() ? 1000 : 1);
      for (std::size_t from = 0; from < 2; ++from) {
        if ((polled[from].revents & POLLIN) != 0) {
          std::vector<char> bytes(65536);
          const ssize_t size = read(tunnels[from], bytes.data(), bytes.size());
          bytes.resize(static_cast<std::size_t>(size > 0 ? size : 0));
          if (!bytes.empty() && random() % 100 != 0) queues[from].push_back({Clock::now() + 20ms, std::move(bytes)});
        }
        for (; !queues[from].empty() && queues[from].front().due <= Clock::now(); queues[from].pop_front())
          if (write(tunnels[1 - from], queues[from].front().bytes.data(), queues[from].front().bytes.size()) < 0)
            continue;
      }
    }
  }

  pid_t relay_ = 0;
  std::array<int, 2> networks_{};
  bool permitted_ = false;
};

}  // namespace system_test
